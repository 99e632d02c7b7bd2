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
/// scene, so that errors are judged as area-weighted figures judge them; patches smaller than 0.4 of that count 0.4 of
/// themselves, lest they be sacrificed where sizes differ by orders of magnitude.
std::vector<double> errorWeights(const NodeTree& tree)
{
    constexpr double kSmallPatch = 0.4;
    double area = 0.0;
    for (const Patch& patch : tree.patches) area += patch.area;
    std::vector<u32> patches(tree.nodeCount(), 1);
    std::vector<double> weight(tree.nodeCount());
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        if (!tree.isLeaf(i)) {
            patches[i] = 0;
            for (const u32 child : tree.childrenOf(i)) patches[i] += patches[child];
        }
        weight[i] = std::max(double(tree.patchCount()) / area, kSmallPatch * double(patches[i]) / tree.nodes[i].area);
    }
    return weight;
}

/// Rows by receiver; `factors` gives a pair's F_ab and F_ba.
template <class Pair, class Factors>
LinkTable rowsOf(const NodeTree& tree, std::span<const Pair> pairs, u32 jobs, Factors&& factors)
{
    constexpr size_t kMostPairs = kNoIndex / 2 - 1;
    HELIO_CHECK(pairs.size() <= kMostPairs, "the bake makes ", pairs.size(), " pairs of links, the limit is ",
                kMostPairs, " (rows are counted in 32 bits); bake with a larger form factor epsilon or a smaller area");
    LinkTable table;
    table.rowBegin.assign(tree.nodeCount() + 1, 0);
    for (const Pair& pair : pairs) {
        ++table.rowBegin[pair.a + 1];
        ++table.rowBegin[pair.b + 1];
    }
    std::partial_sum(table.rowBegin.begin(), table.rowBegin.end(), table.rowBegin.begin());
    table.column.resize(2 * pairs.size());
    table.factor.resize(2 * pairs.size());
    std::vector<u32> next(table.rowBegin.begin(), table.rowBegin.end() - 1);
    const auto add = [&](u32 receiver, u32 sender, float factor) {
        const u32 at = next[receiver]++;
        table.column[at] = sender;
        table.factor[at] = factor;
    };
    for (const Pair& pair : pairs) {
        const auto [fab, fba] = factors(pair);
        add(pair.a, pair.b, fab);
        add(pair.b, pair.a, fba);
    }
    parallelFor(tree.nodeCount(), 4096, jobs, [&](u32 begin, u32 end) {
        std::vector<std::pair<u32, float>> row;
        for (u32 i = begin; i < end; ++i) {
            row.clear();
            for (u32 k = table.rowBegin[i]; k < table.rowBegin[i + 1]; ++k)
                row.emplace_back(table.column[k], table.factor[k]);
            std::sort(row.begin(), row.end());
            for (u32 k = 0; k < row.size(); ++k) {
                table.column[table.rowBegin[i] + k] = row[k].first;
                table.factor[table.rowBegin[i] + k] = row[k].second;
            }
        }
    });
    return table;
}

} // namespace

LinkBuild buildLinks(const NodeTree& tree, const Visibility& visibility, const Training& training,
                     std::span<const std::pair<u32, u32>> rootPairs, const LinkOptions& options)
{
    HELIO_CHECK(options.epsilon > 0.0 && options.raysPerLink > 0, "epsilon = ", options.epsilon,
                ", rays = ", options.raysPerLink);
    const Transfer transfer(tree);
    const double tolerance = options.epsilon * options.epsilon;
    const std::vector<double> weight = errorWeights(tree);

    constexpr u32 kChunk = 16;
    HELIO_CHECK(rootPairs.size() < kNoIndex - kChunk, rootPairs.size(),
                " pairs of surfaces see each other, the limit is ", kNoIndex - kChunk - 1,
                " (they are counted in 32 bits); bake a smaller area");
    const u32 count = u32(rootPairs.size());
    std::vector<std::vector<NodePair>> pairsOf((count + kChunk - 1) / kChunk);
    LinkBuild build;
    std::mutex mutex;
    u32 done = 0;
    parallelFor(count, kChunk, options.jobs, [&](u32 begin, u32 end) {
        LinkRefiner refiner(tree, visibility, training, transfer, weight,
                            {tolerance, options.raysPerLink, options.seed});
        for (u32 i = begin; i < end; ++i) refiner.refine(rootPairs[i].first, rootPairs[i].second);
        pairsOf[begin / kChunk] = refiner.takePairs();
        const std::lock_guard lock(mutex);
        done += end - begin;
        build.evaluated += refiner.evaluated();
        if (options.progress) options.progress(double(done) / double(count));
    });
    size_t total = 0;
    for (const std::vector<NodePair>& pairs : pairsOf) total += pairs.size();
    build.pairs.reserve(total);
    for (std::vector<NodePair>& pairs : pairsOf) {
        build.pairs.insert(build.pairs.end(), pairs.begin(), pairs.end());
        pairs = {};
    }
    return build;
}

LinkTable linkTable(const NodeTree& tree, std::span<const NodePair> pairs, u32 jobs)
{
    return rowsOf(tree, pairs, jobs, [&](const NodePair& pair) {
        const double exchange = double(pair.exchange);
        return std::pair(float(exchange / tree.nodes[pair.a].area), float(exchange / tree.nodes[pair.b].area));
    });
}

LinkTable linkTable(const NodeTree& tree, std::span<const FactorPair> pairs, u32 jobs)
{
    return rowsOf(tree, pairs, jobs, [](const FactorPair& pair) { return std::pair(pair.fab, pair.fba); });
}

} // namespace helio
