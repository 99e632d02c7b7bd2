// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/layout/import_notes.h"
#include "city/model/footprint.h"

// Footprints that lie on each other. Internal to city/layout.
namespace helio {

/// Two polygons that have an area in common.
struct OverlappingPair
{
    u32 first, second; ///< first < second
    double area;       ///< m2
};

/// All pairs that share more than `least` m2, by first and then second; coordinates within kGridLimit. Polygons that
/// cross themselves count by non-zero filling.
std::vector<OverlappingPair> overlappingPairs(std::span<const Polygon2> polygons, double least = 0.5);

/// Per polygon, the index of the first one whose corners round to the same points of a 1 cm grid (in any order of
/// travel).
std::vector<u32> firstEqual(std::span<const Polygon2> polygons);

/// True for a true property `part` or `building:part` (OSM Simple 3D Buildings).
bool saysPart(const std::map<std::string, Attribute>& attributes);

/// Where parts of a building (`isPart`, one a footprint) lie in an outline that is no part, they replace it: an outline
/// of which they cover 90 % is dropped, from another one they are cut. A part without a height takes the outline's.
/// Heights may still be 0 = not known.
void replaceOutlinesByParts(std::vector<Footprint>& footprints, const std::vector<bool>& isPart, ImportNotes& notes);

/// Drops every footprint whose polygon equals an earlier one's; the earlier one takes the larger height.
void dropEqualFootprints(std::vector<Footprint>& footprints, ImportNotes& notes);

/// Where two footprints overlap by more than 0.5 m2, cuts the common part from the lower one (from the later one if
/// equally high). What remains is cleaned; pieces below 1 m2 vanish. Needs heights.
void cutOverlaps(std::vector<Footprint>& footprints, ImportNotes& notes);

/// Makes one footprint of each polygon: copies of `whole`, ids "x", "x.2", ... Given faces go to the piece that they
/// stand on; a piece that none stands on, where there are any, is left out, with a note.
std::vector<Footprint> splitFootprint(const Footprint& whole, std::vector<Polygon2> pieces, ImportNotes& notes);

/// Gives every footprint an id of its own, in order: one whose id an earlier footprint has becomes "id.2", "id.3", ...:
/// the next that no footprint has. One note for all.
void makeIdsUnique(std::vector<Footprint>& footprints, ImportNotes& notes);

} // namespace helio
