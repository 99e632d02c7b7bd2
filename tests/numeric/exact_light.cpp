// SPDX-License-Identifier: Apache-2.0
#include "tests/numeric/exact_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/light/form_factor.h"

namespace helio::test {

std::vector<double> exactFactors(const std::vector<Face>& faces)
{
    const size_t n = faces.size();
    std::vector<std::vector<Ring3>> rings;
    std::vector<PlanarShape> shapes;
    for (const Face& face : faces) rings.push_back({face.ring});
    for (const std::vector<Ring3>& ring : rings) shapes.push_back(planarShape(ring));
    std::vector<double> factors(n * n, 0.0);
    for (size_t i = 0; i < n; ++i)
        for (size_t j = i + 1; j < n; ++j) {
            const double flux = exchange(shapes[i], shapes[j]);
            factors[i * n + j] = flux / shapes[i].area;
            factors[j * n + i] = flux / shapes[j].area;
        }
    return factors;
}

std::vector<double> crossedStrings(std::span<const Strip> strips)
{
    const size_t n = strips.size();
    std::vector<double> factors(n * n, 0.0);
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < n; ++j) {
            const auto& [a, b] = strips[i];
            const auto& [c, d] = strips[j];
            if (i == j) continue;
            // The way a, b, c, d goes round the quadrilateral between them: a-c and b-d are its diagonals.
            const double crossed = glm::distance(a, c) + glm::distance(b, d),
                         sides = glm::distance(a, d) + glm::distance(b, c);
            factors[i * n + j] = std::max(0.0, (crossed - sides) / (2.0 * glm::distance(a, b)));
        }
    return factors;
}

double meanOf(std::span<const double> areas, std::span<const double> values, size_t begin, size_t end)
{
    double area = 0.0, sum = 0.0;
    for (size_t i = begin; i < end; ++i) {
        area += areas[i];
        sum += areas[i] * values[i];
    }
    return sum / area;
}

double orderOf(double coarseError, double fineError)
{
    return std::log2(std::abs(coarseError) / std::abs(fineError));
}

std::vector<Face> sphereInside(u32 levels)
{
    using Triangle = std::array<glm::dvec3, 3>;
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    const glm::dvec3 corners[] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                  {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    // Three corners make a face where all are neighbours: 2 apart.
    std::vector<Triangle> triangles;
    for (size_t i = 0; i < 12; ++i)
        for (size_t j = i + 1; j < 12; ++j)
            for (size_t k = j + 1; k < 12; ++k) {
                const glm::dvec3 a = corners[i], b = corners[j], c = corners[k];
                if (glm::distance(a, b) < 2.1 && glm::distance(b, c) < 2.1 && glm::distance(a, c) < 2.1)
                    triangles.push_back({glm::normalize(a), glm::normalize(b), glm::normalize(c)});
            }
    for (u32 level = 0; level < levels; ++level) {
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : triangles) {
            const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
            for (const Triangle& part : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
                finer.push_back(part);
        }
        triangles = std::move(finer);
    }
    std::vector<Face> faces;
    for (const auto& [a, b, c] : triangles) {
        Face face;
        face.ring = {a, b, c};
        if (glm::dot(glm::cross(b - a, c - a), a) > 0.0) std::reverse(face.ring.begin(), face.ring.end());
        face.group = u32(faces.size());
        faces.push_back(face);
    }
    return faces;
}

} // namespace helio::test
