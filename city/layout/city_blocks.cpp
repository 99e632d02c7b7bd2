// SPDX-License-Identifier: Apache-2.0
#include "city/layout/city_blocks.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace helio {

namespace {

// Lines of the lattice with their street widths.
struct Lines
{
    std::vector<double> at;
    std::vector<double> halfWidth;
};

Lines planLines(Random& random, u32 count, double size, u32 avenue)
{
    Lines lines;
    double sum = 0.0;
    for (u32 i = 0; i <= count; ++i) {
        lines.at.push_back(sum);
        sum += range(random, 0.85, 1.2);
        const double widths[] = {8.0, 9.0, 11.0, 14.0};
        lines.halfWidth.push_back(0.5 * (i == avenue ? 20.0 : widths[below(random, 4)]));
    }
    const double length = lines.at.back();
    for (double& at : lines.at) at = (at / length - 0.5) * size;
    return lines;
}

// A street between two crossings, bent in its middle or straight.
std::vector<glm::dvec2> streetBend(Random& random, const glm::dvec2& a, const glm::dvec2& b)
{
    const bool isBent = chance(random, 0.45);
    const double sag = range(random, 2.0, 4.5) * (chance(random, 0.5) ? 1.0 : -1.0);
    const double along = range(random, 0.4, 0.6);
    if (!isBent) return {};
    return {a + along * (b - a) + sag * leftNormal(a, b)};
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
Ring2 chamfer(Random& random, const Ring2& ring)
{
    const size_t n = ring.size();
    Ring2 cut;
    for (size_t i = 0; i < n; ++i) {
        const glm::dvec2 in = glm::normalize(ring[i] - ring[(i + n - 1) % n]);
        const glm::dvec2 out = glm::normalize(ring[(i + 1) % n] - ring[i]);
        const bool wanted = chance(random, 0.6);
        const double length = range(random, 3.0, 4.5);
        if (wanted && cross(in, out) > 0.7) {
            cut.push_back(ring[i] - length * in);
            cut.push_back(ring[i] + length * out);
        } else {
            cut.push_back(ring[i]);
        }
    }
    return cut;
}

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

std::vector<CityBlock> planBlocks(Random& random, u32 columns, u32 rows, double size)
{
    const u32 avenue = 1 + below(random, columns - 1);
    const Lines x = planLines(random, columns, size, avenue), y = planLines(random, rows, size, kNoIndex);
    const double turn = range(random, 0.12, 0.35) * (chance(random, 0.5) ? 1.0 : -1.0);
    const double sine = std::sin(turn), cosine = std::cos(turn);
    std::vector<glm::dvec2> crossings;
    for (u32 j = 0; j <= rows; ++j) {
        for (u32 i = 0; i <= columns; ++i) {
            const glm::dvec2 p(x.at[i] + range(random, -5.5, 5.5), y.at[j] + range(random, -5.5, 5.5));
            crossings.emplace_back(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y);
        }
    }
    const auto crossing = [&](u32 i, u32 j) { return crossings[j * (columns + 1) + i]; };
    std::vector<std::vector<glm::dvec2>> alongX, alongY; // bends, in the direction of growing i or j
    for (u32 j = 0; j <= rows; ++j)
        for (u32 i = 0; i < columns; ++i) alongX.push_back(streetBend(random, crossing(i, j), crossing(i + 1, j)));
    for (u32 j = 0; j < rows; ++j)
        for (u32 i = 0; i <= columns; ++i) alongY.push_back(streetBend(random, crossing(i, j), crossing(i, j + 1)));

    const u32 square = (1 + below(random, rows - 2)) * columns + 1 + below(random, columns - 2);
    std::vector<CityBlock> blocks;
    for (u32 j = 0; j < rows; ++j) {
        for (u32 i = 0; i < columns; ++i) {
            Ring2 ring;
            std::vector<double> distance;
            const auto addSide = [&](const glm::dvec2& start, const std::vector<glm::dvec2>& bend, double halfWidth) {
                ring.push_back(start);
                ring.insert(ring.end(), bend.begin(), bend.end());
                distance.resize(ring.size(), halfWidth);
            };
            addSide(crossing(i, j), alongX[j * columns + i], y.halfWidth[j]);
            addSide(crossing(i + 1, j), alongY[j * (columns + 1) + i + 1], x.halfWidth[i + 1]);
            addSide(crossing(i + 1, j + 1), alongX[(j + 1) * columns + i], y.halfWidth[j + 1]);
            addSide(crossing(i, j + 1), alongY[j * (columns + 1) + i], x.halfWidth[i]);
            CityBlock block{chamfer(random, inset(ring, distance)), blocks.size() == square};
            for (glm::dvec2& corner : block.outline) corner = onMillimetre(corner);
            blocks.push_back(std::move(block));
        }
    }
    return blocks;
}

} // namespace helio
