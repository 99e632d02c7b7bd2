// SPDX-License-Identifier: Apache-2.0
#include "city/light/sun.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "city/base/check.h"
#include "city/base/hash.h"
#include "city/base/parallel.h"
#include "city/light/sequence.h"

namespace helio {

std::vector<std::vector<double>> raySuns(const NodeTree& tree, const Visibility& visibility,
                                         std::span<const glm::dvec3> toSuns, u32 samples, u32 jobs)
{
    HELIO_CHECK(samples > 0, "samples = ", samples);
    std::vector<std::vector<double>> irradiance(toSuns.size(), std::vector<double>(tree.patchCount(), 0.0));
    parallelFor(tree.patchCount(), 256, jobs, [&](u32 begin, u32 end) {
        std::vector<glm::dvec3> points(samples), directions;
        std::vector<u32> seen; // suns before the patch
        const auto blocked = std::make_unique<bool[]>(samples * toSuns.size());
        for (u32 patch = begin; patch < end; ++patch) {
            if (tree.patches[patch].covered) continue;
            const glm::dvec3 normal = tree.nodes[patch].normal;
            seen.clear();
            directions.clear();
            for (u32 sun = 0; sun < toSuns.size(); ++sun) {
                if (glm::dot(normal, toSuns[sun]) <= 0.0 || toSuns[sun].z <= 0.0) continue;
                seen.push_back(sun);
                directions.push_back(toSuns[sun]);
            }
            if (seen.empty()) continue;
            const std::array<u32, 4> shift = digitalShift(mixSeed(0x5a11, patch));
            for (u32 k = 0; k < samples; ++k) {
                const std::array<double, 4> x = shiftedSobol4(k, shift);
                points[k] = visibility.pointOnPatch(patch, x[0], x[1]);
            }
            visibility.areBlocked(points, normal, directions, std::span(blocked.get(), samples * seen.size()));
            for (size_t s = 0; s < seen.size(); ++s) {
                const bool* of = blocked.get() + s * samples;
                const double lit = double(std::count(of, of + samples, false));
                irradiance[seen[s]][patch] = glm::dot(normal, directions[s]) * lit / double(samples);
            }
        }
    });
    return irradiance;
}

std::vector<double> raySun(const NodeTree& tree, const Visibility& visibility, const glm::dvec3& toSun, u32 samples,
                           u32 jobs)
{
    return std::move(raySuns(tree, visibility, std::span(&toSun, 1), samples, jobs)[0]);
}

glm::dvec3 sunDirection(double azimuth, double elevation)
{
    return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
}

} // namespace helio
