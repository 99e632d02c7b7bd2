// SPDX-License-Identifier: Apache-2.0
#include "city/light/form_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "city/base/lanes.h"
#include "city/light/contour.h"

namespace helio {
namespace {

constexpr double kPi = std::numbers::pi;

/// Angle between two vectors over the length of their cross product: atan2(|c|, d) / |c|.
double angleOverSine(double sineSquared, double cosine)
{
    if (cosine > 0.0) {
        const double t2 = sineSquared / (cosine * cosine);
        // Short edges: the series of atan needs neither root nor atan2; seven terms leave 1e-10.
        if (t2 < 0.04) {
            const double series =
                1.0 - t2 * (1.0 / 3 - t2 * (1.0 / 5 - t2 * (1.0 / 7 - t2 * (1.0 / 9 - t2 * (1.0 / 11 - t2 / 13)))));
            return series / cosine;
        }
    }
    const double sine = std::sqrt(sineSquared);
    return sine > 0.0 ? std::atan2(sine, cosine) / sine : 0.0;
}

/// 2 pi times the form factor of one edge, seen from the origin.
double edgeFactor(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& normal)
{
    const glm::dvec3 c = glm::cross(b, a);
    return glm::dot(normal, c) * angleOverSine(glm::dot(c, c), glm::dot(a, b));
}

/// 2 pi times the signed factor of a ring relative to `point`, clipped to the horizon of the element.
double ringFactor(const glm::dvec3& point, const glm::dvec3& normal, std::span<const glm::dvec3> ring)
{
    const size_t n = ring.size();
    double sum = 0.0;
    // Walks the ring and cuts each edge at the horizon; the points where it leaves and comes back are joined in the
    // horizon.
    glm::dvec3 a = ring[n - 1] - point;
    double ha = glm::dot(normal, a);
    glm::dvec3 exit(0.0), firstEntry(0.0);
    bool outside = false, pendingEntry = false;
    for (size_t k = 0; k < n; ++k) {
        const glm::dvec3 b = ring[k] - point;
        const double hb = glm::dot(normal, b);
        if (ha >= 0.0 && hb >= 0.0) {
            sum += edgeFactor(a, b, normal);
        } else if (ha >= 0.0) {
            exit = a + ha / (ha - hb) * (b - a);
            outside = true;
            sum += edgeFactor(a, exit, normal);
        } else if (hb >= 0.0) {
            const glm::dvec3 entry = a + ha / (ha - hb) * (b - a);
            sum += edgeFactor(entry, b, normal);
            if (outside) {
                sum += edgeFactor(exit, entry, normal);
            } else {
                firstEntry = entry; // The walk began below the horizon: closed by the last exit.
                pendingEntry = true;
            }
            outside = false;
        }
        a = b;
        ha = hb;
    }
    if (pendingEntry && outside) sum += edgeFactor(exit, firstEntry, normal);
    return sum;
}

/// Gauss points of the unit square, four side by side.
struct GaussRule
{
    u32 count = 0; ///< of fours
    std::array<Double4, 9> u, v, weight;

    template <size_t N> GaussRule(const std::array<double, N>& x, const std::array<double, N>& w) : count(N * N / 4)
    {
        for (u32 k = 0; k < N * N; ++k) {
            u[k / 4][k % 4] = x[k / N];
            v[k / 4][k % 4] = x[k % N];
            weight[k / 4][k % 4] = w[k / N] * w[k % N];
        }
    }
};
const GaussRule kGauss2(std::array{0.21132486540518712, 0.78867513459481288}, std::array{0.5, 0.5});
const GaussRule kGauss4(std::array{0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629},
                        std::array{0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693});
const GaussRule kGauss6(std::array{0.03376524289842398, 0.16939530676686775, 0.38069040695840155, 0.61930959304159845,
                                   0.83060469323313225, 0.96623475710157602},
                        std::array{0.08566224618958517, 0.18038078652406930, 0.23395696728634552, 0.23395696728634552,
                                   0.18038078652406930, 0.08566224618958517});

/// Four points side by side.
struct Points
{
    Double4 x, y, z;
};

[[gnu::always_inline]] inline void subtract(Points& out, const glm::dvec3& p, const Points& q)
{
    out.x = p.x - q.x;
    out.y = p.y - q.y;
    out.z = p.z - q.z;
}

/// Adds 2 pi times the factor of one edge seen from the origin, as edgeFactor(), lane by lane. The angle comes by
/// halving its tangent three times, tan(t / 2) = tan t / (1 + sqrt(1 + tan^2 t)), and eleven terms of the series of
/// atan: 2e-10 of it at most, for angles up to pi.
[[gnu::always_inline]] inline void addEdge(Double4& sum, const Points& a, const Points& b, const glm::dvec3& normal)
{
    const Double4 cx = b.y * a.z - b.z * a.y, cy = b.z * a.x - b.x * a.z, cz = b.x * a.y - b.y * a.x;
    const Double4 cosine = a.x * b.x + a.y * b.y + a.z * b.z, sine2 = cx * cx + cy * cy + cz * cz;
    Double4 length = sine2 + cosine * cosine; // both scaled by |a| |b|
    takeRoot(length);
    const Double4 base = length + cosine, tiny = Double4{} + 1e-100; // its square is a number too
    const Double4 first = base > tiny ? base : tiny;                 // tan(angle / 2) = sine / first
    Double4 second = 1.0 + sine2 / (first * first);
    takeRoot(second);
    second += 1.0;
    Double4 product = first * second;
    Double4 third = 1.0 + sine2 / (product * product);
    takeRoot(third);
    product *= third + 1.0; // tan(angle / 8) = sine / product
    const Double4 w = sine2 / (product * product);
    Double4 series = Double4{} + 1.0 / 21;
    for (const double term :
         {1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1.0})
        series = term - w * series;
    sum += (normal.x * cx + normal.y * cy + normal.z * cz) * (8.0 * series / product);
}

/// Integral over the smaller polygon of the point factor to the larger, which lies wholly above its horizon, m2. Every
/// ring is a signed sum of quads and triangles (a fan), so holes and concave corners need no cutting: the factor is
/// smooth all over the hull at this distance.
HELIO_LANES double integrateOverSmaller(const Contour& small, const glm::dvec3& normal, const Contour& large,
                                        const GaussRule& rule)
{
    double sum = 0.0;
    for (u32 ring = 0, begin = 0; ring < small.ringEnd.size(); begin = small.ringEnd[ring++]) {
        const glm::dvec3* p = small.corners.data() + begin;
        const u32 n = small.ringEnd[ring] - begin;
        for (u32 k = 1; k + 1 < n; k += 2) {
            // Bilinear map of a quad; the last cell of an odd fan is a triangle with its last corner doubled.
            const glm::dvec3 &a = p[0], &b = p[k], &c = p[k + 1], &d = p[std::min(k + 2, n - 1)];
            // Planar, so the area that a point stands for changes linearly over it.
            const glm::dvec3 along = b - a, up = d - a, twist = (a - b) + (c - d);
            const double first = glm::dot(normal, glm::cross(along, up)),
                         alongU = glm::dot(normal, glm::cross(along, twist)),
                         alongV = glm::dot(normal, glm::cross(twist, up));
            for (u32 i = 0; i < rule.count; ++i) {
                const Double4 &u = rule.u[i], &v = rule.v[i], uv = u * v;
                const Points x{a.x + u * along.x + v * up.x + uv * twist.x, a.y + u * along.y + v * up.y + uv * twist.y,
                               a.z + u * along.z + v * up.z + uv * twist.z};
                Double4 total{};
                for (u32 other = 0, start = 0; other < large.ringEnd.size(); start = large.ringEnd[other++]) {
                    Points from, to;
                    subtract(from, large.corners[large.ringEnd[other] - 1], x);
                    for (u32 e = start; e < large.ringEnd[other]; ++e) {
                        subtract(to, large.corners[e], x);
                        addEdge(total, from, to, normal);
                        from = to;
                    }
                }
                total *= rule.weight[i] * (first + u * alongU + v * alongV);
                sum += (total[0] + total[1]) + (total[2] + total[3]);
            }
        }
    }
    return sum / (2.0 * kPi);
}

} // namespace

PlanarShape planarShape(std::span<const Ring3> rings)
{
    PlanarShape shape;
    shape.rings = rings;
    if (rings.empty() || rings[0].empty()) return shape;
    // Hole or second outer ring alike: the signed rings add up.
    glm::dvec3 vector(0.0), moment(0.0);
    const glm::dvec3 origin = rings[0][0];
    for (const Ring3& ring : rings) vector += vectorArea(ring);
    shape.area = glm::length(vector);
    if (shape.area > 0.0) shape.normal = vector / shape.area;
    for (const Ring3& ring : rings) {
        for (size_t i = 1; i + 1 < ring.size(); ++i) {
            const double twice = glm::dot(shape.normal, glm::cross(ring[i] - ring[0], ring[i + 1] - ring[0]));
            moment += twice / 6.0 * ((ring[0] - origin) + (ring[i] - origin) + (ring[i + 1] - origin));
        }
    }
    shape.centroid = shape.area > 0.0 ? origin + moment / shape.area : origin;
    for (const Ring3& ring : rings)
        for (const glm::dvec3& corner : ring)
            shape.radius = std::max(shape.radius, glm::distance(corner, shape.centroid));
    return shape;
}

double pointFactor(const glm::dvec3& point, const glm::dvec3& normal, std::span<const Ring3> rings)
{
    double sum = 0.0;
    for (const Ring3& ring : rings)
        if (ring.size() >= 3) sum += ringFactor(point, normal, ring);
    return std::clamp(sum / (2.0 * kPi), 0.0, 1.0);
}

double exchange(const PlanarShape& a, const PlanarShape& b)
{
    if (a.area <= 0.0 || b.area <= 0.0) return 0.0;
    // The smaller one goes first whatever the order of the arguments, so that the result is symmetric to the last bit.
    const bool swap =
        b.area < a.area || (b.area == a.area && std::lexicographical_compare(&b.centroid.x, &b.centroid.x + 3,
                                                                             &a.centroid.x, &a.centroid.x + 3));
    const PlanarShape &small = swap ? b : a, &large = swap ? a : b;
    thread_local Contour s, l;
    const glm::dvec3 origin = small.centroid; // Pair-relative: world coordinates leave the sums here.
    if (!cutToFront(small, large, origin, s) || !cutToFront(large, small, origin, l)) return 0.0;

    const double gap = boxDistance(s, l);
    double result = 0.0;
    if (gap > 4.0 * small.radius) {
        result = integrateOverSmaller(s, small.normal, l, kGauss2);
    } else if (gap > 1.5 * small.radius) {
        result = integrateOverSmaller(s, small.normal, l, kGauss4);
    } else if (gap > 0.7 * small.radius && s.corners.size() <= 8) {
        result = integrateOverSmaller(s, small.normal, l, kGauss6);
    } else {
        result = contourExchange(s, l);
    }
    return std::clamp(result, 0.0, small.area);
}

} // namespace helio
