// SPDX-License-Identifier: Apache-2.0
#include "city/light/form_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

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

/// 2 pi times the factor of a polygon that lies wholly above the horizon.
double contourFactor(const glm::dvec3& point, const glm::dvec3& normal, const Contour& polygon)
{
    double sum = 0.0;
    for (u32 ring = 0, begin = 0; ring < polygon.ringEnd.size(); begin = polygon.ringEnd[ring++]) {
        glm::dvec3 a = polygon.corners[polygon.ringEnd[ring] - 1] - point;
        for (u32 k = begin; k < polygon.ringEnd[ring]; ++k) {
            const glm::dvec3 b = polygon.corners[k] - point;
            sum += edgeFactor(a, b, normal);
            a = b;
        }
    }
    return sum;
}

struct GaussRule
{
    u32 count;
    std::array<double, 6> x, w; // on [0, 1]
};
constexpr GaussRule kGauss2{2, {0.21132486540518712, 0.78867513459481288}, {0.5, 0.5}};
constexpr GaussRule kGauss4{4,
                            {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629},
                            {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693}};
constexpr GaussRule kGauss6{6,
                            {0.03376524289842398, 0.16939530676686775, 0.38069040695840155, 0.61930959304159845,
                             0.83060469323313225, 0.96623475710157602},
                            {0.08566224618958517, 0.18038078652406930, 0.23395696728634552, 0.23395696728634552,
                             0.18038078652406930, 0.08566224618958517}};

/// Integral over the smaller polygon of the point factor to the larger, m2. Every ring is a signed sum of quads and
/// triangles (a fan), so holes and concave corners need no cutting: the factor is smooth all over the hull at this
/// distance.
double integrateOverSmaller(const Contour& small, const glm::dvec3& normal, const Contour& large, const GaussRule& rule)
{
    double sum = 0.0;
    for (u32 ring = 0, begin = 0; ring < small.ringEnd.size(); begin = small.ringEnd[ring++]) {
        const glm::dvec3* p = small.corners.data() + begin;
        const u32 n = small.ringEnd[ring] - begin;
        for (u32 k = 1; k + 1 < n; k += 2) {
            // Bilinear map of a quad; the last cell of an odd fan is a triangle with its last corner doubled.
            const glm::dvec3 &a = p[0], &b = p[k], &c = p[k + 1], &d = p[std::min(k + 2, n - 1)];
            for (u32 i = 0; i < rule.count; ++i) {
                for (u32 j = 0; j < rule.count; ++j) {
                    const double u = rule.x[i], v = rule.x[j];
                    const glm::dvec3 du = (1.0 - v) * (b - a) + v * (c - d), dv = (1.0 - u) * (d - a) + u * (c - b);
                    const double jacobian = glm::dot(normal, glm::cross(du, dv));
                    const glm::dvec3 x = (1.0 - u) * ((1.0 - v) * a + v * d) + u * ((1.0 - v) * b + v * c);
                    sum += rule.w[i] * rule.w[j] * jacobian * contourFactor(x, normal, large);
                }
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
