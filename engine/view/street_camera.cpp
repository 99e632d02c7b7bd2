// SPDX-License-Identifier: Apache-2.0
#include "engine/view/street_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "engine/stream/tile_tables.h"

namespace helio {

namespace {

constexpr double kEyeHeight = 1.7; // m
constexpr double kObstacle = 1.0;  // m above the lowest ground
constexpr double kClearance = 4.0; // m that a good standpoint keeps from walls
constexpr u32 kDirections = 48;

/// Which cells of a square grid hold something that stands in the way.
class Obstacles
{
public:
    Obstacles(const TileView& tile, glm::dvec3 lo, glm::dvec3 hi)
        : lo_(lo), cell_(std::max({1.0, (hi.x - lo.x) / 1024.0, (hi.y - lo.y) / 1024.0})),
          width_(u32((hi.x - lo.x) / cell_) + 1), height_(u32((hi.y - lo.y) / cell_) + 1),
          taken_(size_t(width_) * height_, 0)
    {
        const std::vector<u32> triangles = staticTriangles(tile);
        for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
            const glm::dvec3 a(tile.vertices[triangles[i]].position), b(tile.vertices[triangles[i + 1]].position),
                c(tile.vertices[triangles[i + 2]].position);
            if (std::max({a.z, b.z, c.z}) > lo.z + kObstacle) fill(glm::dvec2(a), glm::dvec2(b), glm::dvec2(c));
        }
    }

    bool taken(double x, double y) const
    {
        const double i = (x - lo_.x) / cell_, j = (y - lo_.y) / cell_;
        if (i < 0.0 || j < 0.0 || i >= width_ || j >= height_) return true;
        return taken_[size_t(u32(j)) * width_ + u32(i)] != 0;
    }
    double cell() const { return cell_; }

    /// Length of the free line from a point, m.
    double freeLength(double x, double y, double azimuth) const
    {
        double length = 0.0;
        while (length < 400.0 && !taken(x + length * std::sin(azimuth), y + length * std::cos(azimuth)))
            length += cell_ / 2.0;
        return length;
    }

private:
    void mark(glm::dvec2 at)
    {
        const double x = std::clamp((at.x - lo_.x) / cell_, 0.0, double(width_ - 1));
        const double y = std::clamp((at.y - lo_.y) / cell_, 0.0, double(height_ - 1));
        taken_[size_t(u32(y)) * width_ + u32(x)] = 1;
    }

    /// Marks the cells under a triangle by points half a cell apart: enough for walls, which are lines from above, too.
    void fill(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
    {
        const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        const u32 steps = u32(std::ceil(2.0 * longest / cell_)) + 1;
        for (u32 i = 0; i <= steps; ++i)
            for (u32 j = 0; i + j <= steps; ++j) mark(a + (double(i) * (b - a) + double(j) * (c - a)) / double(steps));
    }

    glm::dvec3 lo_;
    double cell_;
    u32 width_, height_;
    std::vector<u8> taken_;
};

} // namespace

Camera streetCamera(const TileView& tile, glm::dvec3 boundsMin, glm::dvec3 boundsMax)
{
    const Obstacles obstacles(tile, boundsMin, boundsMax);
    const glm::dvec3 middle = (boundsMin + boundsMax) / 2.0;
    const double reach = 0.3 * std::min(boundsMax.x - boundsMin.x, boundsMax.y - boundsMin.y);

    // The longest view that still has walls close by on both sides is down a street, not over a square.
    double bestScore = -1.0, bestAzimuth = 0.0;
    glm::dvec2 best(middle);
    const double step = std::max(2.0 * obstacles.cell(), reach / 40.0);
    for (double y = middle.y - reach; y <= middle.y + reach; y += step) {
        for (double x = middle.x - reach; x <= middle.x + reach; x += step) {
            if (obstacles.taken(x, y)) continue;
            for (u32 k = 0; k < kDirections; ++k) {
                const double azimuth = 2.0 * std::numbers::pi * k / kDirections;
                const double ahead = std::min(obstacles.freeLength(x, y, azimuth), 150.0);
                const double left = obstacles.freeLength(x, y, azimuth - std::numbers::pi / 2.0);
                const double right = obstacles.freeLength(x, y, azimuth + std::numbers::pi / 2.0);
                const double clearance = std::min({left, right, kClearance}) / kClearance;
                const double score = ahead * clearance / (1.0 + 0.05 * std::max(left + right - 20.0, 0.0));
                if (score > bestScore) {
                    bestScore = score;
                    bestAzimuth = azimuth;
                    best = {x, y};
                }
            }
        }
    }
    Camera camera;
    camera.fovDegrees = 60.0;
    camera.eye = {best.x, best.y, boundsMin.z + kEyeHeight};
    camera.target = camera.eye + glm::dvec3(std::sin(bestAzimuth), std::cos(bestAzimuth), 0.06) * 30.0;
    return camera;
}

} // namespace helio
