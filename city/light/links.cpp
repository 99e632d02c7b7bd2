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

/// What a squared error of irradiance on a square metre of each node counts, 1/m2: 1 over the mean patch area of the scene,
/// so that errors are judged as area-weighted figures judge them; patches smaller than 0.4 of that count 0.4 of themselves,
/// lest they be sacrificed where sizes differ by orders of magnitude.
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

} // namespace

LinkBuild buildLinks(const NodeTree& tree, const Visibility& visibility, const Training& training,
                     std::span<const std::pair<u32, u32>> rootPairs, const LinkOptions& options)
{
    HELIO_CHECK(options.epsilon > 0.0 && options.raysPerLink > 0, "epsilon = ", options.epsilon, ", rays = ", options.raysPerLink);
    const Transfer transfer(tree);
    const double tolerance = options.epsilon * options.epsilon;
    const std::vector<double> weight = errorWeights(tree);

    constexpr u32 kChunk = 16;
    const u32 count = u32(rootPairs.size());
    std::vector<std::vector<NodePair>> pairsOf((count + kChunk - 1) / kChunk);
    LinkBuild build;
    std::mutex mutex;
    u32 done = 0;
    parallelFor(count, kChunk, options.jobs, [&](u32 begin, u32 end) {
        LinkRefiner refiner(tree, visibility, training, transfer, weight, {tolerance, options.raysPerLink, options.seed});
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
    HELIO_CHECK(pairs.size() < kNoIndex / 2, pairs.size(), " pairs do not fit a row offset; bake with a larger epsilon");
    LinkTable table;
    table.rowBegin.assign(tree.nodeCount() + 1, 0);
    for (const NodePair& pair : pairs) {
        ++table.rowBegin[pair.a + 1];
        ++table.rowBegin[pair.b + 1];
    }
    std::partial_sum(table.rowBegin.begin(), table.rowBegin.end(), table.rowBegin.begin());
    table.column.resize(2 * pairs.size());
    table.factor.resize(2 * pairs.size());
    std::vector<u32> next(table.rowBegin.begin(), table.rowBegin.end() - 1);
    const auto add = [&](u32 receiver, u32 sender, double exchange) {
        const u32 at = next[receiver]++;
        table.column[at] = sender;
        table.factor[at] = float(exchange / tree.nodes[receiver].area);
    };
    for (const NodePair& pair : pairs) {
        add(pair.a, pair.b, double(pair.exchange));
        add(pair.b, pair.a, double(pair.exchange));
    }
    parallelFor(tree.nodeCount(), 4096, jobs, [&](u32 begin, u32 end) {
        std::vector<std::pair<u32, float>> row;
        for (u32 i = begin; i < end; ++i) {
            row.clear();
            for (u32 k = table.rowBegin[i]; k < table.rowBegin[i + 1]; ++k) row.emplace_back(table.column[k], table.factor[k]);
            std::sort(row.begin(), row.end());
            for (u32 k = 0; k < row.size(); ++k) {
                table.column[table.rowBegin[i] + k] = row[k].first;
                table.factor[table.rowBegin[i] + k] = row[k].second;
            }
        }
    });
    return table;
}

} // namespace helio
