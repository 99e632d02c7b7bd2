// SPDX-License-Identifier: Apache-2.0
#include "city/pack/scene_light.h"

#include <algorithm>
#include <charconv>
#include <numbers>

#include "city/base/hash.h"
#include "city/light/sequence.h"
#include "city/light/visibility.h"
#include "city/pack/patch_scene.h"

namespace helio {
namespace {

constexpr double kLift = 1e-3; // m, so that a sensor does not lie behind the polygon that it measures

} // namespace

glm::dvec3 farGroundRadiance(const Pack& pack, const SceneLight& light)
{
    const double onGround = light.dhi + light.dni * std::max(light.toSun.z, 0.0);
    return glm::dvec3(farGroundOf(pack.tile())) * (onGround / std::numbers::pi);
}

std::map<Surface6, std::vector<u32>> patchesByMaterial(const TileView& tile)
{
    std::map<Surface6, std::vector<u32>> materials;
    for (u32 i = 0; i < tile.patches.size(); ++i) {
        const gpu::PatchRecord& p = tile.patches[i];
        materials[{p.rho.x, p.rho.y, p.rho.z, p.emission.x, p.emission.y, p.emission.z}].push_back(i);
    }
    return materials;
}

std::string sensorPoints(const Pack& pack, u32 pointsPerPatch)
{
    const NodeTree tree = patchTree(pack);
    const Visibility points(tree);
    std::string text;
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        const glm::dvec3 normal = tree.nodes[i].normal;
        const std::array<u32, 4> shift = digitalShift(mixSeed(0x5e45, i));
        for (u32 k = 0; k < pointsPerPatch; ++k) {
            const std::array<double, 4> x = shiftedSobol4(k, shift);
            const glm::dvec3 at = points.pointOnPatch(i, x[2], x[3]) + kLift * normal;
            for (const double v : {at.x, at.y, at.z, normal.x, normal.y, normal.z}) appendNumber(text, v);
            text += '\n';
        }
    }
    return text;
}

void appendNumber(std::string& text, double value)
{
    char digits[32];
    const auto [end, failure] = std::to_chars(digits, digits + sizeof digits, value);
    HELIO_CHECK(failure == std::errc{}, value);
    text += ' ';
    text.append(digits, end);
}

} // namespace helio
