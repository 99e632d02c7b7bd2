// SPDX-License-Identifier: Apache-2.0
#include "city/light/contour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace helio {
namespace {

/// d atan(s / d), continuous at d = 0.
double scaledAtan(double s, double d)
{
    return d > 0.0 ? d * std::atan2(s, d) : 0.0;
}

double logSafe(double x)
{
    return x > 0.0 ? std::log(x) : 0.0;
}

/// Second antiderivative in s of ln sqrt(s^2 + d^2).
double logKernelTwice(double s, double d)
{
    const double s2 = s * s, d2 = d * d;
    return 0.25 * (s2 - d2) * logSafe(s2 + d2) - 0.75 * s2 + s * scaledAtan(s, d);
}

/// First antiderivative in s of ln sqrt(s^2 + d^2).
double logKernelOnce(double s, double d)
{
    return 0.5 * s * logSafe(s * s + d * d) - s + scaledAtan(s, d);
}

struct Edge
{
    glm::dvec3 from, direction;
    double length;
};

void collectEdges(const Contour& contour, double scale, std::vector<Edge>& edges)
{
    edges.clear();
    for (u32 ring = 0, begin = 0; ring < contour.ringEnd.size(); begin = contour.ringEnd[ring++]) {
        const u32 end = contour.ringEnd[ring];
        for (u32 k = begin; k < end; ++k) {
            const glm::dvec3 a = contour.corners[k], b = contour.corners[k + 1 < end ? k + 1 : begin];
            const double length = glm::distance(a, b);
            if (length > 0.0) edges.push_back({a * scale, (b - a) / length, length * scale});
        }
    }
}

/// Integral of ln r along `line` from a point.
double alongEdge(const glm::dvec3& point, const Edge& line)
{
    const glm::dvec3 r = point - line.from;
    const double foot = glm::dot(r, line.direction);
    const double d = glm::length(glm::cross(r, line.direction));
    return logKernelOnce(line.length - foot, d) - logKernelOnce(-foot, d);
}

constexpr u32 kPoints = 8;
constexpr std::array<double, kPoints> kNode{0.01985507175123188, 0.10166676129318664, 0.23723379504183550,
                                            0.40828267875217510, 0.59171732124782490, 0.76276620495816450,
                                            0.89833323870681336, 0.98014492824876812};
constexpr std::array<double, kPoints> kWeight{0.05061426814518813, 0.11119051722668724, 0.15685332293894364,
                                              0.18134189168918100, 0.18134189168918100, 0.15685332293894364,
                                              0.11119051722668724, 0.05061426814518813};

/// Outer Gauss points from parameter t0 to t1 of `outer`, crowded towards t0 with the cube of the parameter when asked:
/// the integrand behaves there like t ln t.
double outerIntegral(const Edge& outer, const Edge& inner, double t0, double t1, bool graded)
{
    double sum = 0.0;
    for (u32 i = 0; i < kPoints; ++i) {
        const double x = kNode[i];
        const double t = t0 + (t1 - t0) * (graded ? x * x * x : x);
        const double jacobian = graded ? 3.0 * x * x : 1.0;
        sum += kWeight[i] * jacobian * alongEdge(outer.from + t * outer.direction, inner);
    }
    return sum * std::abs(t1 - t0);
}

/// Parameter on `a` nearest to the segment `b`, and the squared distance there.
double nearestApproach(const Edge& a, const Edge& b, double& distanceSquared)
{
    // Three rounds of alternating projection; exact for end points and crossing lines, near enough for grading.
    const glm::dvec3 r = a.from - b.from;
    const double k = glm::dot(a.direction, b.direction), det = 1.0 - k * k;
    double t = det > 1e-12 ? (k * glm::dot(r, b.direction) - glm::dot(r, a.direction)) / det : 0.0;
    t = std::clamp(t, 0.0, a.length);
    glm::dvec3 onB(0.0);
    for (u32 i = 0; i < 3; ++i) {
        const double s = std::clamp(glm::dot(a.from + t * a.direction - b.from, b.direction), 0.0, b.length);
        onB = b.from + s * b.direction;
        t = std::clamp(glm::dot(onB - a.from, a.direction), 0.0, a.length);
    }
    const glm::dvec3 d = a.from + t * a.direction - onB;
    distanceSquared = glm::dot(d, d);
    return t;
}

constexpr double kAlike = 0.8; // cosine between edges that may run beside each other

/// Double integral of ln r along two edges.
double edgePair(const Edge& p, const Edge& q, double cosine)
{
    if (1.0 - std::abs(cosine) < 1e-14) {
        const glm::dvec3 r = q.from - p.from;
        const double q0 = glm::dot(r, p.direction), q1 = q0 + (cosine > 0.0 ? q.length : -q.length);
        const double d = glm::length(glm::cross(r, p.direction));
        const double sum = logKernelTwice(p.length - q0, d) - logKernelTwice(-q0, d) -
                           logKernelTwice(p.length - q1, d) + logKernelTwice(-q1, d);
        return cosine > 0.0 ? sum : -sum;
    }
    const Edge &outer = p.length < q.length ? p : q, &inner = p.length < q.length ? q : p;
    double distanceSquared = 0.0;
    const double t = nearestApproach(outer, inner, distanceSquared);
    if (distanceSquared > outer.length * outer.length) return outerIntegral(outer, inner, 0.0, outer.length, false);
    if (std::abs(cosine) < kAlike)
        return outerIntegral(outer, inner, t, 0.0, true) + outerIntegral(outer, inner, t, outer.length, true);
    // Beside each other: the integrand also bends where the inner edge begins and ends.
    const auto footOf = [&](double along) {
        const double foot = glm::dot(inner.from + along * inner.direction - outer.from, outer.direction);
        return std::clamp(foot, 0.0, outer.length);
    };
    std::array<double, 5> cuts{0.0, t, footOf(0.0), footOf(inner.length), outer.length};
    std::sort(cuts.begin(), cuts.end());
    double sum = 0.0;
    for (u32 k = 0; k + 1 < cuts.size(); ++k) {
        const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
        if (cuts[k + 1] > cuts[k])
            sum += outerIntegral(outer, inner, cuts[k], middle, true) +
                   outerIntegral(outer, inner, cuts[k + 1], middle, true);
    }
    return sum;
}

} // namespace

bool cutToFront(const PlanarShape& shape, const PlanarShape& viewer, const glm::dvec3& origin, Contour& out)
{
    out.corners.clear();
    out.ringEnd.clear();
    const glm::dvec3 n = viewer.normal;
    const double offset = glm::dot(n, viewer.centroid - origin);
    // Corners within rounding of the plane count as in it: neighbours that share an edge are not to be cut.
    const double tolerance = 1e-9 * (shape.radius + viewer.radius + glm::distance(shape.centroid, viewer.centroid));
    const auto height = [&](const glm::dvec3& corner) {
        const double h = glm::dot(n, corner) - offset;
        return std::abs(h) <= tolerance ? 0.0 : h;
    };
    bool front = false;
    for (const Ring3& ring : shape.rings) {
        if (ring.size() < 3) continue;
        glm::dvec3 a = ring.back() - origin;
        double ha = height(a);
        for (const glm::dvec3& corner : ring) {
            const glm::dvec3 b = corner - origin;
            const double hb = height(b);
            if (ha * hb < 0.0) out.corners.push_back(a + ha / (ha - hb) * (b - a));
            if (hb >= 0.0) out.corners.push_back(b);
            front = front || hb > 0.0;
            a = b;
            ha = hb;
        }
        if (out.ringEnd.empty() ? !out.corners.empty() : out.corners.size() > out.ringEnd.back())
            out.ringEnd.push_back(u32(out.corners.size()));
    }
    return front;
}

double boxDistance(const Contour& a, const Contour& b)
{
    const auto box = [](const Contour& c, glm::dvec3& low, glm::dvec3& high) {
        low = high = c.corners[0];
        for (const glm::dvec3& p : c.corners) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    };
    glm::dvec3 aLow, aHigh, bLow, bHigh;
    box(a, aLow, aHigh);
    box(b, bLow, bHigh);
    return glm::length(glm::max(glm::max(aLow - bHigh, bLow - aHigh), glm::dvec3(0.0)));
}

double contourExchange(const Contour& a, const Contour& b)
{
    // Lengths are scaled to about one: ln r is then small and little cancels. Closed contours do not see the unit.
    glm::dvec3 low = a.corners[0], high = low;
    for (const Contour* c : {&a, &b}) {
        for (const glm::dvec3& p : c->corners) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    const double size = glm::distance(low, high);
    if (!(size > 0.0)) return 0.0;
    thread_local std::vector<Edge> aEdges, bEdges;
    collectEdges(a, 1.0 / size, aEdges);
    collectEdges(b, 1.0 / size, bEdges);
    double sum = 0.0;
    for (const Edge& p : aEdges) {
        for (const Edge& q : bEdges) {
            const double cosine = glm::dot(p.direction, q.direction);
            if (std::abs(cosine) > 1e-14) sum += cosine * edgePair(p, q, cosine);
        }
    }
    return sum * size * size / (2.0 * std::numbers::pi);
}

} // namespace helio
