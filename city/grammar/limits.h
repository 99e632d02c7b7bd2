// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/base/types.h"

namespace helio::cga {

// Bounds that keep any rule text from crashing, hanging or filling the memory. Real rule files stay far below all of
// them.

inline constexpr u32 kMaxSourceBytes = 1u << 20;
inline constexpr u32 kMaxImports = 64;        ///< files that a rule file imports, and these in turn
inline constexpr u32 kMaxImportDepth = 8;     ///< of imports within each other
inline constexpr u32 kMaxStyles = 32;         ///< of one file
inline constexpr u32 kMaxErrors = 20;         ///< mistakes that one run reports
inline constexpr u32 kMaxNesting = 100;       ///< of expressions, blocks and cases in the text
inline constexpr u32 kMaxDepth = 200;         ///< of rule and function calls within each other
inline constexpr u32 kMaxShapes = 1'000'000;  ///< of one building
inline constexpr u32 kMaxParts = 20'000;      ///< of one split
inline constexpr u64 kMaxSteps = 50'000'000;  ///< evaluated terms, operations and corners of one building
inline constexpr u32 kMaxNameBytes = 500;     ///< of one name, with its dots
inline constexpr u32 kMaxTextBytes = 65'536;  ///< of one string value
inline constexpr double kMaxCoordinate = 1e6; ///< m, from the building's first corner

} // namespace helio::cga
