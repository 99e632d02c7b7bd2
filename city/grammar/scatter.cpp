// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/scatter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/base/check.h"
#include "city/model/triangulate.h"

namespace helio::cga {

namespace {

constexpr int kMaxTries = 100;

/// Standard normal (Box and Muller 1958).
double gaussian(Random& random)
{
    const double u = 1.0 - random.uniform(), v = random.uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v);
}

/// The point of a triangle that is nearest to p: inside by its barycentric coordinates, else on an edge.
glm::dvec3 nearestOf(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& normal, const glm::dvec3& p)
{
    const glm::dvec3 q = p - normal * glm::dot(normal, p - corners[0]);
    bool inside = true;
    glm::dvec3 best = corners[0];
    double least = INFINITY;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 a = corners[size_t(k)], by = corners[size_t(k + 1) % 3] - a;
        inside = inside && glm::dot(glm::cross(by, q - a), normal) >= 0.0;
        const double length2 = glm::dot(by, by);
        const double t = length2 > 0.0 ? std::clamp(glm::dot(q - a, by) / length2, 0.0, 1.0) : 0.0;
        const glm::dvec3 onEdge = a + by * t;
        if (const double d = glm::distance(onEdge, q); d < least) least = d, best = onEdge;
    }
    return inside ? q : best;
}

} // namespace

Scatter::Scatter(const Geometry& geometry, const glm::dvec3& size, ScatterDomain domain,
                 std::optional<ScatterPeak> peak)
    : size_(size), domain_(domain), peak_(peak), planar_(isPlanar(geometry))
{
    if (domain == ScatterDomain::Volume && !geometry.closed) domain_ = ScatterDomain::Surface;
    if (domain_ == ScatterDomain::Scope) return;
    for (const Face& face : geometry.faces) {
        Ring3 corners = face.polygon.outer;
        for (const Ring3& hole : face.polygon.holes) corners.insert(corners.end(), hole.begin(), hole.end());
        for (const auto& [a, b, c] : triangulate(face.polygon)) {
            Triangle triangle{{corners[a], corners[b], corners[c]}, {}, area_};
            const glm::dvec3 twice = glm::cross(corners[b] - corners[a], corners[c] - corners[a]);
            if (!(glm::length(twice) > 1e-12)) continue;
            triangle.normal = glm::normalize(twice);
            area_ += 0.5 * glm::length(twice);
            triangles_.push_back(triangle);
        }
    }
}

ScatterPoint Scatter::draw(Random& random, u64& work) const
{
    HELIO_CHECK(any(), area_);
    if (domain_ == ScatterDomain::Scope) return {inScope(random, work), {}};
    if (domain_ == ScatterDomain::Surface && !peak_) return onSurface(random, work);
    for (int k = 0; k < kMaxTries; ++k) {
        const glm::dvec3 p = inScope(random, work);
        if (domain_ == ScatterDomain::Volume) {
            if (encloses(p, work)) return {p, {}};
            continue;
        }
        const ScatterPoint found = nearest(p, work);
        const glm::dvec3 by = p - found.place;
        if (!planar_ || glm::length(by - found.normal * glm::dot(by, found.normal)) < 1e-9) return found;
    }
    const ScatterPoint found = onSurface(random, work);
    return {found.place, domain_ == ScatterDomain::Volume ? glm::dvec3(0.0) : found.normal};
}

/// Uniform by area (Turk, "Generating random points in triangles", Graphics Gems, 1990).
ScatterPoint Scatter::onSurface(Random& random, u64& work) const
{
    ++work;
    const double at = random.uniform() * area_;
    const auto after = std::upper_bound(triangles_.begin(), triangles_.end(), at,
                                        [](double value, const Triangle& t) { return value < t.areaBefore; });
    const Triangle& triangle = *(after - 1);
    const double s = std::sqrt(random.uniform()), t = random.uniform();
    const auto& [a, b, c] = triangle.corners;
    return {a * (1.0 - s) + b * (s * (1.0 - t)) + c * (s * t), triangle.normal};
}

ScatterPoint Scatter::nearest(const glm::dvec3& p, u64& work) const
{
    ScatterPoint best;
    double least = INFINITY;
    work += triangles_.size();
    for (const Triangle& triangle : triangles_) {
        const glm::dvec3 q = nearestOf(triangle.corners, triangle.normal, p);
        if (const double d = glm::distance(p, q); d < least) least = d, best = {q, triangle.normal};
    }
    return best;
}

glm::dvec3 Scatter::inScope(Random& random, u64& work) const
{
    glm::dvec3 p;
    for (int axis = 0; axis < 3; ++axis) {
        p[axis] = size_[axis] * random.uniform();
        if (!peak_ || !(size_[axis] > 0.0)) continue;
        double at = peak_->mean[axis];
        for (int k = 0; k < kMaxTries; ++k) {
            ++work;
            at = peak_->mean[axis] + peak_->deviation[axis] * gaussian(random);
            if (at >= 0.0 && at <= size_[axis]) break;
        }
        p[axis] = std::clamp(at, 0.0, size_[axis]);
    }
    return p;
}

/// By the solid angles of all faces seen from the point: 4 pi inside, 0 outside (van Oosterom and Strackee 1983).
bool Scatter::encloses(const glm::dvec3& p, u64& work) const
{
    work += triangles_.size();
    double angle = 0.0;
    for (const Triangle& triangle : triangles_) {
        const glm::dvec3 a = triangle.corners[0] - p, b = triangle.corners[1] - p, c = triangle.corners[2] - p;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                  la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return angle > 2.0 * M_PI;
}

} // namespace helio::cga
