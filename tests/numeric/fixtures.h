// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/light/light_tables.h"
#include "city/model/build_nodes.h"

namespace helio::test {

/// One planar face of a test scene.
struct Face
{
    Ring3 ring;    ///< counter-clockwise from the lit side
    u32 group = 0; ///< faces of a group that share a plane form one planar subtree
    glm::dvec4 rho{0.5};
    glm::dvec4 emission{0.0};
};

/// The node tree of the faces; patch k is face k.
NodeTree makeTree(const std::vector<Face>& faces);

/// A parallelogram cut into nu x nv faces; its lit side is that of cross(edgeU, edgeV).
std::vector<Face> grid(const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV, u32 nu, u32 nv,
                       const Face& like);

/// A closed box seen from inside, n x n faces a side. Groups: 0 floor, 1 ceiling, 2.. walls.
std::vector<Face> room(const glm::dvec3& size, u32 n, const glm::dvec4& rho, const glm::dvec4& emission);

/// Links given as a list, each one direction.
struct TestLink
{
    u32 receiver, sender;
    double factor;
};
LinkTable makeLinks(const NodeTree& tree, const std::vector<TestLink>& links);

void append(std::vector<Face>& to, const std::vector<Face>& more);

/// Raises a maximum; a value that is no number makes it infinite for good, so that no later comparison hides it.
void raise(double& maximum, double value);

/// Face moved by an offset, m.
std::vector<Face> moved(std::vector<Face> faces, const glm::dvec3& offset);

} // namespace helio::test
