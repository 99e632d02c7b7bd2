// SPDX-License-Identifier: Apache-2.0
#include "city/layout/city_blocks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace helio {

namespace {

constexpr u32 kColumns = 4, kRows = 3;
constexpr double kWidth = 300.0, kDepth = 245.0; // m between the outermost centre-lines

// Lines of the lattice of one direction with their streets.
struct Lines
{
    std::vector<double> at, width, slant;
    std::vector<StreetKind> kind;
};

void setKind(Random& random, Lines& lines, u32 index, StreetKind kind)
{
    lines.kind[index] = kind;
    lines.width[index] = kind == StreetKind::Avenue   ? 20.0 + 2.0 * below(random, 3)
                         : kind == StreetKind::Street ? 11.0 + below(random, 4)
                                                      : 7.0 + 0.5 * below(random, 3);
}

// `weights`: relative distances between the lines.
Lines planLines(Random& random, const std::vector<double>& weights, double size)
{
    Lines lines;
    double sum = 0.0;
    for (size_t i = 0; i <= weights.size(); ++i) {
        lines.at.push_back(sum);
        if (i < weights.size()) sum += weights[i] * range(random, 0.92, 1.09);
        lines.slant.push_back(range(random, -0.035, 0.035));
    }
    for (double& at : lines.at) at = (at / sum - 0.5) * size;
    lines.kind.resize(lines.at.size());
    lines.width.resize(lines.at.size());
    for (u32 i = 0; i < lines.at.size(); ++i) setKind(random, lines, i, StreetKind::Street);
    return lines;
}

// A street between two crossings, bent in its middle or straight.
Ring2 streetBend(Random& random, const glm::dvec2& a, const glm::dvec2& b, bool mayBend)
{
    const bool isBent = chance(random, 0.5);
    const double sag = range(random, 2.0, 4.5) * (chance(random, 0.5) ? 1.0 : -1.0);
    const double along = range(random, 0.4, 0.6);
    if (!isBent || !mayBend) return {};
    return {a + along * (b - a) + sag * leftNormal(a, b)};
}

// A cell of the lattice before the streets are taken off: its border on the centre-lines.
struct Cell
{
    Ring2 ring;
    std::vector<double> halfWidth; // per edge
    std::vector<u32> side;
    BlockUse use = BlockUse::Perimeter;

    void addSide(u32 number, const glm::dvec2& start, const Ring2& bend, double half)
    {
        ring.push_back(start);
        ring.insert(ring.end(), bend.begin(), bend.end());
        halfWidth.resize(ring.size(), half);
        side.resize(ring.size(), number);
    }
    const glm::dvec2& next(size_t edge) const { return ring[(edge + 1) % ring.size()]; }
    size_t edgeOf(u32 number) const { return size_t(std::find(side.begin(), side.end(), number) - side.begin()); }
};

// Halves a cell by a lane between its western and its eastern side, which must be straight; returns the lane. The
// southern half stays in `south`.
CityStreet halve(Random& random, Cell& south, Cell& north)
{
    const Cell whole = south;
    const size_t east = whole.edgeOf(1), west = whole.edgeOf(3);
    const auto middle = [&](size_t edge) {
        const glm::dvec2 a = whole.ring[edge], b = whole.next(edge);
        return a + range(random, 0.46, 0.54) * (b - a);
    };
    const CityStreet lane{{middle(west), middle(east)}, StreetKind::Lane, 7.0 + 0.5 * below(random, 3)};
    south = north = Cell{{}, {}, {}, whole.use};
    const auto copy = [&](Cell& to, size_t edge, const glm::dvec2& start) {
        to.addSide(whole.side[edge], start, {}, whole.halfWidth[edge]);
    };
    for (size_t i = 0; i <= east; ++i) copy(south, i, whole.ring[i]);
    south.addSide(2, lane.line[1], {}, 0.5 * lane.width);
    copy(south, west, lane.line[0]);
    for (size_t i = west + 1; i < whole.ring.size(); ++i) copy(south, i, whole.ring[i]);

    north.addSide(0, lane.line[0], {}, 0.5 * lane.width);
    copy(north, east, lane.line[1]);
    for (size_t i = east + 1; i <= west; ++i) copy(north, i, whole.ring[i]);
    return lane;
}

// The outline moved inwards, each edge by its own distance.
Ring2 inset(const Ring2& ring, const std::vector<double>& distance)
{
    const size_t n = ring.size();
    Ring2 moved;
    for (size_t i = 0; i < n; ++i) {
        const size_t before = (i + n - 1) % n, after = (i + 1) % n;
        const glm::dvec2 p = ring[i] + distance[before] * leftNormal(ring[before], ring[i]);
        const glm::dvec2 q = ring[i] + distance[i] * leftNormal(ring[i], ring[after]);
        moved.push_back(lineCrossing(p, ring[i] - ring[before], q, ring[after] - ring[i]));
    }
    return moved;
}

// Cuts sharp corners off, as corner houses on crossings have it.
void chamfer(Random& random, CityBlock& block)
{
    const Ring2 ring = std::move(block.outline);
    const std::vector<u32> side = std::move(block.side);
    const size_t n = ring.size();
    block.outline.clear();
    block.side.clear();
    for (size_t i = 0; i < n; ++i) {
        const glm::dvec2 in = glm::normalize(ring[i] - ring[(i + n - 1) % n]);
        const glm::dvec2 out = glm::normalize(ring[(i + 1) % n] - ring[i]);
        const bool wanted = chance(random, 0.6);
        const double length = range(random, 3.0, 4.5);
        if (wanted && cross(in, out) > 0.7) {
            block.outline.push_back(ring[i] - length * in);
            block.side.push_back(kNoIndex);
            block.outline.push_back(ring[i] + length * out);
        } else {
            block.outline.push_back(ring[i]);
        }
        block.side.push_back(side[i]);
    }
}

CityBlock blockOf(Random& random, const Cell& cell)
{
    CityBlock block{inset(cell.ring, cell.halfWidth), cell.side, cell.use};
    if (cell.use == BlockUse::Perimeter) chamfer(random, block);
    for (glm::dvec2& corner : block.outline) corner = onMillimetre(corner);
    return block;
}

// Which cell becomes what. Row 0 or kRows - 1 is the shallow one.
struct Uses
{
    u32 shallowRow, avenue, lane;
    u32 squareColumn, towerColumn, towerRow, rowColumn;
    u32 halvedRow[2]; // in the first and in the last column; kNoIndex = none
    BlockUse at(u32 i, u32 j) const
    {
        if (j == 1 && i == squareColumn) return BlockUse::Square;
        if (j == towerRow && i == towerColumn) return BlockUse::Towers;
        if (j == shallowRow && (i == rowColumn || i == rowColumn + 1)) return BlockUse::Rows;
        return BlockUse::Perimeter;
    }
    bool isHalved(u32 i, u32 j) const
    {
        return (i == 0 || i == kColumns - 1) && j == halvedRow[i == 0 ? 0 : 1] && at(i, j) == BlockUse::Perimeter;
    }
};

// The avenue parts the first two columns from the last two; the square lies on one side of it in the middle row, the
// towers on the other side in the deep outer row, the row-houses away from the towers.
Uses planUses(Random& random)
{
    Uses uses;
    uses.shallowRow = chance(random, 0.5) ? 0 : kRows - 1;
    uses.avenue = 2;
    uses.lane = chance(random, 0.5) ? 1 : 3;
    const bool squareWest = chance(random, 0.5);
    uses.squareColumn = squareWest ? 1 : 2;
    uses.towerColumn = squareWest ? 2 : 1;
    uses.towerRow = kRows - 1 - uses.shallowRow;
    uses.rowColumn = chance(random, 0.5) ? 0 : 2;
    for (u32& row : uses.halvedRow) row = chance(random, 0.5) ? 1 : uses.towerRow;
    return uses;
}

class Planner
{
public:
    explicit Planner(Random& random) : random_(random), uses_(planUses(random))
    {
        std::vector<double> depths(kRows, 1.0);
        depths[uses_.shallowRow] = 0.64;
        std::vector<double> widths(kColumns, 1.0);
        widths[uses_.towerColumn] = 1.1;
        x_ = planLines(random, widths, kWidth);
        y_ = planLines(random, depths, kDepth);
        setKind(random, x_, uses_.avenue, StreetKind::Avenue);
        setKind(random, x_, uses_.lane, StreetKind::Lane);
        setKind(random, y_, uses_.shallowRow == 0 ? 1 : kRows - 1, StreetKind::Lane);
        x_.slant[uses_.avenue] = range(random, 0.06, 0.12) * (chance(random, 0.5) ? 1.0 : -1.0);
        placeCrossings();
        bendStreets();
    }

    CityPlan run()
    {
        CityPlan plan;
        addStreets(plan);
        plan.border = borderOf();
        for (u32 j = 0; j < kRows; ++j)
            for (u32 i = 0; i < kColumns; ++i) {
                Cell cell = cellAt(i, j);
                if (uses_.isHalved(i, j)) {
                    Cell other;
                    plan.streets.push_back(halve(random_, cell, other));
                    plan.blocks.push_back(blockOf(random_, other));
                }
                plan.blocks.push_back(blockOf(random_, cell));
            }
        return plan;
    }

private:
    size_t at(u32 i, u32 j) const { return j * (kColumns + 1) + i; }

    void placeCrossings()
    {
        const double turn = range(random_, 0.1, 0.3) * (chance(random_, 0.5) ? 1.0 : -1.0);
        const double sine = std::sin(turn), cosine = std::cos(turn);
        for (u32 j = 0; j <= kRows; ++j)
            for (u32 i = 0; i <= kColumns; ++i) {
                const double dx = range(random_, -4.5, 4.5), dy = range(random_, -4.5, 4.5);
                // The avenue stays straight.
                const double y = y_.at[j] + y_.slant[j] * x_.at[i] + dy;
                const double x = x_.at[i] + x_.slant[i] * y + (i == uses_.avenue ? 0.0 : dx);
                crossings_.emplace_back(cosine * x - sine * y, sine * x + cosine * y);
            }
    }

    bool isStraight(u32 i, u32 j) const { return uses_.at(i, j) == BlockUse::Rows || uses_.isHalved(i, j); }

    // Rows of houses, lanes that halve a block and the avenue want straight streets, and a bend would leave parts too
    // short for a house on the short sides of shallow blocks.
    void bendStreets()
    {
        alongX_.resize(crossings_.size());
        alongY_.resize(crossings_.size());
        for (u32 j = 0; j <= kRows; ++j)
            for (u32 i = 0; i < kColumns; ++i) {
                const bool straight = (j < kRows && isStraight(i, j)) || (j > 0 && isStraight(i, j - 1));
                alongX_[at(i, j)] = streetBend(random_, crossings_[at(i, j)], crossings_[at(i + 1, j)], !straight);
            }
        for (u32 j = 0; j < kRows; ++j)
            for (u32 i = 0; i <= kColumns; ++i) {
                const bool straight = i == uses_.avenue || j == uses_.shallowRow ||
                                      (i < kColumns && isStraight(i, j)) || (i > 0 && isStraight(i - 1, j));
                alongY_[at(i, j)] = streetBend(random_, crossings_[at(i, j)], crossings_[at(i, j + 1)], !straight);
            }
    }

    Cell cellAt(u32 i, u32 j) const
    {
        Cell cell;
        cell.use = uses_.at(i, j);
        cell.addSide(0, crossings_[at(i, j)], alongX_[at(i, j)], 0.5 * y_.width[j]);
        cell.addSide(1, crossings_[at(i + 1, j)], alongY_[at(i + 1, j)], 0.5 * x_.width[i + 1]);
        cell.addSide(2, crossings_[at(i + 1, j + 1)], alongX_[at(i, j + 1)], 0.5 * y_.width[j + 1]);
        cell.addSide(3, crossings_[at(i, j + 1)], alongY_[at(i, j)], 0.5 * x_.width[i]);
        return cell;
    }

    // All around on the outermost centre-lines.
    Ring2 borderOf() const
    {
        Ring2 ring;
        const auto add = [&](const glm::dvec2& corner, const Ring2& bend, bool reverse) {
            if (!reverse) ring.push_back(corner);
            ring.insert(ring.end(), bend.begin(), bend.end()); // one corner at most
            if (reverse) ring.push_back(corner);
        };
        for (u32 i = 0; i < kColumns; ++i) add(crossings_[at(i, 0)], alongX_[at(i, 0)], false);
        for (u32 j = 0; j < kRows; ++j) add(crossings_[at(kColumns, j)], alongY_[at(kColumns, j)], false);
        ring.push_back(crossings_[at(kColumns, kRows)]);
        for (u32 i = kColumns; i-- > 0;) add(crossings_[at(i, kRows)], alongX_[at(i, kRows)], true);
        for (u32 j = kRows; j-- > 0;) add(crossings_[at(0, j)], alongY_[at(0, j)], true);
        ring.pop_back(); // the first corner again
        return ring;
    }

    void addStreets(CityPlan& plan) const
    {
        const auto add = [&](const glm::dvec2& a, const Ring2& bend, const glm::dvec2& b, const Lines& lines, u32 k) {
            CityStreet street{{a}, lines.kind[k], lines.width[k]};
            street.line.insert(street.line.end(), bend.begin(), bend.end());
            street.line.push_back(b);
            plan.streets.push_back(std::move(street));
        };
        for (u32 j = 0; j <= kRows; ++j)
            for (u32 i = 0; i <= kColumns; ++i) {
                if (i < kColumns) add(crossings_[at(i, j)], alongX_[at(i, j)], crossings_[at(i + 1, j)], y_, j);
                if (j < kRows) add(crossings_[at(i, j)], alongY_[at(i, j)], crossings_[at(i, j + 1)], x_, i);
            }
    }

    Random& random_;
    Uses uses_;
    Lines x_, y_;
    std::vector<glm::dvec2> crossings_;
    std::vector<Ring2> alongX_, alongY_; // bends, in the direction of growing i or j
};

} // namespace

glm::dvec2 onMillimetre(const glm::dvec2& point)
{
    return {std::round(point.x * 1000.0) / 1000.0, std::round(point.y * 1000.0) / 1000.0};
}

glm::dvec2 lineCrossing(const glm::dvec2& p, const glm::dvec2& d, const glm::dvec2& q, const glm::dvec2& e)
{
    return p + d * (cross(q - p, e) / cross(d, e));
}

glm::dvec2 leftNormal(const glm::dvec2& a, const glm::dvec2& b)
{
    const glm::dvec2 along = glm::normalize(b - a);
    return {-along.y, along.x};
}

Polygon2 orientedBox(const glm::dvec2& corner, const glm::dvec2& along, double length, double width)
{
    const glm::dvec2 a = length * along, b = width * glm::dvec2(-along.y, along.x);
    Polygon2 polygon;
    for (const glm::dvec2& p : {corner, corner + a, corner + a + b, corner + b})
        polygon.outer.push_back(onMillimetre(p));
    return polygon;
}

CityPlan planCity(Random& random)
{
    return Planner(random).run();
}

} // namespace helio
