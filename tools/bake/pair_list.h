// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "city/base/result.h"
#include "city/model/polygon.h"

namespace helio {

/// Two polygons whose form factors are asked for, and what stands between them. Metres; a and b counter-clockwise seen
/// from the lit side.
struct PolygonPair
{
    std::string id;
    Ring3 a, b;
    std::vector<Ring3> occluders;
};

/// Most corners of a polygon and most occluders of a pair: the work grows with their square.
constexpr size_t kMaxPairCorners = 512, kMaxPairOccluders = 256;

/// Reads a JSON list of {"id": text, "a": [[x, y, z], ...], "b": [...], "occluders": [[[x, y, z], ...], ...]};
/// occluders may be missing. Polygons need three corners or more, an area, a plane (within 1e-6 of their size and the
/// rounding of their coordinates) and edges that do not cross; a last corner equal to the first is dropped. Ids are
/// unique, without comma, quote or line end (they go into a CSV). Errors: file, pair, polygon, what is wrong.
Result<std::vector<PolygonPair>> readPolygonPairs(const std::filesystem::path& path);

} // namespace helio
