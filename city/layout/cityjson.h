// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "city/layout/geojson_features.h"

// Buildings of a CityJSON file (1.0, 1.1, 2.0) or a CityJSONSeq text. Internal to city/layout.
namespace helio {

/// True if the text is an object with "type": "CityJSON..." or with "CityObjects" at its top level, so that
/// readCityJson is the one to read it. Looks at brackets and names alone: whether it is JSON stays open.
bool isCityJson(std::string_view text);

/// Reads the buildings as features, before any repair. Id: the object's; one feature, in the order of their ids (of a
/// sequence: line by line), for each Building and BuildingPart with geometry of its own (a part inherits the attributes
/// of its building; a building whose own geometry is flat gives way to its parts). Polygons: the ground surfaces
/// united, seen from above; without any, the outline of the roof. Height: highest point less the lowest of the ground;
/// for flat geometry the attribute measuredHeight or height. The geometry is that of the highest LoD below 3, else the
/// lowest above. `lod2`: features of LoD 2 and up also get the walls and roofs as faces (planar within 1 cm, from
/// outside, z above the building's ground); what is modelled below LoD 2 stays a footprint with a height.
///
/// Bad objects and surfaces are skipped with a note that names the object. Errors (one line, with line and byte where
/// there is one): not JSON, no CityJSON, a version other than 1.x and 2.x, a CRS in degrees, a bad transform.
Result<GeoFile> readCityJson(std::string_view text, std::string_view name, bool lod2);

} // namespace helio
