// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "city/format/sections.h"

namespace helio {

/// Where the sections of a tile lie, to name the place of a fault.
struct SectionPlaces
{
    std::string file;
    std::array<u64, kSectionCount> offset{};
    std::array<bool, kSectionCount> packed{};

    /// "FILE: section NAME, byte N": N counts from the start of the file, or from the start of the unpacked section.
    std::string describe(SectionId id, u64 byteInSection) const;
};

/// Sections of a tile file in memory. The spans point into the bytes that were given or into `unpacked`.
struct LoadedTile
{
    TileView view;
    SectionPlaces places;
    u64 tableChecksum = 0;
    std::array<u64, kSectionCount> storedBytes{}; ///< in the file
    std::vector<std::unique_ptr<std::byte[]>> unpacked;
};

/// Reads the container of a tile: magic, version, size, table, checksums, codecs and whole records; everything comes
/// out in canonical form. Does not look at the records' values (validateTile does). `bytes` must be aligned to 16 and
/// outlive the result; `name` is used in errors.
Result<LoadedTile> readTile(std::span<const std::byte> bytes, const std::string& name);

} // namespace helio
