// SPDX-License-Identifier: Apache-2.0
#include "city/light/sky.h"

#include <algorithm>
#include <cmath>
#include <glm/packing.hpp>
#include <mutex>
#include <numbers>
#include <numeric>

#include "city/base/check.h"
#include "city/base/hash.h"
#include "city/base/parallel.h"
#include "city/light/cosine_directions.h"
#include "city/light/sequence.h"

namespace helio {
namespace {

constexpr u32 kChunk = 256;        // patches
constexpr u32 kRaysOfPlane = 1024; // that a plane shoots at least, as long as `rays` a patch leave it fewer

void sortUnique(std::vector<std::pair<u32, u32>>& pairs)
{
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Sky links of a run of patches, in rows as those of SkyTable.
struct SkyRows
{
    std::vector<u32> rowEnd; ///< of each patch, from the run's first link
    std::vector<u32> column;
    std::vector<float> factor;
    std::vector<u32> offset;
};

/// The first `count` points of the sequence, those of neighbouring directions behind each other. A digital shift moves
/// neighbours together, so the order is good for every patch.
std::vector<u32> raysByDirection(u32 count)
{
    constexpr u32 kBits = 4; // of each coordinate
    const auto cellOf = [](u32 index) {
        const std::array<u32, 4> x = sobol4(index);
        u32 cell = 0;
        for (u32 bit = 0; bit < kBits; ++bit)
            cell = cell << 2 | (x[0] >> (31 - bit) & 1u) << 1 | (x[1] >> (31 - bit) & 1u);
        return cell;
    };
    std::vector<u32> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](u32 a, u32 b) { return cellOf(a) < cellOf(b); });
    return order;
}

/// The rays of a patch that ended in a cell.
struct CellRays
{
    u32 count = 0;
    glm::dvec2 places{0.0}; ///< their sum
};

/// Ends a patch's row: `cells` are those that rays ended in. Leaves them and their rays empty.
void endRow(SkyRows& rows, std::vector<CellRays>& rays, std::vector<u32>& cells, float share)
{
    std::sort(cells.begin(), cells.end());
    for (const u32 cell : cells) {
        rows.column.push_back(cell);
        rows.factor.push_back(float(rays[cell].count) * share);
        rows.offset.push_back(glm::packSnorm2x16(glm::vec2(2.0 * rays[cell].places / double(rays[cell].count))));
        rays[cell] = {};
    }
    cells.clear();
    rows.rowEnd.push_back(u32(rows.column.size()));
}

SkyTable joinRows(const SkyDome& dome, const glm::dvec4& farGround, std::vector<SkyRows>& runs)
{
    SkyTable table;
    for (u32 cell = 0; cell < dome.cellCount(); ++cell)
        table.skyPatches.push_back({glm::vec3(dome.centreOf(cell)), float(dome.solidAngle()), glm::vec4(0.0f)});
    if (farGround != glm::dvec4(0.0))
        table.skyPatches.push_back({glm::vec3(0, 0, -1), float(2.0 * std::numbers::pi), glm::vec4(farGround)});
    table.rowBegin.push_back(0);
    for (SkyRows& run : runs) {
        const u64 first = table.column.size();
        HELIO_CHECK(first + run.column.size() < kNoIndex, first, " sky links");
        for (const u32 end : run.rowEnd) table.rowBegin.push_back(u32(first) + end);
        table.column.insert(table.column.end(), run.column.begin(), run.column.end());
        table.factor.insert(table.factor.end(), run.factor.begin(), run.factor.end());
        if (dome.cellCount() > 1) table.offset.insert(table.offset.end(), run.offset.begin(), run.offset.end());
        run = {};
    }
    return table;
}

} // namespace

std::vector<u32> planarRoots(const NodeTree& tree)
{
    std::vector<u32> root(tree.nodeCount(), kNoIndex);
    for (u32 i = tree.nodeCount(); i-- > 0;) {
        if (tree.nodes[i].kind == NodeKind::Cluster) continue;
        root[i] = tree.isPlanarRoot(i) ? i : root[tree.nodes[i].parent];
    }
    return root;
}

u32 autoSkyPatches(u32 patchCount)
{
    return patchCount <= 200'000 ? 48 : 24;
}

SkyScan scanSky(const NodeTree& tree, const Visibility& visibility, u32 rays, u64 seed, u32 jobs,
                const std::function<void(double)>& progress, const SkyDome& dome, const glm::dvec4& farGround)
{
    HELIO_CHECK(rays > 0, "rays = ", rays);
    const bool plain = farGround != glm::dvec4(0.0);
    const u32 count = tree.patchCount();
    const std::vector<u32> root = planarRoots(tree);
    std::vector<u32> patchesOf(tree.nodeCount(), 0);
    for (u32 patch = 0; patch < count; ++patch) ++patchesOf[root[patch]];
    SkyScan scan;
    for (std::vector<float>* column : {&scan.sky, &scan.below, &scan.rowSum, &scan.back}) column->resize(count);
    std::vector<std::vector<std::pair<u32, u32>>> pairsOf((count + kChunk - 1) / kChunk);
    std::vector<SkyRows> rowsOf(pairsOf.size());
    std::vector<std::vector<u32>> orders{raysByDirection(rays)}; // of once, twice, four times as many rays
    while (orders.back().size() < kRaysOfPlane) orders.push_back(raysByDirection(2 * u32(orders.back().size())));
    std::mutex mutex;
    u32 done = 0;

    parallelFor(count, kChunk, jobs, [&](u32 begin, u32 end) {
        std::vector<std::pair<u32, u32>>& pairs = pairsOf[begin / kChunk];
        SkyRows& rows = rowsOf[begin / kChunk];
        std::vector<u32> seen, cells;
        std::vector<CellRays> inCell(dome.cellCount() + 1); // the last: the plain beyond
        std::vector<glm::dvec3> from, directions;
        std::vector<RayEnd> ends;
        for (u32 patch = begin; patch < end; ++patch) {
            // Planes of few patches need more rays to meet all that they see.
            u32 own = rays;
            const std::vector<u32>* order = orders.data();
            for (; own < kRaysOfPlane && own * patchesOf[root[patch]] < kRaysOfPlane; ++order) own *= 2;
            const float share = 1.0f / float(own);
            if (tree.patches[patch].covered) {
                endRow(rows, inCell, cells, share);
                continue;
            }
            const PlaneFrame frame = planeFrame(tree.nodes[patch].normal);
            const std::array<u32, 4> shift = digitalShift(mixSeed(mixSeed(seed, 0x5ca7), patch));
            u32 sky = 0, below = 0, front = 0, back = 0;
            seen.clear();
            from.resize(own);
            directions.resize(own);
            ends.resize(own);
            for (u32 first = 0; first < own; first += kLanes) {
                Row8 r{}, turn{};
                const u32 lanes = std::min(kLanes, own - first);
                for (u32 k = 0; k < lanes; ++k) {
                    const std::array<double, 4> x = shiftedSobol4((*order)[first + k], shift);
                    r[k] = float(x[0]);
                    turn[k] = float(x[1]);
                    from[first + k] = visibility.pointOnPatch(patch, x[2], x[3]);
                }
                cosineDirections(frame, r, turn, std::span(directions).subspan(first, lanes));
            }
            visibility.trace(from, frame.normal, directions, ends);
            for (u32 k = 0; k < own; ++k) {
                const RayEnd& hit = ends[k];
                const glm::dvec3& direction = directions[k];
                if (hit.node == kNoIndex && direction.z > 0.0) {
                    ++sky;
                    const auto [cell, place] = dome.placeOf(direction);
                    if (inCell[cell].count++ == 0) cells.push_back(cell);
                    inCell[cell].places += place;
                } else if (hit.node == kNoIndex) {
                    ++below;
                } else if (!hit.front || tree.nodes[hit.node].covered) {
                    ++back;
                } else {
                    ++front;
                    if (seen.empty() || seen.back() != root[hit.node]) seen.push_back(root[hit.node]);
                }
            }
            if (plain && below > 0) {
                inCell[dome.cellCount()].count = below;
                cells.push_back(dome.cellCount());
            }
            endRow(rows, inCell, cells, share);
            scan.sky[patch] = float(sky) * share;
            scan.below[patch] = float(below) * share;
            scan.rowSum[patch] = float(front) * share;
            scan.back[patch] = float(back) * share;
            std::sort(seen.begin(), seen.end());
            seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
            for (const u32 other : seen)
                if (other != root[patch]) pairs.push_back(std::minmax(root[patch], other));
        }
        sortUnique(pairs);
        const std::lock_guard lock(mutex);
        done += end - begin;
        if (progress) progress(double(done) / double(count));
    });
    for (std::vector<std::pair<u32, u32>>& pairs : pairsOf) {
        scan.rootPairs.insert(scan.rootPairs.end(), pairs.begin(), pairs.end());
        pairs = {};
    }
    sortUnique(scan.rootPairs);
    scan.links = joinRows(dome, farGround, rowsOf);
    return scan;
}

} // namespace helio
