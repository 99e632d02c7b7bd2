// SPDX-License-Identifier: Apache-2.0
#include "city/light/training.h"

#include <cmath>
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

Training trainLights(const NodeTree& tree, const Visibility& visibility, std::span<const float> sky, u32 suns, u32 jobs)
{
    const u32 count = tree.patchCount();
    std::vector<std::vector<double>> lights;
    for (u32 s = 0; s < suns; ++s) {
        const double share = (double(s) + 0.5) / double(suns);
        const double sine = std::sin(8.0 * kDegree) + share * (std::sin(75.0 * kDegree) - std::sin(8.0 * kDegree));
        const glm::dvec3 toSun = sunDirection((double(s) * 137.508 + 17.0) * kDegree, std::asin(sine));
        lights.push_back(raySun(tree, visibility, toSun, kRaysPerSun, jobs));
    }
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
    training.radiosity.resize(size_t(tree.nodeCount()) * n);
    training.power.resize(tree.nodeCount());
    training.variance.resize(tree.nodeCount());
    std::vector<double> mean(n);
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        double squares = 0.0, power = 0.0;
        std::fill(mean.begin(), mean.end(), 0.0);
        if (tree.isLeaf(i)) {
            for (u32 l = 0; l < n; ++l) mean[l] = lights[l][i];
        } else {
            // Mean square below = variance inside the children + their power.
            for (const u32 child : tree.childrenOf(i)) {
                const double weight = tree.nodes[child].area / tree.nodes[i].area;
                for (u32 l = 0; l < n; ++l) mean[l] += weight * double(training.of(child)[l]);
                squares += weight * double(training.variance[child] + training.power[child]);
            }
        }
        for (u32 l = 0; l < n; ++l) {
            training.radiosity[size_t(i) * n + l] = float(mean[l]);
            power += mean[l] * mean[l] / double(n);
        }
        training.power[i] = float(power);
        training.variance[i] = tree.isLeaf(i) ? 0.0f : float(std::max(0.0, squares - power));
    }
    return training;
}

} // namespace helio
