// SPDX-License-Identifier: Apache-2.0
#include "tests/numeric/fixtures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace helio::test {

NodeTree makeTree(const std::vector<Face>& faces)
{
    ShapeTree shapes;
    shapes.names = {"Test"};
    shapes.buildingIds = {"test"};
    Shape root;
    root.building = 0;
    shapes.shapes.push_back(root);
    u32 groups = 0;
    for (const Face& face : faces) groups = std::max(groups, face.group + 1);
    for (u32 g = 0; g < groups; ++g) {
        Shape group = root;
        group.parent = 0;
        group.op = ShapeOp::Group;
        shapes.shapes.push_back(group);
    }
    for (u32 i = 0; i < faces.size(); ++i) {
        Shape leaf = root;
        leaf.parent = 1 + faces[i].group;
        leaf.op = ShapeOp::Split;
        leaf.polygonBegin = leaf.surface = leaf.sourceFace = i;
        leaf.polygonCount = 1;
        shapes.shapes.push_back(leaf);
        shapes.polygons.push_back({faces[i].ring, {}});
        shapes.surfaces.push_back({"", faces[i].rho, faces[i].emission});
    }
    return buildNodes(shapes, {}).tree;
}

std::vector<Face> grid(const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV, u32 nu, u32 nv,
                       const Face& like)
{
    std::vector<Face> faces;
    for (u32 j = 0; j < nv; ++j) {
        for (u32 i = 0; i < nu; ++i) {
            const auto at = [&](u32 u, u32 v) { return corner + double(u) / nu * edgeU + double(v) / nv * edgeV; };
            Face face = like;
            face.ring = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
            faces.push_back(face);
        }
    }
    return faces;
}

std::vector<Face> room(const glm::dvec3& size, u32 n, const glm::dvec4& rho, const glm::dvec4& emission)
{
    const glm::dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), o(0.0);
    std::vector<Face> faces;
    const auto side = [&](const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, u32 group) {
        append(faces, grid(corner, u, v, n, n, {{}, group, rho, emission}));
    };
    side(o, x, y, 0);
    side(z, y, x, 1);
    side(o, y, z, 2);
    side(x, z, y, 3);
    side(o, z, x, 4);
    side(y, x, z, 5);
    return faces;
}

LinkTable makeLinks(const NodeTree& tree, const std::vector<TestLink>& links)
{
    LinkTable table;
    std::vector<TestLink> sorted(links);
    std::sort(sorted.begin(), sorted.end(), [](const TestLink& a, const TestLink& b) {
        return a.receiver != b.receiver ? a.receiver < b.receiver : a.sender < b.sender;
    });
    table.rowBegin.assign(tree.nodeCount() + 1, 0);
    for (const TestLink& link : sorted) {
        ++table.rowBegin[link.receiver + 1];
        table.column.push_back(link.sender);
        table.factor.push_back(float(link.factor));
    }
    std::partial_sum(table.rowBegin.begin(), table.rowBegin.end(), table.rowBegin.begin());
    return table;
}

void append(std::vector<Face>& to, const std::vector<Face>& more)
{
    to.insert(to.end(), more.begin(), more.end());
}

void raise(double& maximum, double value)
{
    maximum = std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(maximum, value);
}

std::vector<Face> moved(std::vector<Face> faces, const glm::dvec3& offset)
{
    for (Face& face : faces)
        for (glm::dvec3& corner : face.ring) corner += offset;
    return faces;
}

} // namespace helio::test
