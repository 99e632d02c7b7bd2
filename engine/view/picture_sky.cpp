// SPDX-License-Identifier: Apache-2.0
#include "engine/view/picture_sky.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace helio {

namespace {

/// What zenith, horizon and glow add in a direction above the horizon.
glm::dvec3 shapeAt(const glm::dvec3& direction, const glm::dvec3& towardsSun)
{
    const double h = std::pow(1.0 - std::clamp(direction.z, 0.0, 1.0), 3.0);
    const double c = towardsSun.z > 0.0 ? std::max(glm::dot(direction, towardsSun), 0.0) : 0.0;
    return {1.0 - h, h, 0.25 * std::pow(c, 8.0) + 0.5 * std::pow(c, 64.0)};
}

/// Of the shapes, on an open horizontal plane.
glm::dvec3 irradianceOfShapes(const glm::dvec3& towardsSun)
{
    constexpr int kRings = 64, kSectors = 128;
    glm::dvec3 sum(0.0);
    for (int ring = 0; ring < kRings; ++ring) { // of equal cosine-weighted solid angle
        const double sine = std::sqrt((ring + 0.5) / kRings), level = std::sqrt(1.0 - sine * sine);
        for (int sector = 0; sector < kSectors; ++sector) {
            const double turn = 2.0 * std::numbers::pi * (sector + 0.5) / kSectors;
            sum += shapeAt({level * std::cos(turn), level * std::sin(turn), sine}, towardsSun);
        }
    }
    return sum * (std::numbers::pi / (kRings * kSectors));
}

/// Weights >= 0 of the shapes, by least squares over the cells; 0 if the cells are dark.
glm::dvec3 fitCells(std::span<const gpu::SkyPatchRecord> cells, const LightState& light)
{
    glm::dmat3 normal(0.0);
    glm::dvec3 right(0.0);
    for (size_t i = 0; i < cells.size(); ++i) {
        const glm::dvec3 shape = shapeAt(glm::dvec3(cells[i].direction), light.towardsSun);
        normal += double(cells[i].solidAngle) * glm::outerProduct(shape, shape);
        right += double(cells[i].solidAngle) * double(light.skyRadiance[i].mean) * shape;
    }
    // Every set of shapes that may take part, of which the best is that without negative weights whose squares are
    // least: a fit takes weights . right away from them.
    glm::dvec3 best(0.0);
    for (unsigned kept = 1; kept < 8; ++kept) {
        glm::dmat3 m = normal;
        glm::dvec3 r = right;
        for (int k = 0; k < 3; ++k)
            if ((kept >> k & 1) == 0) {
                for (int l = 0; l < 3; ++l) m[k][l] = m[l][k] = k == l ? 1.0 : 0.0;
                r[k] = 0.0;
            }
        constexpr double kSingular = 1e-9; // sr: shapes that the cells cannot tell apart, or a glow without a sun
        if (glm::determinant(m) < kSingular) continue;
        const glm::dvec3 weights = glm::inverse(m) * r;
        if (std::min({weights.x, weights.y, weights.z}) >= 0.0 && glm::dot(weights, right) > glm::dot(best, right))
            best = weights;
    }
    return best;
}

/// 1 under a clear sky, 0 where the sun stands above the horizon and does not come through.
double clearness(const LightState& light)
{
    const double share = light.dni / std::max(light.dni + light.dhi, 1e-9);
    return glm::mix(1.0, glm::smoothstep(0.0, 0.35, share), glm::smoothstep(0.0, 0.05, light.towardsSun.z));
}

} // namespace

double luminance(const glm::dvec3& colour)
{
    return glm::dot(colour, glm::dvec3(0.2126, 0.7152, 0.0722));
}

glm::dvec3 tintOf(const glm::dvec3& colour)
{
    return colour / luminance(colour);
}

PictureSky pictureSky(std::span<const gpu::SkyPatchRecord> skyPatches, const LightState& light)
{
    // The sun is warm near the horizon and nearly white above 30 degrees; the sky keeps what it lost.
    const double high = glm::smoothstep(0.0, 0.5, light.towardsSun.z), clear = clearness(light);
    const auto colour = [&](glm::dvec3 low, glm::dvec3 noon) {
        return tintOf(glm::mix(glm::dvec3(0.95, 1.0, 1.06), tintOf(glm::mix(low, noon, high)), clear));
    };
    glm::dvec3 weights =
        light.skyRadiance.empty() ? glm::dvec3(0.0) : fitCells(skyPatches.first(light.skyRadiance.size()), light);
    if (weights == glm::dvec3(0.0)) weights = {0.75, 1.55, light.sunUp() ? 1.25 : 0.0};
    // What is far away fades to the horizon, which no sky has black.
    weights[1] = std::max(weights[1], 0.25 * weights[0]);
    weights *= light.dhi / glm::dot(irradianceOfShapes(light.towardsSun), weights);
    return {weights[0] * colour({0.42, 0.70, 1.25}, {0.34, 0.80, 1.75}),
            weights[1] * colour({1.75, 1.42, 1.15}, {1.40, 1.72, 2.05}),
            weights[2] * colour({2.4, 1.3, 0.6}, {1.2, 1.1, 0.9}), colour({0.82, 0.88, 1.0}, {0.74, 0.87, 1.0}),
            tintOf(glm::mix(glm::dvec3(1.0, 0.62, 0.30), glm::dvec3(1.0, 0.93, 0.82), high))};
}

} // namespace helio
