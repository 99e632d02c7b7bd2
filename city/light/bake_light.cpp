// SPDX-License-Identifier: Apache-2.0
#include "city/light/bake_light.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "city/base/check.h"
#include "city/light/links.h"
#include "city/light/paper_links.h"
#include "city/light/reference_solver.h"
#include "city/light/sky.h"

namespace helio {
namespace {

constexpr double kDefaultEpsilon = 5e-4; // up to kSmallScene patches; see the table in README.md
constexpr double kSmallScene = 4000.0;
constexpr double kDefaultPaperEpsilon = 0.02; // form factor
constexpr u32 kTrainingSuns = 8;

/// Grows with the scene, so that time stays in bounds: about 70 links a patch at 10^4 patches, 35 at 5 10^5.
double defaultEpsilon(u32 patchCount)
{
    return kDefaultEpsilon * std::pow(std::max(1.0, double(patchCount) / kSmallScene), 0.3);
}

void checkTree(const NodeTree& tree)
{
    HELIO_CHECK(tree.nodeCount() >= tree.patchCount(), tree.nodeCount(), " nodes, ", tree.patchCount(), " patches");
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        HELIO_CHECK(node.area > 0.0, "node ", i, " has area ", node.area);
        HELIO_CHECK(node.parent == kNoIndex || (node.parent > i && node.parent < tree.nodeCount()), "node ", i,
                    " has parent ", node.parent);
        HELIO_CHECK(node.kind == NodeKind::Cluster || (node.coverage > 0.0 && node.ringCount > 0), "planar node ", i,
                    " has coverage ", node.coverage, " and ", node.ringCount, " rings");
    }
}

template <class Values>
MinMeanMax summarise(const NodeTree& tree, const std::vector<u32>& patches, const Values& values)
{
    MinMeanMax result;
    if (patches.empty()) return result;
    result.min = result.max = double(values[patches[0]]);
    double area = 0.0;
    for (const u32 i : patches) {
        const double value = double(values[i]);
        result.min = std::min(result.min, value);
        result.max = std::max(result.max, value);
        result.mean += tree.patches[i].area * value;
        area += tree.patches[i].area;
    }
    result.mean /= area;
    return result;
}

void summariseRows(const NodeTree& tree, const LinkTable& links, const SkyScan& scan, LightStats& stats)
{
    constexpr float kInside = 0.01f; // share of rays that meet back sides
    std::vector<u32> open;
    double area = 0.0, insideArea = 0.0, coveredArea = 0.0;
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        area += tree.patches[i].area;
        if (tree.patches[i].covered) {
            ++stats.coveredPatchCount;
            coveredArea += tree.patches[i].area;
        } else if (scan.back[i] <= kInside) {
            open.push_back(i);
        } else {
            insideArea += tree.patches[i].area;
        }
    }
    stats.insidePatchCount = tree.patchCount() - u32(open.size()) - stats.coveredPatchCount;
    if (area > 0.0) stats.insideAreaShare = insideArea / area;
    if (area > 0.0) stats.coveredAreaShare = coveredArea / area;
    const std::vector<double> rowSums = patchRowSums(tree, links);
    std::vector<double> closure(rowSums);
    for (const u32 i : open) closure[i] += double(scan.sky[i]) + double(scan.below[i]) + double(scan.back[i]);
    stats.closure = summarise(tree, open, closure);
    stats.rowSum = summarise(tree, open, rowSums);
    stats.rayRowSum = summarise(tree, open, scan.rowSum);
    stats.sky = summarise(tree, open, scan.sky);
    stats.below = summarise(tree, open, scan.below);
    if (stats.rayRowSum.mean > 0.0) stats.closureDefect = stats.rowSum.mean / stats.rayRowSum.mean - 1.0;
}

/// Times the steps and hands their progress on.
class Steps
{
public:
    Steps(const LightOptions& options, LightStats& stats) : options_(options), stats_(stats) {}

    template <class Body> auto run(const char* name, Body&& body)
    {
        const auto start = std::chrono::steady_clock::now();
        report(name, 0.0);
        auto result = body([this, name](double done) { report(name, done); });
        report(name, 1.0);
        stats_.seconds.push_back(
            {name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
        return result;
    }

private:
    void report(const char* name, double done) const
    {
        if (options_.progress) options_.progress(name, done);
    }

    const LightOptions& options_;
    LightStats& stats_;
};

} // namespace

LightBake bakeLight(const NodeTree& tree, const LightOptions& options)
{
    checkTree(tree);
    LightBake bake;
    LightStats& stats = bake.stats;
    Steps steps(options, stats);
    const auto visibility = steps.run("ray structure", [&](auto) { return std::make_unique<Visibility>(tree); });
    stats.raysPerPatch = options.raysPerPatch > 0 ? options.raysPerPatch : autoRaysPerPatch(tree.patchCount());
    const SkyDome dome(options.skyPatches > 0 ? options.skyPatches : autoSkyPatches(tree.patchCount()));
    SkyScan scan = steps.run("sky", [&](auto progress) {
        return scanSky(tree, *visibility, stats.raysPerPatch, options.seed, options.jobs, progress, dome,
                       options.farGround);
    });
    stats.farGround = options.farGround != glm::dvec4(0.0);
    stats.rootPairCount = u32(scan.rootPairs.size());

    const auto makeRows = [&](const auto& pairs) {
        bake.links = steps.run("rows", [&](auto) { return linkTable(tree, std::span(pairs), options.jobs); });
    };
    const auto epsilonOr = [&](double chosen) {
        return stats.formFactorEpsilon = options.formFactorEpsilon > 0.0 ? options.formFactorEpsilon : chosen;
    };
    if (options.method == LinkMethod::Heliopolis) {
        const Training training = steps.run("training lights", [&](auto) {
            return trainLights(tree, *visibility, scan.sky, kTrainingSuns, options.jobs);
        });
        LinkOptions link;
        link.epsilon = epsilonOr(defaultEpsilon(tree.patchCount()));
        if (options.raysPerLink > 0) link.raysPerLink = options.raysPerLink;
        stats.raysPerLink = link.raysPerLink;
        link.jobs = options.jobs;
        link.seed = options.seed;
        const LinkBuild build = steps.run("links", [&](auto progress) {
            link.progress = progress;
            return buildLinks(tree, *visibility, training, scan.rootPairs, link);
        });
        stats.pairsEvaluated = build.evaluated;
        makeRows(build.pairs);
    } else {
        PaperOptions paper;
        paper.epsilon = epsilonOr(kDefaultPaperEpsilon);
        paper.cutoff = options.cutoff;
        paper.literal = options.method == LinkMethod::PaperLiteral;
        makeRows(steps.run("links", [&](auto) { return paperLinks(tree, paper); }));
    }
    bake.sky = std::move(scan.links);

    stats.linkCount = bake.links.column.size();
    stats.linksPerPatch = double(stats.linkCount) / double(std::max(1u, tree.patchCount()));
    summariseRows(tree, bake.links, scan, stats);
    return bake;
}

} // namespace helio
