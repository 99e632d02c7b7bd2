// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/model/polygon.h"

// Exact tests of polygons as they come. Internal to city/layout.
namespace helio {

/// Sign of the area of the triangle a, b, c: 1 if it runs counter-clockwise, -1 clockwise, 0 if the points lie on a
/// line. Exact for finite coordinates below 1e100 in size: the six products of the determinant are summed without
/// rounding (Shewchuk, "Adaptive precision floating-point arithmetic", 1997, two-product and expansion sum).
int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

/// What polygonFindings saw.
struct PolygonFindings
{
    const char* defect = nullptr; ///< nullptr: valid
    u32 meetings = 0;             ///< places where edges meet that do not follow each other, up to one above the limit
};

/// What the Simple Features rules (OGC 06-103r4, 6.1.11) find wrong with a polygon, in the words that GEOS uses:
/// "Too few points in geometry component", "Self-intersection" (edges cross or overlap), "Ring Self-intersection" (a
/// ring meets itself in a point), "Hole lies outside shell", "Holes are nested" and "Interior is disconnected". The
/// direction of rings and repeated corners do not matter. Rings are given without their closing corner. The search ends
/// when edges meet in more than maxMeetings places.
PolygonFindings polygonFindings(const Polygon2& polygon, u32 maxMeetings = 10000);

} // namespace helio
