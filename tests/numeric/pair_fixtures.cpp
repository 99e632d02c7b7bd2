// SPDX-License-Identifier: Apache-2.0
#include "tests/numeric/pair_fixtures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>

#include "city/model/triangulate.h"

namespace helio::test {
namespace {

using Real = long double;
constexpr Real kPi = std::numbers::pi_v<Real>;

/// The sum over all corners of both rectangles, signed; x, y of the first, u, v of the second.
double sixteenTerms(double x0, double x1, double y0, double y1, double u0, double u1, double v0, double v1,
                    const std::function<Real(Real x, Real y, Real u, Real v)>& term)
{
    const Real xs[] = {x0, x1}, ys[] = {y0, y1}, us[] = {u0, u1}, vs[] = {v0, v1};
    Real sum = 0;
    for (u32 k = 0; k < 16; ++k) {
        const u32 i = k & 1, j = k >> 1 & 1, m = k >> 2 & 1, n = k >> 3 & 1;
        const Real value = term(xs[i], ys[j], us[m], vs[n]);
        sum += (i + j + m + n) % 2 == 0 ? value : -value;
    }
    return double(sum / (2 * kPi) / ((Real(x1) - x0) * (Real(y1) - y0)));
}

} // namespace

PairRings opposed(double x0, double x1, double y0, double y1, double z, double u0, double u1, double v0, double v1)
{
    return {{{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}, {{u0, v0, z}, {u0, v1, z}, {u1, v1, z}, {u1, v0, z}}};
}

PairRings perpendicular(double x0, double x1, double y0, double y1, double z0, double z1, double v0, double v1)
{
    return {{{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}, {{0, v0, z0}, {0, v1, z0}, {0, v1, z1}, {0, v0, z1}}};
}

PairRings hinged(double w1, double w2, double l, double angle)
{
    // In extended precision: at 179.9 degrees the factor goes with the square of a small sine.
    const Real phi = Real(angle) * kPi / 180;
    const double c = double(std::cos(phi)), s = double(std::sin(phi));
    return {{{0, 0, 0}, {w1, 0, 0}, {w1, l, 0}, {0, l, 0}},
            {{0, 0, 0}, {0, l, 0}, {w2 * c, l, w2 * s}, {w2 * c, 0, w2 * s}}};
}

double closedOpposed(double x0, double x1, double y0, double y1, double z, double u0, double u1, double v0, double v1)
{
    return sixteenTerms(x0, x1, y0, y1, u0, u1, v0, v1, [z](Real x, Real y, Real xi, Real eta) {
        const Real u = x - xi, v = y - eta, zz = Real(z) * z;
        const Real p = std::sqrt(u * u + zz), q = std::sqrt(v * v + zz);
        return v * p * std::atan(v / p) + u * q * std::atan(u / q) - zz / 2 * std::log(u * u + v * v + zz);
    });
}

double closedPerpendicular(double x0, double x1, double y0, double y1, double z0, double z1, double v0, double v1)
{
    return sixteenTerms(x0, x1, y0, y1, z0, z1, v0, v1, [](Real x, Real y, Real xi, Real eta) {
        const Real v = y - eta, r2 = x * x + xi * xi, r = std::sqrt(r2);
        const Real angle = r > 0 ? v * r * std::atan(v / r) : Real(0);
        return r2 + v * v > 0 ? angle - (r2 - v * v) / 4 * std::log(r2 + v * v) : Real(0);
    });
}

double pointLineMean()
{
    // From the point at y of the edge the square is two rectangles with a corner above the point, a = 1, b = y, 1 - y.
    const auto corner = [](double a, double b) {
        const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
        return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * std::numbers::pi);
    };
    double sum = 0.0;
    constexpr u32 kSteps = 20000; // midpoints: 1e-10
    for (u32 k = 0; k < kSteps; ++k) {
        const double y = (k + 0.5) / kSteps;
        sum += corner(1.0, y) + corner(1.0, 1.0 - y);
    }
    return sum / kSteps;
}

std::vector<Ring3> boxInside(const glm::dvec3& s)
{
    const auto p = [&](int i, int j, int k) { return glm::dvec3(i * s.x, j * s.y, k * s.z); };
    return {{p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0)}, {p(0, 0, 1), p(0, 1, 1), p(1, 1, 1), p(1, 0, 1)},
            {p(0, 0, 0), p(0, 1, 0), p(0, 1, 1), p(0, 0, 1)}, {p(1, 0, 0), p(1, 0, 1), p(1, 1, 1), p(1, 1, 0)},
            {p(0, 0, 0), p(0, 0, 1), p(1, 0, 1), p(1, 0, 0)}, {p(0, 1, 0), p(1, 1, 0), p(1, 1, 1), p(0, 1, 1)}};
}

Ring3 moved(const Ring3& ring, const glm::dvec3& offset)
{
    Ring3 out = ring;
    for (glm::dvec3& corner : out) corner += offset;
    return out;
}

std::vector<Ring3> turnedAll(const std::vector<Ring3>& rings, Random& dice)
{
    const glm::dvec3 w = glm::normalize(
        glm::dvec3(dice.uniform() - 0.5, dice.uniform() - 0.5, dice.uniform() + 0.1)); // any direction will do
    const PlaneFrame frame = planeFrame(w);
    const double turn = 7.0 * dice.uniform(), c = std::cos(turn), s = std::sin(turn);
    const glm::dmat3 rotation(c * frame.u + s * frame.v, c * frame.v - s * frame.u, w);
    std::vector<Ring3> out = rings;
    for (Ring3& ring : out)
        for (glm::dvec3& corner : ring) corner = rotation * corner;
    return out;
}

std::vector<Ring3> trianglesOf(const Ring3& ring)
{
    std::vector<Ring3> out;
    for (const auto& [i, j, k] : triangulate(Polygon3{ring, {}})) out.push_back({ring[i], ring[j], ring[k]});
    return out;
}

Ring3 randomRing(Random& dice)
{
    const u32 n = 3 + u32(7 * dice.uniform());
    Ring3 ring;
    for (u32 k = 0; k < n; ++k) {
        const double angle = (k + 0.8 * dice.uniform()) * 2.0 * std::numbers::pi / n, r = 0.15 + dice.uniform();
        ring.push_back({r * std::cos(angle), r * std::sin(angle), 0.0});
    }
    return turnedAll({ring}, dice)[0];
}

PairRings randomPair(Random& dice)
{
    PairRings pair{randomRing(dice), randomRing(dice)};
    const double scale = std::pow(10.0, 3.0 * dice.uniform() - 1.5),
                 distance = std::pow(10.0, 2.5 * dice.uniform() - 1.0);
    const glm::dvec3 away =
        distance * glm::normalize(glm::dvec3(dice.uniform() - .5, dice.uniform() - .5, dice.uniform() - .5));
    for (glm::dvec3& corner : pair.b) corner = scale * corner + away;
    // Face to face, else most pairs would see nothing.
    if (glm::dot(vectorArea(pair.a), away) < 0.0) std::reverse(pair.a.begin(), pair.a.end());
    if (glm::dot(vectorArea(pair.b), away) > 0.0) std::reverse(pair.b.begin(), pair.b.end());
    return pair;
}

} // namespace helio::test
