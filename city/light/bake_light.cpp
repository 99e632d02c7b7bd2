// SPDX-License-Identifier: Apache-2.0
#include "city/light/bake_light.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>

#include "city/base/check.h"
#include "city/light/linear_senders.h"
#include "city/light/links.h"
#include "city/light/paper_links.h"
#include "city/light/reference_solver.h"
#include "city/light/sky.h"
#include "city/light/split_patches.h"

namespace helio {
namespace {

// What an error of E_indirect is made of, on scenes S and M at their default: README.md has the curves.
constexpr double kEpsilonOfError = 0.07;      // of one link
constexpr double kUnresolvedOfError = 0.95;   // of the light inside patches
constexpr double kDefaultPaperEpsilon = 0.02; // form factor
constexpr u32 kTrainingSuns = 20;

/// 256 rays see the sky to about 1 % of the mean; finer bakes and small scenes get more.
u32 chooseRays(double error, u32 patchCount)
{
    const double wanted = 256.0 * std::max(1.0, 0.02 / error) * (patchCount <= 10'000 ? 4.0 : 1.0);
    return std::bit_floor(u32(std::min(wanted, 1024.0)));
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

/// Cuts patches where light varies inside them.
SplitRecord split(NodeTreeBuild& build, std::span<const AssetSummary> assets, const LightOptions& options)
{
    const SplitPlan plan =
        planSplits(build.tree, Visibility(build.tree), trainingSuns(kTrainingSuns), cuttablePatches(build),
                   {kUnresolvedOfError * options.error, options.splitGrowth, options.jobs});
    SplitRecord record;
    record.unresolved = plan.unresolved;
    record.unresolvedWhole = plan.unresolvedWhole;
    record.wholeOf = splitPatches(build, assets, plan);
    return record;
}

/// Patches as they are, with nothing known of their insides.
SplitRecord unsplit(const NodeTree& tree)
{
    SplitRecord record;
    record.wholeOf.resize(tree.patchCount());
    std::iota(record.wholeOf.begin(), record.wholeOf.end(), 0u);
    return record;
}

/// Links by the error that they leave, and what is expected of them; fills in what the statistics say of them.
LinkTable refinedLinks(const NodeTree& tree, const Visibility& visibility, const SkyScan& scan,
                       const SplitRecord& split, const LightOptions& options, Steps& steps, LightStats& stats)
{
    std::vector<SlopeFrame> frames;
    std::vector<gpu::ChildSlopeRecord> slopes;
    if (!options.constantSenders) {
        frames = slopeFrames(tree);
        slopes = childSlopes(tree, frames);
    }
    const Training training = steps.run("training lights", [&](auto) {
        return trainLights(tree, visibility, scan.sky, slopes, kTrainingSuns, options.jobs);
    });
    LinkOptions link;
    link.leafReceivers = options.leafReceivers;
    link.epsilon = stats.formFactorEpsilon =
        options.formFactorEpsilon > 0.0 ? options.formFactorEpsilon : kEpsilonOfError * options.error;
    if (options.raysPerLink > 0) link.raysPerLink = options.raysPerLink;
    stats.raysPerLink = link.raysPerLink;
    link.jobs = options.jobs;
    link.seed = options.seed;
    LinkBuild build = steps.run("links", [&](auto progress) {
        link.progress = progress;
        return buildLinks(tree, visibility, training, frames, scan.rootPairs, link);
    });
    stats.pairsEvaluated = build.evaluated;
    LinkTable links =
        steps.run("rows", [&](auto) { return linkTable(tree, build.links, options.jobs, std::move(slopes)); });
    build.links = {};
    stats.predicted = steps.run("predicted error", [&](auto) {
        const LinkTable coarse = linkTable(tree, build.coarse, options.jobs, links.childSlopes);
        build.coarse = {};
        return predictError(tree, links, coarse, predictionLights(tree, visibility, scan.sky, options.jobs), split,
                            options.jobs);
    });
    return links;
}

LinkTable linksOfPaper(const NodeTree& tree, const LightOptions& options, Steps& steps, LightStats& stats)
{
    PaperOptions paper;
    paper.epsilon = stats.formFactorEpsilon =
        options.formFactorEpsilon > 0.0 ? options.formFactorEpsilon : kDefaultPaperEpsilon;
    paper.cutoff = options.cutoff;
    paper.literal = options.method == LinkMethod::PaperLiteral;
    return steps.run("links", [&](auto) { return linkTable(tree, paperLinks(tree, paper), options.jobs); });
}

LightBake bakeTree(const NodeTree& tree, const SplitRecord& split, const LightOptions& options)
{
    LightBake bake;
    LightStats& stats = bake.stats;
    stats.splitPatchCount = tree.patchCount();
    Steps steps(options, stats);
    const auto visibility = steps.run("ray structure", [&](auto) { return std::make_unique<Visibility>(tree); });
    stats.raysPerPatch = options.raysPerPatch > 0 ? options.raysPerPatch : chooseRays(options.error, tree.patchCount());
    const SkyDome dome(options.skyPatches > 0 ? options.skyPatches : autoSkyPatches(tree.patchCount()));
    SkyScan scan = steps.run("sky", [&](auto progress) {
        return scanSky(tree, *visibility, stats.raysPerPatch, options.seed, options.jobs, progress, dome,
                       options.farGround);
    });
    stats.farGround = options.farGround != glm::dvec4(0.0);
    stats.rootPairCount = u32(scan.rootPairs.size());
    bake.links = options.method == LinkMethod::Heliopolis
                     ? refinedLinks(tree, *visibility, scan, split, options, steps, stats)
                     : linksOfPaper(tree, options, steps, stats);
    bake.sky = std::move(scan.links);
    stats.linkCount = bake.links.column.size();
    stats.linksPerPatch = double(stats.linkCount) / double(std::max(1u, tree.patchCount()));
    summariseRows(tree, bake.links, scan, stats);
    return bake;
}

void checkOptions(const LightOptions& options)
{
    HELIO_CHECK(options.error > 0.0 && options.splitGrowth >= 1.0, "error = ", options.error,
                ", growth = ", options.splitGrowth);
}

} // namespace

LightBake bakeLight(NodeTreeBuild& build, std::span<const AssetSummary> assets, const LightOptions& options)
{
    checkOptions(options);
    checkTree(build.tree);
    if (options.method != LinkMethod::Heliopolis) return bakeLight(build.tree, options);
    const u32 wholeCount = build.tree.patchCount();
    LightStats before;
    const SplitRecord record =
        Steps(options, before).run("splitting", [&](auto) { return split(build, assets, options); });
    LightBake bake = bakeTree(build.tree, record, options);
    bake.stats.wholePatchCount = wholeCount;
    bake.stats.unresolved = record.unresolved;
    bake.stats.seconds.insert(bake.stats.seconds.begin(), before.seconds.begin(), before.seconds.end());
    return bake;
}

LightBake bakeLight(const NodeTree& tree, const LightOptions& options)
{
    checkOptions(options);
    checkTree(tree);
    LightBake bake = bakeTree(tree, unsplit(tree), options);
    bake.stats.wholePatchCount = tree.patchCount();
    return bake;
}

} // namespace helio
