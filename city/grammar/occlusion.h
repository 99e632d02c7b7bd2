// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/grammar/geometry.h"
#include "city/model/footprint.h"

namespace helio::cga {

/// The footprint's first corner: the origin of the frame of its shapes. (0, 0) for an empty outline.
inline glm::dvec2 footprintCorner(const Footprint& footprint)
{
    return footprint.outline.outer.empty() ? glm::dvec2(0.0) : footprint.outline.outer[0];
}

/// Which parts of a building's walls the walls of its neighbours cover. Everything happens in the plane of a wall:
/// metres along the footprint's edge and metres above its base. Frame of the shapes: that of Scope, in which the
/// footprint's first corner is the origin.
class Occlusion
{
public:
    /// The footprint must outlive this.
    explicit Occlusion(const Footprint& footprint);

    /// False: no wall is covered, and all answers are false.
    bool any() const { return !walls_.empty(); }
    /// True if a covered part and one of the faces have more than 1 cm x 1 cm in common; for a level face (a lot), if
    /// one of its edges runs along a covered part for more than 1 cm. `edge` says on which edge of the footprint the
    /// shape stands; kNoIndex: any.
    bool touches(const Scope& scope, const Geometry& geometry, u32 edge) const;
    /// True if all faces lie on covered parts, with a tolerance of 1 cm.
    bool inside(const Scope& scope, const Geometry& geometry, u32 edge) const;
    /// True if the point lies on a covered part of the edge's wall, up to 5 cm before or behind it.
    bool covers(const glm::dvec3& point, u32 edge) const;
    /// Appends the parts of an open face that stands on an edge of the footprint to `open` and to `hidden`: cut upright
    /// and level, exactly at the borders of the covered parts; holes and reflex corners too. Contacts and gaps of up to
    /// 1 cm make no cut; a face elsewhere is open.
    void divide(const Scope& scope, const Face& face, u32 edge, Geometry& open, Geometry& hidden) const;
    /// Walls with a covered part: what one query costs per corner.
    size_t wallCount() const { return walls_.size(); }

private:
    /// A part of a wall that is covered from its foot up to a height.
    struct Strip
    {
        double begin = 0.0, end = 0.0, height = 0.0; // m
    };
    struct Wall
    {
        u32 edge = 0;
        glm::dvec3 corner{0.0}, along{0.0}, out{0.0}; // first corner, unit directions: along the edge, out of the wall
        std::vector<Strip> strips;                    // disjoint, from left to right
        std::vector<Strip> wide;                      // the same, grown by the tolerance
    };

    /// True if the polygon and the strip have more than 1 cm x 1 cm in common.
    static bool meets(const Polygon2& flat, const Strip& strip);
    /// True if all of the polygon lies on the strips grown by the tolerance.
    static bool within(const Polygon2& flat, const Wall& wall);
    static std::vector<Strip> skyline(const std::vector<CoveredSpan>& spans, double margin);
    /// The face in the plane of the wall (x along it, y up), if it lies there.
    static bool project(const Wall& wall, const Scope& scope, const Face& face, Polygon2& flat);

    std::vector<Wall> walls_; // those with a covered part, by edge
};

} // namespace helio::cga
