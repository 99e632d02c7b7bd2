// SPDX-License-Identifier: Apache-2.0
#include "city/assets/front_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace helio {

namespace {

constexpr int kGrid = 128;

double cross2(const glm::dvec3& a, const glm::dvec3& b, double x, double y)
{
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

} // namespace

glm::dvec4 frontViewReflectance(const AssetMesh& mesh, std::span<const glm::dvec4> triangleRho)
{
    HELIO_CHECK(triangleRho.size() * 3 == mesh.indices.size(), triangleRho.size(), " entries for ", mesh.indices.size(),
                " indices");
    const glm::dvec3 cell = (mesh.boxMax - mesh.boxMin) / double(kGrid);
    std::vector<double> depth(size_t(kGrid) * kGrid, -INFINITY);
    std::vector<u32> seen(depth.size(), kNoIndex);
    glm::dvec4 areaSum(0.0);
    double areaTotal = 0.0;
    for (size_t t = 0; t < triangleRho.size(); ++t) {
        glm::dvec3 v[3];
        for (size_t k = 0; k < 3; ++k) v[k] = (glm::dvec3(mesh.positions[mesh.indices[3 * t + k]]) - mesh.boxMin);
        const double area = 0.5 * glm::length(glm::cross(v[1] - v[0], v[2] - v[0]));
        areaSum += area * triangleRho[t];
        areaTotal += area;
        const double twice = cross2(v[0], v[1], v[2].x, v[2].y);
        if (!(twice > 0.0) || !(cell.x > 0.0) || !(cell.y > 0.0)) continue;
        const auto range = [](double low, double high, double step) {
            return std::pair(std::clamp(int(std::ceil(low / step - 0.5)), 0, kGrid),
                             std::clamp(int(std::floor(high / step - 0.5)) + 1, 0, kGrid));
        };
        const auto [x0, x1] = range(std::min({v[0].x, v[1].x, v[2].x}), std::max({v[0].x, v[1].x, v[2].x}), cell.x);
        const auto [y0, y1] = range(std::min({v[0].y, v[1].y, v[2].y}), std::max({v[0].y, v[1].y, v[2].y}), cell.y);
        for (int row = y0; row < y1; ++row)
            for (int column = x0; column < x1; ++column) {
                const double x = (column + 0.5) * cell.x, y = (row + 0.5) * cell.y;
                const double a = cross2(v[1], v[2], x, y), b = cross2(v[2], v[0], x, y), c = cross2(v[0], v[1], x, y);
                if (a < 0.0 || b < 0.0 || c < 0.0) continue;
                const double z = (a * v[0].z + b * v[1].z + c * v[2].z) / twice;
                const size_t pixel = size_t(row) * kGrid + size_t(column);
                if (z <= depth[pixel]) continue;
                depth[pixel] = z;
                seen[pixel] = u32(t);
            }
    }
    glm::dvec4 sum(0.0);
    double count = 0.0;
    for (const u32 t : seen) {
        if (t == kNoIndex) continue;
        sum += triangleRho[t];
        count += 1.0;
    }
    if (count > 0.0) return sum / count;
    return areaTotal > 0.0 ? areaSum / areaTotal : glm::dvec4(0.5);
}

} // namespace helio
