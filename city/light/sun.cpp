// SPDX-License-Identifier: Apache-2.0
#include "city/light/sun.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "city/base/check.h"
#include "city/base/hash.h"
#include "city/base/parallel.h"
#include "city/light/sequence.h"

namespace helio {

std::vector<double> raySun(const NodeTree& tree, const Visibility& visibility, const glm::dvec3& toSun, u32 samples,
                           u32 jobs)
{
    HELIO_CHECK(samples > 0, "samples = ", samples);
    std::vector<double> irradiance(tree.patchCount(), 0.0);
    if (toSun.z <= 0.0) return irradiance;
    parallelFor(tree.patchCount(), 256, jobs, [&](u32 begin, u32 end) {
        for (u32 patch = begin; patch < end; ++patch) {
            const glm::dvec3 normal = tree.nodes[patch].normal;
            const double cosine = glm::dot(normal, toSun);
            if (cosine <= 0.0 || tree.patches[patch].covered) continue;
            const std::array<u32, 4> shift = digitalShift(mixSeed(0x5a11, patch));
            u32 lit = 0;
            for (u32 k = 0; k < samples; ++k) {
                const std::array<double, 4> x = shiftedSobol4(k, shift);
                if (!visibility.isBlocked(visibility.pointOnPatch(patch, x[0], x[1]), normal, toSun)) ++lit;
            }
            irradiance[patch] = cosine * double(lit) / double(samples);
        }
    });
    return irradiance;
}

glm::dvec3 sunDirection(double azimuth, double elevation)
{
    return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
}

} // namespace helio
