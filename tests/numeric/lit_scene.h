// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "city/light/bake_light.h"
#include "city/light/reference_solver.h"
#include "tests/numeric/fixtures.h"

namespace helio::test {

struct Daylight
{
    glm::dvec3 toSun{0.0, 0.0, -1.0}; ///< below the horizon: no sun
    double dni = 800.0, dhi = 120.0;  ///< W/m2; the sky is uniform
};

/// A scene as the bake's defaults, shadow rays and the solver light it, to a residual of 1e-6.
struct LitScene
{
    NodeTree tree;
    LightBake bake;
    std::vector<double> sun, sky; ///< first-hand irradiance of each patch, W/m2
    Solution solution;

    double indirect(u32 patch) const { return solution.indirect[patch].x; }
    double irradiance(u32 patch) const { return sun[patch] + sky[patch] + indirect(patch); }
    /// Sum of area x value over patches.
    double flux(const std::function<double(u32 patch)>& value) const;
    /// Area mean of a value over the patches for which `which` holds; 0 if none does.
    double mean(const std::function<double(u32 patch)>& value, const std::function<bool(u32 patch)>& which) const;
};

LitScene lightScene(NodeTree tree, const Daylight& daylight);
LitScene lightFaces(const std::vector<Face>& faces, const Daylight& daylight);

/// What holds in every scene: values are finite and not negative; no patch gets more sun than DNI cos(theta), more sky
/// than DHI, more indirect light than the brightest patch sends (3 % for the row sums of small patches); all that
/// arrives from patches is no more than what they send, and what is absorbed no more than what came in (1 %).
void expectPhysical(const LitScene& scene, const Daylight& daylight);

/// The four walls and the roof of a box seen from outside, each cut in pieces of about `cell` m; groups firstGroup..+4.
std::vector<Face> boxOutside(const glm::dvec3& low, const glm::dvec3& high, double cell, u32 firstGroup);

/// Faces turned about the z axis.
std::vector<Face> turned(std::vector<Face> faces, double angle);

} // namespace helio::test
