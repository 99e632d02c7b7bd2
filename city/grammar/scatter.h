// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "city/base/hash.h"
#include "city/grammar/geometry.h"

namespace helio::cga {

/// Where scattered points lie.
enum class ScatterDomain : u32
{
    Surface,
    Volume,
    Scope
};

/// A normal distribution along each axis of the scope, m.
struct ScatterPeak
{
    glm::dvec3 mean{0.0}, deviation{0.0}; ///< deviation >= 0
};

struct ScatterPoint
{
    glm::dvec3 place{0.0}, normal{0.0}; ///< scope coordinates; unit normal of the face it lies on, else zero
};

/// Draws points on the faces of a geometry, in a closed one, or in the scope's box [0, size].
class Scatter
{
public:
    /// Without a peak the points are uniform: by area, by volume. The volume of a geometry that is not closed is its
    /// surface.
    Scatter(const Geometry& geometry, const glm::dvec3& size, ScatterDomain domain, std::optional<ScatterPeak> peak);

    /// False: there is nothing to draw from.
    bool any() const { return domain_ == ScatterDomain::Scope || area_ > 0.0; }
    /// One point. Programmer error: !any(). `work` counts draws and triangles that were looked at. What a peak puts
    /// outside the scope, a plane face or a solid is drawn again, up to 100 times; on other surfaces it goes to the
    /// nearest place. A point that finds no place by then is uniform on the surface.
    ScatterPoint draw(Random& random, u64& work) const;

private:
    struct Triangle
    {
        std::array<glm::dvec3, 3> corners;
        glm::dvec3 normal;
        double areaBefore = 0.0; ///< m2 of all triangles before it
    };

    ScatterPoint onSurface(Random& random, u64& work) const;
    ScatterPoint nearest(const glm::dvec3& p, u64& work) const;
    glm::dvec3 inScope(Random& random, u64& work) const;
    bool encloses(const glm::dvec3& p, u64& work) const;

    std::vector<Triangle> triangles_;
    double area_ = 0.0; ///< m2
    glm::dvec3 size_;
    ScatterDomain domain_;
    std::optional<ScatterPeak> peak_;
    bool planar_ = false;
};

} // namespace helio::cga
