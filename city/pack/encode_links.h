// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/format/sections.h"

namespace helio {

/// Payloads of the link sections in compact form; empty where the section has none: no links or moments, or values that
/// the form cannot hold (columns that do not rise, factors outside 0..1, moments of a link whose factor is 0).
struct CompactLinks
{
    std::vector<std::byte> columns, factors, moments;

    /// The payload of a section, null if it has none.
    std::vector<std::byte>* of(SectionId id);
};

/// The compact form of a tile's links (city/format/README.md, "Compact links"), about a quarter of their canonical
/// size. The sum of a row's factors is kept to a float's precision, each factor to half a step of a 12-bit square-root
/// code; of a moment over its factor 8 bits are kept, and what rounding takes is handed on to the next link of the row.
/// Deterministic. Decoding gives factors and moments again that a reader accepts.
CompactLinks encodeLinks(const TileView& tile);

} // namespace helio
