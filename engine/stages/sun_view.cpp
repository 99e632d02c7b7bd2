// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/sun_view.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "city/base/check.h"

namespace helio {

namespace {

/// Slope of the texels against the scene's own axes, and the share of the height that the slope of y may cost.
constexpr double kSkew = 0.05;
constexpr double kSkewCost = 0.1;
constexpr double kTexelStep = 1.02;
constexpr u64 kMarginTexels = 3; // one at each side, and one for where the grid begins

double cross2(glm::dvec2 a, glm::dvec2 b)
{
    return a.x * b.y - a.y * b.x;
}

/// Convex hull, counter-clockwise, without collinear points (Andrew's monotone chain).
std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points)
{
    std::sort(points.begin(), points.end(),
              [](glm::dvec2 a, glm::dvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<glm::dvec2> hull;
    const auto extend = [&](size_t base, glm::dvec2 p) {
        while (hull.size() >= base + 2 && cross2(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const glm::dvec2 p : points) extend(0, p);
    const size_t lower = hull.size() - 1;
    for (size_t i = points.size() - 1; i-- > 0;) extend(lower, points[i]);
    hull.pop_back();
    return hull;
}

struct Rectangle
{
    glm::dvec2 axis{1.0, 0.0}; ///< unit, of the longer side
    glm::dvec2 lo{0.0}, hi{0.0};
};

glm::dvec2 turnLeft(glm::dvec2 a)
{
    return {-a.y, a.x};
}

Rectangle boundsAlong(const std::vector<glm::dvec2>& points, glm::dvec2 axis)
{
    Rectangle r{axis, glm::dvec2(std::numeric_limits<double>::max()),
                glm::dvec2(std::numeric_limits<double>::lowest())};
    for (const glm::dvec2 p : points) {
        const glm::dvec2 q(glm::dot(p, axis), glm::dot(p, turnLeft(axis)));
        r.lo = glm::min(r.lo, q);
        r.hi = glm::max(r.hi, q);
    }
    return r;
}

/// The rectangle of smallest area around points has a side along an edge of their hull (Freeman and Shapira 1975).
Rectangle smallestRectangle(const std::vector<glm::dvec2>& points)
{
    const std::vector<glm::dvec2> hull = convexHull(points);
    Rectangle best = boundsAlong(hull, {1.0, 0.0});
    const auto area = [](const Rectangle& r) { return (r.hi.x - r.lo.x) * (r.hi.y - r.lo.y); };
    for (size_t i = 0; i < hull.size(); ++i) {
        const glm::dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
        const double length = glm::length(edge);
        if (length < 1e-9) continue;
        const Rectangle r = boundsAlong(hull, edge / length);
        if (area(r) < area(best)) best = r;
    }
    if (best.hi.y - best.lo.y > best.hi.x - best.lo.x) best = boundsAlong(hull, turnLeft(best.axis));
    return best;
}

} // namespace

glm::mat4 SunView::clipFromWorld(u32 view) const
{
    const float x = float(view % gridX), y = float(view / gridX);
    glm::mat4 clipFromGrid(1.0f);
    clipFromGrid[0] = glm::vec4(2.0f, 2.0f * shear, 0.0f, 0.0f);
    clipFromGrid[1] = glm::vec4(0.0f, 2.0f, 0.0f, 0.0f);
    clipFromGrid[3] = glm::vec4(-2.0f * x - 1.0f, -2.0f * (y + shear * x) - 1.0f, 0.0f, 1.0f);
    return clipFromGrid * gridFromWorld;
}

SunView shiftedView(const SunView& view, u32 sample)
{
    // 1 / g and 1 / g^2, g^3 = g + 1.
    constexpr double kAlphaX = 0.7548776662466927, kAlphaY = 0.5698402909980532;
    const auto part = [&](double alpha) {
        const double x = 0.5 + sample * alpha;
        return x - std::floor(x) - 0.5;
    };
    SunView shifted = view;
    // A view is one unit wide and high; the margin of a texel around the scene holds the shift of half a one.
    shifted.gridFromWorld[3][0] += float(part(kAlphaX) / view.width);
    shifted.gridFromWorld[3][1] += float(part(kAlphaY) / view.height);
    return shifted;
}

SunView fitSunView(std::span<const Box> boxes, glm::dvec3 towardsSun, const SunViewOptions& options)
{
    HELIO_CHECK(!boxes.empty() && std::abs(glm::length(towardsSun) - 1.0) < 1e-6, boxes.size(),
                " boxes, |sun| = ", glm::length(towardsSun));
    const glm::dvec3 helper = std::abs(towardsSun.z) < 0.99 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(helper, towardsSun));
    const glm::dvec3 up = glm::cross(towardsSun, right);

    std::vector<glm::dvec2> points;
    points.reserve(8 * boxes.size());
    Box all = boxes.front();
    double nearest = std::numeric_limits<double>::max(), farthest = std::numeric_limits<double>::lowest();
    for (const Box& box : boxes) {
        all = {glm::min(all.lo, box.lo), glm::max(all.hi, box.hi)};
        for (u32 k = 0; k < 8; ++k) {
            const glm::dvec3 p((k & 1) ? box.hi.x : box.lo.x, (k & 2) ? box.hi.y : box.lo.y,
                               (k & 4) ? box.hi.z : box.lo.z);
            points.push_back({glm::dot(p, right), glm::dot(p, up)});
            nearest = std::min(nearest, -glm::dot(p, towardsSun));
            farthest = std::max(farthest, -glm::dot(p, towardsSun));
        }
    }
    const glm::dvec3 anchor = 0.5 * (glm::dvec3(all.lo) + glm::dvec3(all.hi));
    // Edges along the texels gain or lose a whole row of them at once; under a small angle the rounding averages out
    // over a patch. Two shears set the texels askew and keep their area: x by y, and y by x anew in each column of
    // views, so that a long scene stays narrow.
    const Rectangle r = smallestRectangle(points);
    const double height = std::max(r.hi.y - r.lo.y, 1e-3);
    const double width = std::max(r.hi.x - r.lo.x, 1e-3) + kSkew * height;

    // A texel is the one asked for times a power of kTexelStep, so that it seldom changes as the sun moves.
    SunView view;
    view.towardsSun = glm::vec3(towardsSun);
    double skew = 0.0; // of y by x
    const double least = std::sqrt(width * height / double(options.maxTexels)) / options.texel;
    double texel =
        options.texel * std::pow(kTexelStep, std::max(0.0, std::ceil(std::log(least) / std::log(kTexelStep))));
    for (;; texel *= kTexelStep) {
        const auto split = [&](double length, u32& cells, u32& size) {
            const u64 texels = u64(std::ceil(length / texel)) + kMarginTexels;
            cells = u32((texels + options.maxViewSize - 1) / options.maxViewSize);
            size = u32((texels + cells - 1) / cells);
        };
        split(width, view.gridX, view.width);
        const double viewWidth = view.width * texel;
        skew = std::min(kSkew, kSkewCost * height / viewWidth);
        split(height + skew * viewWidth, view.gridY, view.height);
        if (u64(view.viewCount()) * view.width * view.height <= options.maxTexels &&
            view.viewCount() <= options.maxViews)
            break;
    }
    view.texel = texel;
    view.shear = float(skew * view.width / view.height);
    const double margin = std::max({view.texel, 1e-3 * (farthest - nearest), 1e-3});
    view.depthRange = farthest - nearest + 2.0 * margin;

    const glm::dvec2 axisY = turnLeft(r.axis);
    const glm::dvec3 y = right * axisY.x + up * axisY.y;
    const glm::dvec3 x = right * r.axis.x + up * r.axis.y + kSkew * y;
    // The texels lie fast on the scene's centre: a rectangle that grows by one does not move them.
    const glm::dvec2 lo = glm::dvec2(r.lo.x + kSkew * r.lo.y, r.lo.y) - texel;
    const glm::dvec2 centre(glm::dot(x, anchor), glm::dot(y, anchor));
    const glm::dvec2 origin = centre + texel * glm::floor((lo - centre) / texel);
    const double scaleX = 1.0 / (view.texel * view.width), scaleY = 1.0 / (view.texel * view.height);
    const double scaleZ = 1.0 / view.depthRange;
    glm::dmat4 grid(1.0);
    for (int k = 0; k < 3; ++k) {
        grid[k][0] = x[k] * scaleX;
        grid[k][1] = y[k] * scaleY;
        grid[k][2] = -towardsSun[k] * scaleZ;
    }
    grid[3] = glm::dvec4(-origin.x * scaleX, -origin.y * scaleY, (margin - nearest) * scaleZ, 1.0);
    view.gridFromWorld = glm::mat4(grid);
    return view;
}

} // namespace helio
