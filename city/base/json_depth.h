// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

#include "city/base/types.h"

namespace helio {

/// Deepest nesting of arrays and objects that a reader of JSON accepts. GeoJSON needs 9; what works through a document
/// by recursion is safe to this depth.
constexpr u32 kMaxJsonDepth = 64;

/// The byte of the first bracket that opens more than `limit` levels, none if the text stays within. To be asked before
/// the text is parsed; says nothing of whether it is JSON.
std::optional<size_t> findDeepJson(std::string_view text, u32 limit = kMaxJsonDepth);

} // namespace helio
