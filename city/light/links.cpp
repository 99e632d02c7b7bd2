// SPDX-License-Identifier: Apache-2.0
#include "city/light/links.h"

#include <algorithm>
#include <mutex>
#include <numeric>

#include "city/base/check.h"
#include "city/base/parallel.h"
#include "city/light/link_refiner.h"

namespace helio {
namespace {

/// What a squared error of irradiance on a square metre of each node counts, 1/m2: 1 over the mean patch area of the
/// scene, so that errors are judged as area-weighted figures judge them; patches smaller than that count as one of mean
/// size, lest windows be sacrificed to walls.
std::vector<double> errorWeights(const NodeTree& tree)
{
    double area = 0.0;
    u32 count = 0;
    for (const Patch& patch : tree.patches) {
        if (patch.covered) continue;
        area += patch.area;
        ++count;
    }
    std::vector<u32> patches(tree.nodeCount(), 1);
    std::vector<double> weight(tree.nodeCount());
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        if (!tree.isLeaf(i)) {
            patches[i] = 0;
            for (const u32 child : tree.childrenOf(i)) patches[i] += patches[child];
        }
        weight[i] = double(patches[i]) / tree.nodes[i].area;
        if (area > 0.0) weight[i] = std::max(weight[i], double(count) / area);
    }
    return weight;
}

std::vector<NodeLink> joined(std::vector<std::vector<NodeLink>>& runs)
{
    size_t total = 0;
    for (const std::vector<NodeLink>& run : runs) total += run.size();
    std::vector<NodeLink> all;
    all.reserve(total);
    for (std::vector<NodeLink>& run : runs) {
        all.insert(all.end(), run.begin(), run.end());
        run = {};
    }
    return all;
}

} // namespace

LinkBuild buildLinks(const NodeTree& tree, const Visibility& visibility, const Training& training,
                     std::span<const SlopeFrame> frames, std::span<const std::pair<u32, u32>> rootPairs,
                     const LinkOptions& options)
{
    HELIO_CHECK(options.epsilon > 0.0 && options.raysPerLink > 0, "epsilon = ", options.epsilon,
                ", rays = ", options.raysPerLink);
    const Transfer transfer(tree);
    const std::vector<double> weight = errorWeights(tree);
    const std::vector<NodeParts> parts = nodeParts(tree, training, transfer, frames, weight, options.jobs);
    const Occluders occluders(tree, visibility);
    const LinkRays rays(tree, visibility, occluders, options.seed);
    const RefinerScene scene{.tree = tree,
                             .training = training,
                             .transfer = transfer,
                             .rays = rays,
                             .occluders = occluders,
                             .parts = parts,
                             .weight = weight,
                             .tolerance = options.epsilon * options.epsilon,
                             .raysPerPart = options.raysPerLink,
                             .leafReceivers = options.leafReceivers};
    constexpr u32 kChunk = 16;
    HELIO_CHECK(rootPairs.size() < kNoIndex - kChunk, rootPairs.size(),
                " pairs of surfaces see each other, the limit is ", kNoIndex - kChunk - 1,
                " (they are counted in 32 bits); bake a smaller area");
    const u32 count = u32(rootPairs.size());
    std::vector<std::vector<NodeLink>> linksOf((count + kChunk - 1) / kChunk), coarseOf(linksOf.size());
    LinkBuild build;
    std::mutex mutex;
    u32 done = 0;
    parallelFor(count, kChunk, options.jobs, [&](u32 begin, u32 end) {
        LinkRefiner refiner(scene);
        for (u32 i = begin; i < end; ++i) refiner.refine(rootPairs[i].first, rootPairs[i].second);
        linksOf[begin / kChunk] = refiner.takeLinks();
        coarseOf[begin / kChunk] = refiner.takeCoarseLinks();
        const std::lock_guard lock(mutex);
        done += end - begin;
        build.evaluated += refiner.evaluated();
        if (options.progress) options.progress(double(done) / double(count));
    });
    build.links = joined(linksOf);
    build.coarse = joined(coarseOf);
    return build;
}

LinkTable linkTable(const NodeTree& tree, std::span<const NodeLink> links, u32 jobs,
                    std::vector<gpu::ChildSlopeRecord> slopes)
{
    constexpr size_t kMostLinks = kNoIndex - 1;
    HELIO_CHECK(links.size() <= kMostLinks, "the bake makes ", links.size(), " links, the limit is ", kMostLinks,
                " (rows are counted in 32 bits); bake with a larger form factor epsilon or a smaller area");
    if (links.empty()) slopes.clear(); // no link, no sender to be linear
    LinkTable table;
    table.rowBegin.assign(tree.nodeCount() + 1, 0);
    for (const NodeLink& link : links) ++table.rowBegin[link.receiver + 1];
    std::partial_sum(table.rowBegin.begin(), table.rowBegin.end(), table.rowBegin.begin());
    std::vector<u32> order(links.size()), next(table.rowBegin.begin(), table.rowBegin.end() - 1);
    for (u32 k = 0; k < links.size(); ++k) order[next[links[k].receiver]++] = k;
    table.column.resize(links.size());
    table.factor.resize(links.size());
    if (!slopes.empty()) table.moment.resize(links.size());
    parallelFor(tree.nodeCount(), 4096, jobs, [&](u32 begin, u32 end) {
        for (u32 i = begin; i < end; ++i) {
            const auto row = std::span(order).subspan(table.rowBegin[i], table.rowBegin[i + 1] - table.rowBegin[i]);
            std::sort(row.begin(), row.end(), [&](u32 a, u32 b) { return links[a].sender < links[b].sender; });
            for (u32 k = 0; k < row.size(); ++k) {
                const NodeLink& link = links[row[k]];
                table.column[table.rowBegin[i] + k] = link.sender;
                table.factor[table.rowBegin[i] + k] = link.factor;
                if (!slopes.empty()) table.moment[table.rowBegin[i] + k] = link.moment;
            }
        }
    });
    table.childSlopes = std::move(slopes);
    return table;
}

} // namespace helio
