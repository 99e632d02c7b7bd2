// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
#include <vector>

#include "city/base/result.h"
#include "city/model/polygon.h"

// The faces of an OBJ file. Internal to city/layout.
namespace helio {

struct ObjFace
{
    Ring3 ring;   ///< m
    u32 line = 0; ///< where it stands in the file, from 1
};

/// Reads vertices and faces (v, v/vt, v//vn, v/vt/vn; indices from 1 or, negative, from the last vertex); other lines
/// are ignored. Every face has at least three corners, an area and lies in a plane within 1e-3 of its size. `name`
/// stands for the file in messages. Errors: bad number or index, and faces that break these rules, with their line.
Result<std::vector<ObjFace>> readObjFaces(std::string_view text, std::string_view name);

/// Splits off the first line of `text`, without its end ("\n" or "\r\n").
std::string_view takeLine(std::string_view& text);
/// Splits off the first word of `text`; empty at the end.
std::string_view takeWord(std::string_view& text);
/// The whole of `text` as a finite number.
bool parseNumber(std::string_view text, double& number);
/// The whole of `text` as a whole number.
bool parseInteger(std::string_view text, i64& number);

} // namespace helio
