// SPDX-License-Identifier: Apache-2.0
#include "city/light/training.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/base/parallel.h"
#include "city/light/sun.h"

namespace helio {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr u32 kRaysPerSun = 4;

/// Scales a light of the patches to an area mean of 1; false if there is none.
bool normalise(const NodeTree& tree, std::vector<double>& light)
{
    double sum = 0.0, area = 0.0;
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        sum += tree.patches[i].area * light[i];
        area += tree.patches[i].area;
    }
    if (!(sum > 0.0)) return false;
    for (double& value : light) value *= area / sum;
    return true;
}

} // namespace

std::vector<glm::dvec3> trainingSuns(u32 count)
{
    std::vector<glm::dvec3> suns;
    for (u32 s = 0; s < count; ++s) {
        const double share = (double(s) + 0.5) / double(count);
        const double sine = std::sin(8.0 * kDegree) + share * (std::sin(75.0 * kDegree) - std::sin(8.0 * kDegree));
        suns.push_back(sunDirection((double(s) * 137.508 + 17.0) * kDegree, std::asin(sine)));
    }
    return suns;
}

Training trainLights(const NodeTree& tree, const Visibility& visibility, std::span<const float> sky,
                     std::span<const gpu::ChildSlopeRecord> slopes, u32 suns, u32 jobs)
{
    const u32 count = tree.patchCount();
    std::vector<std::vector<double>> lights = raySuns(tree, visibility, trainingSuns(suns), kRaysPerSun, jobs);
    lights.emplace_back(sky.begin(), sky.end());
    lights.emplace_back(count, 1.0);
    for (std::vector<double>& light : lights)
        for (u32 i = 0; i < count; ++i) light[i] *= tree.patches[i].covered ? 0.0 : tree.patches[i].rho.w;
    lights.emplace_back(count);
    for (u32 i = 0; i < count; ++i) lights.back()[i] = tree.patches[i].covered ? 0.0 : tree.patches[i].emission.w;
    std::erase_if(lights, [&](std::vector<double>& light) { return !normalise(tree, light); });
    if (lights.empty()) lights.emplace_back(count, 1.0); // All black: any weights will do.

    Training training;
    const u32 n = training.lightCount = u32(lights.size());
    training.patchCount = count;
    training.radiosity.resize(size_t(tree.nodeCount()) * n);
    if (!slopes.empty()) training.slope.resize(size_t(tree.nodeCount() - count) * n);
    training.power.resize(tree.nodeCount());
    training.slopePower.assign(tree.nodeCount(), 0.0f);
    training.variance.assign(tree.nodeCount(), 0.0f);
    std::vector<double> mean(n);
    std::vector<glm::dvec2> slope(n);
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        double squares = 0.0, power = 0.0, slopePower = 0.0;
        std::fill(mean.begin(), mean.end(), 0.0);
        std::fill(slope.begin(), slope.end(), glm::dvec2(0.0));
        if (tree.isLeaf(i))
            for (u32 l = 0; l < n; ++l) mean[l] = lights[l][i];
        // Mean square below = what varies inside the children + their slopes' and their means' power.
        for (u32 k = node.childBegin; k < node.childBegin + node.childCount; ++k) {
            const u32 child = tree.children[k];
            const double weight = tree.nodes[child].area / node.area;
            const std::span<const float> childMean = training.of(child);
            const std::span<const glm::vec2> childSlope = training.slopeOf(child);
            for (u32 l = 0; l < n; ++l) mean[l] += weight * double(childMean[l]);
            for (u32 l = 0; l < n && !slopes.empty(); ++l) {
                const gpu::ChildSlopeRecord& s = slopes[k];
                slope[l] += weight * double(childMean[l]) * glm::dvec2(s.offsetX, s.offsetY);
                if (!childSlope.empty()) {
                    const glm::dvec2 x(childSlope[l]);
                    slope[l] += weight * glm::dvec2(double(s.xx) * x.x + double(s.xy) * x.y,
                                                    double(s.yx) * x.x + double(s.yy) * x.y);
                }
            }
            squares += weight * (double(training.variance[child]) + double(training.slopePower[child]) +
                                 double(training.power[child]));
        }
        for (u32 l = 0; l < n; ++l) {
            training.radiosity[size_t(i) * n + l] = float(mean[l]);
            power += mean[l] * mean[l] / double(n);
            if (tree.isLeaf(i) || slopes.empty()) continue;
            training.slope[size_t(i - count) * n + l] = glm::vec2(slope[l]);
            slopePower += glm::dot(slope[l], slope[l]) / double(n);
        }
        training.power[i] = float(power);
        training.slopePower[i] = float(slopePower);
        if (!tree.isLeaf(i)) training.variance[i] = float(std::max(0.0, squares - power - slopePower));
    }
    return training;
}

} // namespace helio
