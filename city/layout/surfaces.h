// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "city/base/result.h"
#include "city/model/shape_tree.h"

namespace helio {

/// Reads a scene of planar polygons: face k of the OBJ file (z up, metres, corners counter-clockwise from the lit side)
/// has row k of the CSV file, whose columns go by header name: kind, building, facade, floor, bay, rho_r, rho_g, rho_b
/// [, rho_solar], emit_r, emit_g, emit_b [, emit_solar]; others are ignored. A missing solar channel is solarFromRgb.
/// The tree is Root "Building" (or "Ground" for building -1) > Group "Facade" > "Floor" > "Bay" > one leaf a face,
/// named by its kind, groups in order of first appearance; Shape::sourceFace is k. Concave polygons are fine; v, v/vt,
/// v//vn and negative indices too; every other kind of OBJ line is ignored.
///
/// Errors (one line; file and line): unreadable file, bad number or index, fewer than three corners, area zero, off its
/// plane by more than 1e-3 of its size, missing column, reflectance outside 0..1, negative emission, counts that
/// differ, no face.
Result<ShapeTree> readSurfaces(const std::filesystem::path& obj, const std::filesystem::path& csv);

} // namespace helio
