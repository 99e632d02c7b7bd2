// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/layout/import_notes.h"
#include "city/model/polygon.h"

namespace helio {

/// What cleanPolygon had to do.
struct RepairReport
{
    u32 repeatedCorners = 0; ///< corners within 1 mm of the one before
    u32 spikes = 0;          ///< corners at which the outline runs back onto itself
    u32 straightCorners = 0; ///< corners within 0.01 rad and 2 cm of a straight line
    u32 reversedRings = 0;   ///< outer rings that ran clockwise, holes that ran counter-clockwise
    u32 shortEdges = 0;      ///< edges below 0.1 m
    u32 lostHoles = 0;       ///< holes without area
    u32 smallPieces = 0;     ///< pieces below 1 m2, or below 0.1 m of mean width (2 area / perimeter), dropped
    bool crossing = false;   ///< the rings crossed or touched themselves or each other
};

/// True if no two edges of the polygon cross or touch but at their common corner, every hole lies inside the outer ring
/// and none in another.
bool isSimple(const Polygon2& polygon);

/// Makes simple polygons of an arbitrary one (coordinates within kGridLimit), step by step: repeats, spikes and
/// straight corners are dropped (but for the ends of the first edge, which means something to rules), rings oriented
/// (outer counter-clockwise), crossing rings united by non-zero filling on a grid of 0.1 mm, edges below 0.1 m
/// collapsed, small pieces and slivers dropped. A clean polygon keeps its coordinates to the last bit.
std::vector<Polygon2> cleanPolygon(Polygon2 polygon, RepairReport& report);

/// True if a corner lies on the line between its neighbours, within 0.01 rad and 2 cm.
bool isStraightCorner(const glm::dvec2& before, const glm::dvec2& corner, const glm::dvec2& after);

/// The repairs, each with its count's name ("repaired.spikes") and its words ("removed 1 spike corner"). Reversed rings
/// and straight corners are ordinary and not among them.
std::vector<ImportNotes::Item> repairItems(const RepairReport& report);

} // namespace helio
