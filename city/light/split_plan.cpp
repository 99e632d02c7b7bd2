// SPDX-License-Identifier: Apache-2.0
#include "city/light/split_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <queue>

#include "city/base/check.h"
#include "city/base/hash.h"
#include "city/base/parallel.h"
#include "city/light/cosine_directions.h"
#include "city/light/sequence.h"

namespace helio {
namespace {

constexpr u32 kFewestCells = 16, kMostCells = 4096;
/// m2: patches whose cells would be larger get more of them, with fewer points each; and again, smaller ones, where
/// more than this share of the squared light that shall stay unresolved is left inside them.
constexpr double kLargeCell = 0.5, kSmallCell = 0.05, kInCellsEnough = 8.0;
/// Of the squared light inside cells, as four points a cell estimate it, what shows in E_indirect (scenes S and M).
constexpr double kInCells = 0.25;
constexpr size_t kMostSuns = 32;
constexpr float kNearest = 0.1f; // m: nearer surfaces count as this far

/// The grid of cells over the bounding rectangle of a patch.
struct Grid
{
    glm::dvec3 origin{0.0}, u{0.0}, v{0.0}; ///< corner; unit vectors along the sides
    double width = 0.0, height = 0.0;       ///< m
    u32 nu = 1, nv = 1;                     ///< cells along them, powers of two

    u32 cellCount() const { return nu * nv; }
    glm::dvec3 at(double x, double y) const { return origin + x * width * u + y * height * v; }
};

/// The rectangle along the longest edge of the outline.
Grid gridOf(const NodeTree& tree, u32 patch, double largeCell)
{
    const std::span<const Ring3> rings = tree.outlineOf(patch);
    const glm::dvec3 normal = tree.nodes[patch].normal;
    glm::dvec3 along(0.0);
    double longest = 0.0;
    for (const Ring3& ring : rings) {
        for (size_t k = 0; k < ring.size(); ++k) {
            const glm::dvec3 edge = ring[(k + 1) % ring.size()] - ring[k];
            if (glm::length(edge) <= longest * (1.0 + 1e-9)) continue; // equal ones: the first, whatever its rounding
            longest = glm::length(edge);
            along = edge;
        }
    }
    Grid grid;
    grid.u = glm::normalize(along - glm::dot(along, normal) * normal);
    grid.v = glm::cross(normal, grid.u);
    glm::dvec2 low(1e300), high(-1e300);
    const glm::dvec3 base = rings[0][0];
    for (const Ring3& ring : rings)
        for (const glm::dvec3& corner : ring) {
            const glm::dvec2 p(glm::dot(corner - base, grid.u), glm::dot(corner - base, grid.v));
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    grid.origin = base + low.x * grid.u + low.y * grid.v;
    grid.width = high.x - low.x;
    grid.height = high.y - low.y;
    u32 cells = kFewestCells;
    while (cells < kMostCells && grid.width * grid.height > largeCell * double(cells)) cells *= 4;
    // As square as so many cells can be.
    while (grid.cellCount() < cells) (grid.width * grid.nv >= grid.height * grid.nu ? grid.nu : grid.nv) *= 2;
    return grid;
}

/// Direct light on the cells of a patch.
struct Samples
{
    std::vector<u8> points;     ///< of each cell that lie on the patch, 0..4
    std::vector<u32> suns;      ///< those that stand before the patch
    std::vector<u8> lit;        ///< [cell * suns + sun of these]: of the points, those that the sun reaches
    double total = 0.0;         ///< points of all cells
    std::vector<float> near;    ///< 1/m, of each cell: sum over its points of 1 / distance along a cosine ray
    std::vector<double> unit2;  ///< of each sun: what the variance of the lit share counts
    std::vector<double> square; ///< of each cell: its points x the mean square of the lit share, so counted
};

Samples sampleOf(const NodeTree& tree, const Visibility& visibility, std::span<const glm::dvec3> suns, u32 patch,
                 const Grid& grid)
{
    Samples s;
    s.points.assign(grid.cellCount(), 0);
    const glm::dvec3 normal = tree.nodes[patch].normal;
    const std::span<const Ring3> rings = tree.outlineOf(patch);
    const bool rectangle =
        rings.size() == 1 && rings[0].size() == 4 && tree.nodes[patch].area > (1.0 - 1e-6) * grid.width * grid.height;
    const std::array<u32, 4> shift = digitalShift(mixSeed(0x5911, patch));
    const u32 columns = grid.cellCount() <= kFewestCells ? 2 : 1; // strata of a cell, two rows of them
    std::vector<glm::dvec3> points;
    std::vector<u32> cellOf;
    for (u32 cell = 0; cell < grid.cellCount(); ++cell) {
        for (u32 k = 0; k < 2 * columns; ++k) {
            const std::array<double, 4> r = shiftedSobol4(cell * 2 * columns + k, shift);
            const double x = (cell % grid.nu + (k % columns + r[2]) / columns) / grid.nu,
                         y = (cell / grid.nu + 0.5 * (k / columns + r[3])) / grid.nv;
            const glm::dvec3 point = grid.at(x, y);
            if (!rectangle && !isInside(point, rings, normal)) continue;
            points.push_back(point);
            cellOf.push_back(cell);
            ++s.points[cell];
        }
    }
    std::vector<glm::dvec3> toSuns;
    for (u32 sun = 0; sun < suns.size(); ++sun) {
        if (glm::dot(normal, suns[sun]) <= 0.0) continue;
        s.suns.push_back(sun);
        toSuns.push_back(suns[sun]);
    }
    s.lit.assign(grid.cellCount() * toSuns.size(), 0);
    const size_t rays = points.size() * toSuns.size();
    const auto blocked = std::make_unique<bool[]>(rays);
    visibility.areBlocked(points, normal, toSuns, std::span(blocked.get(), rays));
    for (size_t k = 0; k < toSuns.size(); ++k)
        for (size_t p = 0; p < points.size(); ++p)
            if (!blocked[k * points.size() + p]) ++s.lit[cellOf[p] * toSuns.size() + k];
    s.total = double(points.size());
    s.near.assign(grid.cellCount(), 0.0f);
    const PlaneFrame frame = planeFrame(normal);
    std::vector<glm::dvec3> directions(points.size());
    std::vector<RayEnd> ends(points.size());
    for (u32 k = 0; k < points.size(); ++k) {
        const std::array<double, 4> x = shiftedSobol4(k, shift);
        directions[k] = cosineDirection(frame, x[0], x[1]);
    }
    visibility.trace(points, normal, directions, ends);
    for (u32 k = 0; k < points.size(); ++k)
        if (ends[k].node != kNoIndex) s.near[cellOf[k]] += 1.0f / std::max(kNearest, ends[k].distance);
    return s;
}

/// Cells x0..x1 - 1, y0..y1 - 1 of a grid.
struct Block
{
    u32 x0, y0, x1, y1;

    bool canCut(u32 axis) const { return axis == 0 ? x1 - x0 > 1 : y1 - y0 > 1; }
    std::array<Block, 2> cut(u32 axis) const
    {
        if (axis == 0) return {Block{x0, y0, (x0 + x1) / 2, y1}, Block{(x0 + x1) / 2, y0, x1, y1}};
        return {Block{x0, y0, x1, (y0 + y1) / 2}, Block{x0, (y0 + y1) / 2, x1, y1}};
    }
};

class Planner
{
public:
    Planner(const NodeTree& tree, const Visibility& visibility, std::span<const glm::dvec3> suns,
            std::span<const u8> mayCut, const SplitOptions& options)
        : tree_(tree), visibility_(visibility), suns_(suns), mayCut_(mayCut), options_(options)
    {
        HELIO_CHECK(mayCut.size() == tree.patchCount(), mayCut.size(), " marks for ", tree.patchCount(), " patches");
        HELIO_CHECK(suns.size() <= kMostSuns, suns.size(), " suns, the limit is ", kMostSuns);
        HELIO_CHECK(options.growth >= 1.0, "growth = ", options.growth);
    }

    SplitPlan run()
    {
        const u32 count = tree_.patchCount();
        grids_.resize(count);
        samples_.resize(count);
        parallelFor(count, 128, options_.jobs, [&](u32 begin, u32 end) {
            for (u32 patch = begin; patch < end; ++patch) {
                if (tree_.patches[patch].covered) continue;
                sample(patch, kLargeCell);
            }
        });
        weigh();
        sampleFiner();
        std::vector<Choice> first(count);
        parallelFor(count, 256, options_.jobs, [&](u32 begin, u32 end) {
            for (u32 patch = begin; patch < end; ++patch) {
                if (tree_.patches[patch].covered) continue;
                const Block whole{0, 0, grids_[patch].nu, grids_[patch].nv};
                if (mayCut_[patch] != 0)
                    first[patch] = choose(patch, whole);
                else
                    first[patch].error = errorOf(patch, whole);
            }
        });
        return grow(first);
    }

private:
    struct Choice
    {
        double error = 0.0; ///< of the block as it is
        double gain = 0.0;  ///< per added patch
        u32 axis = 0;
    };

    struct Candidate
    {
        Choice choice;
        u32 patch, cell;
        Block block;
        bool operator<(const Candidate& other) const
        {
            return choice.gain != other.choice.gain ? choice.gain < other.choice.gain
                                                    : cell > other.cell; // ties: the first one
        }
    };

    void sample(u32 patch, double largeCell)
    {
        grids_[patch] = gridOf(tree_, patch, largeCell);
        samples_[patch] = sampleOf(tree_, visibility_, suns_, patch, grids_[patch]);
    }

    /// Where much is left inside the cells of a patch: smaller ones. A parapet of a hand's breadth shades as wide a
    /// band of the roof that it looks at.
    void sampleFiner()
    {
        const double enough = kInCellsEnough * options_.unresolved * options_.unresolved;
        parallelFor(tree_.patchCount(), 128, options_.jobs, [&](u32 begin, u32 end) {
            for (u32 patch = begin; patch < end; ++patch)
                if (grids_[patch].cellCount() > kFewestCells &&
                    kInCells * errorInCells(patch) > enough * tree_.patches[patch].area)
                    sample(patch, kSmallCell);
        });
        weigh();
    }

    /// What the lit shares count: unit2 and square of all samples, units being rho cos(theta) / mean light.
    void weigh()
    {
        std::vector<double> mean(suns_.size(), 0.0);
        area_ = 0.0;
        for (u32 patch = 0; patch < tree_.patchCount(); ++patch) {
            const Patch& p = tree_.patches[patch];
            area_ += p.area;
            const Samples& s = samples_[patch];
            for (size_t k = 0; k < s.suns.size() && s.total > 0.0; ++k) {
                double lit = 0.0;
                for (u32 cell = 0; cell < grids_[patch].cellCount(); ++cell) lit += s.lit[cell * s.suns.size() + k];
                mean[s.suns[k]] += p.area * p.rho.w * cosine(patch, s.suns[k]) * lit / s.total;
            }
        }
        for (u32 patch = 0; patch < tree_.patchCount(); ++patch) {
            Samples& s = samples_[patch];
            s.unit2.clear();
            for (const u32 sun : s.suns) {
                const double unit =
                    mean[sun] > 0.0 ? tree_.patches[patch].rho.w * cosine(patch, sun) * area_ / mean[sun] : 0.0;
                s.unit2.push_back(unit * unit / double(suns_.size()));
            }
            s.square.assign(s.points.size(), 0.0);
            for (u32 cell = 0; cell < s.points.size(); ++cell) {
                if (s.points[cell] == 0) continue;
                for (size_t k = 0; k < s.suns.size(); ++k) {
                    const double lit = s.lit[cell * s.suns.size() + k];
                    s.square[cell] += s.unit2[k] * lit * lit / s.points[cell];
                }
            }
        }
    }

    double cosine(u32 patch, u32 sun) const { return glm::dot(tree_.nodes[patch].normal, suns_[sun]); }

    /// Area of the block x variance of the light inside it, mean over the suns, x (size x nearness)^2, m2.
    double errorOf(u32 patch, const Block& b) const
    {
        const Samples& s = samples_[patch];
        const Grid& grid = grids_[patch];
        const size_t n = s.suns.size();
        std::array<u16, kMostSuns> lit{};
        u32 points = 0;
        double near = 0.0, squares = 0.0;
        for (u32 y = b.y0; y < b.y1; ++y) {
            for (u32 cell = y * grid.nu + b.x0; cell < y * grid.nu + b.x1; ++cell) {
                points += s.points[cell];
                near += double(s.near[cell]);
                squares += s.square[cell];
                const u8* row = s.lit.data() + cell * n;
                for (size_t k = 0; k < n; ++k) lit[k] = u16(lit[k] + row[k]);
            }
        }
        if (points == 0) return 0.0;
        const double share = 1.0 / double(points);
        double variance = squares * share;
        for (size_t k = 0; k < n; ++k) variance -= s.unit2[k] * (lit[k] * share) * (lit[k] * share);
        const double width = grid.width * (b.x1 - b.x0) / grid.nu, height = grid.height * (b.y1 - b.y0) / grid.nv;
        const double size = std::max(width, height) * near * share;
        return tree_.patches[patch].area * points / s.total * std::max(0.0, variance) * std::min(1.0, size * size);
    }

    /// The same inside the cells, which no cut can resolve.
    double errorInCells(u32 patch) const
    {
        const Samples& s = samples_[patch];
        const Grid& grid = grids_[patch];
        const size_t n = s.suns.size();
        const double size = std::max(grid.width / grid.nu, grid.height / grid.nv);
        double sum = 0.0, points = 0.0;
        for (u32 cell = 0; cell < s.points.size(); ++cell) {
            const double inCell = s.points[cell];
            points += inCell;
            if (inCell < 2.0) continue;
            double variance = 0.0;
            for (size_t k = 0; k < n; ++k) {
                const double lit = s.lit[cell * n + k];
                variance += s.unit2[k] * lit * (inCell - lit) / (inCell * (inCell - 1.0));
            }
            const double near = size * double(s.near[cell]) / inCell;
            sum += inCell * variance * std::min(1.0, near * near);
        }
        return points > 0.0 ? tree_.patches[patch].area * sum / points : 0.0;
    }

    /// The first of the cuts that gain most per added patch; looks two cuts ahead, since one alone may gain nothing.
    Choice choose(u32 patch, const Block& block) const
    {
        Choice best;
        const double whole = best.error = errorOf(patch, block);
        if (whole <= 0.0) return best;
        for (u32 axis = 0; axis < 2; ++axis) {
            if (!block.canCut(axis)) continue;
            const std::array<Block, 2> parts = block.cut(axis);
            const double after = errorOf(patch, parts[0]) + errorOf(patch, parts[1]);
            if (whole - after > best.gain) best = {whole, whole - after, axis};
            for (u32 second = 0; second < 2; ++second) {
                if (!parts[0].canCut(second) || !parts[1].canCut(second)) continue;
                double quarters = 0.0;
                for (const Block& part : parts)
                    for (const Block& quarter : part.cut(second)) quarters += errorOf(patch, quarter);
                if ((whole - quarters) / 3.0 > best.gain) best = {whole, (whole - quarters) / 3.0, axis};
            }
        }
        return best;
    }

    SplitPlan grow(const std::vector<Choice>& first)
    {
        SplitPlan plan;
        const u32 count = tree_.patchCount();
        plan.root.assign(count, kNoIndex);
        plan.partCount = count;
        double total = 0.0;
        std::priority_queue<Candidate> queue;
        for (u32 patch = 0; patch < count; ++patch) {
            total += first[patch].error;
            if (first[patch].gain > 0.0)
                queue.push({first[patch], patch, patch, {0, 0, grids_[patch].nu, grids_[patch].nv}});
        }
        const double whole = total;
        const double limit = options_.unresolved * options_.unresolved * area_;
        const u32 most = u32(std::min(double(kNoIndex / 2), options_.growth * double(count)));
        while (!queue.empty() && plan.partCount < most && total > limit) {
            const Candidate c = queue.top();
            queue.pop();
            // Cells of patches not cut before have the patch's number here, and get one of their own now.
            u32 cell = c.cell;
            if (plan.root[c.patch] == kNoIndex) {
                cell = plan.root[c.patch] = u32(plan.cells.size());
                plan.cells.emplace_back();
            } else {
                cell -= count;
            }
            const Grid& grid = grids_[c.patch];
            const std::array<Block, 2> parts = c.block.cut(c.choice.axis);
            const u32 low = u32(plan.cells.size());
            plan.cells.resize(low + 2);
            SplitCell& at = plan.cells[cell];
            at.low = low;
            at.high = low + 1;
            at.normal = c.choice.axis == 0 ? grid.u : grid.v;
            const glm::dvec3 place = c.choice.axis == 0 ? grid.at(double(parts[1].x0) / grid.nu, 0.0)
                                                        : grid.at(0.0, double(parts[1].y0) / grid.nv);
            at.offset = glm::dot(at.normal, place);
            total -= c.choice.error;
            ++plan.partCount;
            for (u32 k = 0; k < 2; ++k) {
                const Choice next = choose(c.patch, parts[k]);
                total += next.error;
                if (next.gain > 0.0) queue.push({next, c.patch, count + low + k, parts[k]});
            }
        }
        const auto rootMean = [&](double sum) { return area_ > 0.0 ? std::sqrt(std::max(0.0, sum) / area_) : 0.0; };
        double inCells = 0.0;
        for (u32 patch = 0; patch < count; ++patch) inCells += kInCells * errorInCells(patch);
        plan.unresolved = rootMean(total + inCells);
        plan.unresolvedWhole = rootMean(whole + inCells);
        return plan;
    }

    const NodeTree& tree_;
    const Visibility& visibility_;
    std::span<const glm::dvec3> suns_;
    std::span<const u8> mayCut_;
    SplitOptions options_;
    std::vector<Grid> grids_;
    std::vector<Samples> samples_;
    double area_ = 0.0;
};

} // namespace

SplitPlan planSplits(const NodeTree& tree, const Visibility& visibility, std::span<const glm::dvec3> suns,
                     std::span<const u8> mayCut, const SplitOptions& options)
{
    return Planner(tree, visibility, suns, mayCut, options).run();
}

} // namespace helio
