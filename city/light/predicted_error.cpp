// SPDX-License-Identifier: Apache-2.0
#include "city/light/predicted_error.h"

#include <array>
#include <cmath>

#include "city/base/check.h"
#include "city/light/light_flow.h"
#include "city/light/sun.h"
#include "city/light/training.h"

namespace helio {
namespace {

/// Error of links / their difference to those of a fourfold epsilon, which err about 2.2 times as much.
constexpr double kLinkErrorOfDifference = 0.5;
constexpr double kErrorOfUnresolved = 0.5; // of E_indirect / SplitRecord::unresolved, where no cut tells it
constexpr u32 kSweeps = 5;                 // leave about a thousandth of the indirect light, alike in all solutions
constexpr u32 kRaysPerSun = 16;
constexpr std::array<u32, 3> kSuns{3, 10, 17}; // of 20 training suns

/// Area mean over the patches of equal number, at that number; `of` has as many places as patches.
std::vector<glm::dvec4> averaged(const NodeTree& tree, std::span<const u32> number, std::span<const glm::dvec4> of)
{
    std::vector<glm::dvec4> sum(of.size(), glm::dvec4(0.0));
    std::vector<double> area(of.size(), 0.0);
    for (u32 i = 0; i < of.size(); ++i) {
        sum[number[i]] += tree.patches[i].area * of[i];
        area[number[i]] += tree.patches[i].area;
    }
    for (u32 i = 0; i < of.size(); ++i)
        if (area[i] > 0.0) sum[i] /= area[i];
    return sum;
}

/// Indirect irradiance per whole patch; the patches of a group send their common mean.
std::vector<glm::dvec4> solve(const NodeTree& tree, const LinkTable& links, std::span<const glm::dvec4> direct,
                              const SplitRecord& split, std::span<const u32> group, u32 jobs)
{
    const u32 count = tree.patchCount();
    NodeLight light = darkLight(tree, links);
    std::vector<glm::dvec4> irradiance(tree.nodeCount(), glm::dvec4(0.0)), sent(count);
    for (u32 k = 0; k < kSweeps; ++k) {
        for (u32 i = 0; i < count; ++i)
            sent[i] = tree.patches[i].covered ? glm::dvec4(0.0) : tree.patches[i].rho.w * (direct[i] + irradiance[i]);
        const std::vector<glm::dvec4> mean = averaged(tree, group, sent);
        for (u32 i = 0; i < count; ++i) light.mean[i] = mean[group[i]];
        pullUp(tree, links, light);
        gatherLight(tree, links, light, jobs, irradiance);
    }
    return averaged(tree, split.wholeOf, std::span(irradiance).first(count));
}

/// Per channel: area-weighted rms of the difference over the mean of `a`, both per whole patch.
glm::dvec4 difference(std::span<const double> area, std::span<const glm::dvec4> a, std::span<const glm::dvec4> b)
{
    glm::dvec4 squares(0.0), sum(0.0);
    double total = 0.0;
    for (size_t i = 0; i < area.size(); ++i) {
        const glm::dvec4 d = a[i] - b[i];
        squares += area[i] * d * d;
        sum += area[i] * a[i];
        total += area[i];
    }
    glm::dvec4 result(0.0);
    for (u32 c = 0; c < 4; ++c)
        if (sum[c] > 0.0) result[c] = std::sqrt(squares[c] * total) / sum[c];
    return result;
}

/// Rms over the suns.
double overSuns(const glm::dvec4& error)
{
    return std::sqrt((error.x * error.x + error.y * error.y + error.z * error.z) / 3.0);
}

} // namespace

std::vector<glm::dvec4> predictionLights(const NodeTree& tree, const Visibility& visibility, std::span<const float> sky,
                                         u32 jobs)
{
    const std::vector<glm::dvec3> all = trainingSuns(20);
    const std::array<glm::dvec3, 3> suns{all[kSuns[0]], all[kSuns[1]], all[kSuns[2]]};
    const std::vector<std::vector<double>> share = raySuns(tree, visibility, suns, kRaysPerSun, jobs);
    std::vector<glm::dvec4> direct(tree.patchCount());
    for (u32 i = 0; i < tree.patchCount(); ++i) direct[i] = {share[0][i], share[1][i], share[2][i], double(sky[i])};
    return direct;
}

PredictedError predictError(const NodeTree& tree, const LinkTable& links, const LinkTable& coarse,
                            std::span<const glm::dvec4> direct, const SplitRecord& split, u32 jobs)
{
    const u32 count = tree.patchCount();
    HELIO_CHECK(direct.size() == count && split.wholeOf.size() == count, count, " patches, ", direct.size(),
                " lights, ", split.wholeOf.size(), " whole patches");
    std::vector<u32> alone(count);
    std::vector<double> area(count, 0.0);
    for (u32 i = 0; i < count; ++i) {
        alone[i] = i;
        if (!tree.patches[i].covered) area[split.wholeOf[i]] += tree.patches[i].area;
    }
    const std::vector<glm::dvec4> fine = solve(tree, links, direct, split, alone, jobs);
    const glm::dvec4 byLinks =
        kLinkErrorOfDifference * difference(area, fine, solve(tree, coarse, direct, split, alone, jobs));
    const double left = split.unresolved * split.unresolved,
                 resolved = split.unresolvedWhole * split.unresolvedWhole - left;
    glm::dvec4 byPatches(kErrorOfUnresolved * split.unresolved);
    if (resolved > left)
        byPatches =
            std::sqrt(left / resolved) * difference(area, fine, solve(tree, links, direct, split, split.wholeOf, jobs));
    PredictedError error;
    error.links = overSuns(byLinks);
    error.patches = overSuns(byPatches);
    error.total = std::hypot(error.links, error.patches);
    error.sky = std::hypot(byLinks.w, byPatches.w);
    return error;
}

} // namespace helio
