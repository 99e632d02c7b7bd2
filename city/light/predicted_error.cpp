// SPDX-License-Identifier: Apache-2.0
#include "city/light/predicted_error.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "city/base/check.h"
#include "city/light/light_flow.h"
#include "city/light/sun.h"
#include "city/light/training.h"

namespace helio {
namespace {

/// Error of links / their difference to those of a fourfold epsilon, which err about 2.2 times as much.
constexpr double kLinkErrorOfDifference = 0.5;
constexpr double kShareOfLight = 0.5;      // of the square of a patch's error: what goes with its light
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

/// Errors, per whole patch and per channel, squared, as a share of the mean of a solution.
struct Errors
{
    std::vector<glm::dvec4> squares;

    /// `scale` x the difference of two solutions. Channels without light have no error.
    Errors(std::span<const double> area, std::span<const glm::dvec4> a, std::span<const glm::dvec4> b, double scale)
        : squares(area.size(), glm::dvec4(0.0))
    {
        glm::dvec4 sum(0.0);
        double total = 0.0;
        for (size_t i = 0; i < area.size(); ++i) {
            sum += area[i] * a[i];
            total += area[i];
        }
        for (u32 c = 0; c < 4; ++c)
            for (size_t i = 0; i < area.size() && sum[c] > 0.0; ++i) {
                const double share = scale * (a[i][c] - b[i][c]) * total / sum[c];
                squares[i][c] = share * share;
            }
    }
    /// The same on every patch.
    Errors(size_t count, double share) : squares(count, glm::dvec4(share * share)) {}

    /// Area-weighted rms, a channel.
    glm::dvec4 rms(std::span<const double> area) const
    {
        glm::dvec4 sum(0.0);
        double total = 0.0;
        for (size_t i = 0; i < area.size(); ++i) {
            sum += area[i] * squares[i];
            total += area[i];
        }
        return total > 0.0 ? glm::sqrt(sum / total) : glm::dvec4(0.0);
    }
};

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
    const Errors ofLinks(area, fine, solve(tree, coarse, direct, split, alone, jobs), kLinkErrorOfDifference);
    const double left = split.unresolved * split.unresolved,
                 resolved = split.unresolvedWhole * split.unresolvedWhole - left;
    const Errors ofPatches =
        resolved > left
            ? Errors(area, fine, solve(tree, links, direct, split, split.wholeOf, jobs), std::sqrt(left / resolved))
            : Errors(count, kErrorOfUnresolved * split.unresolved);
    const glm::dvec4 byLinks = ofLinks.rms(area), byPatches = ofPatches.rms(area);
    PredictedError error;
    error.links = overSuns(byLinks);
    error.patches = overSuns(byPatches);
    error.total = std::hypot(error.links, error.patches);
    error.sky = std::hypot(byLinks.w, byPatches.w);
    const Errors light(area, fine, std::vector<glm::dvec4>(count, glm::dvec4(0.0)), 1.0);
    const glm::dvec4 ofLight = light.rms(area);
    const glm::dvec4 share = (byLinks * byLinks + byPatches * byPatches) / glm::max(ofLight * ofLight, 1e-30);
    double lit = 0.0, all = 0.0;
    for (u32 i = 0; i < count; ++i) {
        lit += area[i];
        all += tree.patches[i].area;
    }
    for (u32 i = 0; i < count; ++i) {
        const u32 whole = split.wholeOf[i];
        const glm::dvec4 own = ofLinks.squares[whole] + ofPatches.squares[whole];
        const glm::dvec4 square = glm::mix(own, share * light.squares[whole], kShareOfLight);
        error.ofPatch.push_back(tree.patches[i].covered ? 0.0f : float(overSuns(glm::sqrt(square)) * all / lit));
    }
    return error;
}

} // namespace helio
