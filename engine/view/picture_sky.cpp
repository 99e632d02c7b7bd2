// SPDX-License-Identifier: Apache-2.0
#include "engine/view/picture_sky.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "city/format/pack.h"

namespace helio {

namespace {

/// What zenith, horizon and glow add in a direction above the horizon.
glm::dvec3 shapeAt(const glm::dvec3& direction, const glm::dvec3& towardsSun)
{
    const double h = std::pow(1.0 - std::clamp(direction.z, 0.0, 1.0), kSkyPower);
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

/// Weights >= 0 of the shapes, by least squares over the cells.
glm::dvec3 fitCells(std::span<const gpu::SkyPatchRecord> cells, const LightState& light)
{
    glm::dmat3 normal(0.0);
    glm::dvec3 right(0.0);
    for (size_t i = 0; i < cells.size(); ++i) {
        const glm::dvec3 shape = shapeAt(glm::dvec3(cells[i].direction), light.towardsSun);
        normal += double(cells[i].solidAngle) * glm::outerProduct(shape, shape);
        right += double(cells[i].solidAngle) * double(light.skyRadiance[i].mean) * shape;
    }
    // Of eight sets of shapes that may take part the first, from the largest on, that needs no negative weight.
    for (const unsigned kept : {7u, 3u, 5u, 6u, 1u, 2u, 4u}) {
        glm::dmat3 m = normal;
        glm::dvec3 r = right;
        for (int k = 0; k < 3; ++k)
            if ((kept >> k & 1) == 0) {
                for (int l = 0; l < 3; ++l) m[k][l] = m[l][k] = k == l ? 1.0 : 0.0;
                r[k] = 0.0;
            }
        const glm::dvec3 weights = glm::inverse(m) * r;
        if (glm::all(glm::greaterThanEqual(weights, glm::dvec3(0.0)))) return weights;
    }
    return glm::dvec3(0.0);
}

} // namespace

glm::dvec3 tintOf(const glm::dvec3& colour)
{
    return colour / glm::dot(colour, glm::dvec3(0.2126, 0.7152, 0.0722));
}

PictureSky pictureSky(std::span<const gpu::SkyPatchRecord> skyPatches, const LightState& light)
{
    // Warm and weak near the horizon, nearly white above 30 degrees; grey where the sun's share of the light is small.
    const double high = glm::smoothstep(0.0, 0.5, std::max(light.towardsSun.z, 0.0));
    const double clear =
        light.towardsSun.z > 0.0 ? glm::smoothstep(0.0, 0.35, light.dni / std::max(light.dni + light.dhi, 1e-9)) : 1.0;
    const auto colour = [&](glm::dvec3 low, glm::dvec3 noon) {
        return tintOf(glm::mix(glm::dvec3(0.95, 1.0, 1.06), tintOf(glm::mix(low, noon, high)), clear));
    };
    glm::dvec3 weights = light.skyRadiance.empty() ? glm::dvec3(0.75, 1.55, light.sunUp() ? 1.25 : 0.0)
                                                   : fitCells(skyPatches.first(light.skyRadiance.size()), light);
    const double irradiance = glm::dot(irradianceOfShapes(light.towardsSun), weights);
    weights *= irradiance > 0.0 ? light.dhi / irradiance : 0.0;
    return {weights[0] * colour({0.42, 0.70, 1.25}, {0.34, 0.80, 1.75}),
            weights[1] * colour({1.75, 1.42, 1.15}, {1.40, 1.72, 2.05}),
            weights[2] * colour({2.4, 1.3, 0.6}, {1.2, 1.1, 0.9}), colour({0.82, 0.88, 1.0}, {0.74, 0.87, 1.0})};
}

} // namespace helio
