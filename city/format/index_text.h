// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "city/format/pack.h"

namespace helio {

/// How an index file of any version starts; the version follows.
inline constexpr std::string_view kIndexMagic = "heliopolis-pack ";
inline constexpr const char* kIndexFile = "index";
inline constexpr const char* kTileFile = "tile-0000";

/// What the index says of a tile file, so that an index and a tile of two bakes are not taken together.
struct TileEntry
{
    u64 bytes = 0;
    u64 tableChecksum = 0; ///< TileHeader::tableChecksum
    friend bool operator==(const TileEntry&, const TileEntry&) = default;
};

struct IndexText
{
    PackIndex index;
    TileEntry tile;
};

/// The index file: a line "heliopolis-pack VERSION", a JSON object, a line "xxh3 CHECKSUM" over everything before it.
/// `index.options` must be JSON text or empty.
std::string encodeIndex(const PackIndex& index, const TileEntry& tile);

/// Reads an index file's text; `name` is used in errors, which name the byte or the member at fault.
Result<IndexText> decodeIndex(std::string_view text, const std::string& name);

} // namespace helio
