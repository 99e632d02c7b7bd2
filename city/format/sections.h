// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "city/format/pack.h"

namespace helio {

/// Sections of a tile file, in the order in which they lie in it. The numbers are the ids on disk: never renumber.
enum class SectionId : u32
{
    Patches = 1,
    Nodes,
    NodeInfos,
    Children,
    OutlineRows,
    OutlineRings,
    OutlinePoints,
    OutlineRests,
    LinkRows,
    LinkColumns,
    LinkFactors,
    LinkMoments,
    SkyPatches,
    SkyRows,
    SkyColumns,
    SkyFactors,
    Vertices,
    Indices,
    Instances,
    Draws,
    NodeNames,
    SurfaceNames,
    BuildingIds,
    ChildSlopes,
    SkyOffsets,
    PatchErrors
};
inline constexpr u32 kSectionCount = u32(SectionId::PatchErrors);

/// Calls visit(id, name, span) for every section of a TileView (const or not), by rising id.
template <class View, class Visit> void forEachSection(View& tile, Visit&& visit)
{
    visit(SectionId::Patches, "patches", tile.patches);
    visit(SectionId::Nodes, "nodes", tile.nodes);
    visit(SectionId::NodeInfos, "node infos", tile.nodeInfos);
    visit(SectionId::Children, "children", tile.children);
    visit(SectionId::OutlineRows, "outline rows", tile.outlineRows);
    visit(SectionId::OutlineRings, "outline rings", tile.outlineRings);
    visit(SectionId::OutlinePoints, "outline points", tile.outlinePoints);
    visit(SectionId::OutlineRests, "outline rests", tile.outlineRests);
    visit(SectionId::LinkRows, "link rows", tile.linkRows);
    visit(SectionId::LinkColumns, "link columns", tile.linkColumns);
    visit(SectionId::LinkFactors, "link factors", tile.linkFactors);
    visit(SectionId::LinkMoments, "link moments", tile.linkMoments);
    visit(SectionId::SkyPatches, "sky patches", tile.skyPatches);
    visit(SectionId::SkyRows, "sky rows", tile.skyRows);
    visit(SectionId::SkyColumns, "sky columns", tile.skyColumns);
    visit(SectionId::SkyFactors, "sky factors", tile.skyFactors);
    visit(SectionId::Vertices, "vertices", tile.vertices);
    visit(SectionId::Indices, "indices", tile.indices);
    visit(SectionId::Instances, "instances", tile.instances);
    visit(SectionId::Draws, "draws", tile.draws);
    visit(SectionId::NodeNames, "node names", tile.nodeNames);
    visit(SectionId::SurfaceNames, "surface names", tile.surfaceNames);
    visit(SectionId::BuildingIds, "building ids", tile.buildingIds);
    visit(SectionId::ChildSlopes, "child slopes", tile.childSlopes);
    visit(SectionId::SkyOffsets, "sky offsets", tile.skyOffsets);
    visit(SectionId::PatchErrors, "patch errors", tile.patchErrors);
}

/// How a section's bytes are stored.
enum class SectionCodec : u32
{
    Raw = 0,
    Zstd = 1,
    Compact = 2,    ///< columns, factors and moments of the links alone: compact_links.h
    CompactZstd = 3 ///< the compact form as one zstd frame
};

/// True for the sections that have a compact form.
constexpr bool hasCompactForm(SectionId id)
{
    return id == SectionId::LinkColumns || id == SectionId::LinkFactors || id == SectionId::LinkMoments;
}

inline constexpr std::array<char, 8> kTileMagic{'H', 'E', 'L', 'I', 'O', 'T', 'I', 'L'};
inline constexpr u64 kSectionAlignment = 64;

/// First bytes of a tile file.
struct TileHeader
{
    std::array<char, 8> magic = kTileMagic;
    u32 version = kPackVersion;
    u32 sectionCount = kSectionCount;
    u64 fileBytes = 0;
    u64 tableChecksum = 0; ///< XXH3-64 of header and section table with this field zero
    std::array<u64, 4> zeros{};
};
static_assert(sizeof(TileHeader) == 64);

/// A line of the section table, which follows the header.
struct SectionEntry
{
    u32 id = 0;
    u32 codec = 0;
    u64 offset = 0;      ///< bytes from the start of the file, a multiple of 64
    u64 storedBytes = 0; ///< bytes in the file
    u64 rawBytes = 0;    ///< bytes in canonical form; equal to storedBytes for codec 0
    u64 checksum = 0;    ///< XXH3-64 of the stored bytes
    u64 zero = 0;
};
static_assert(sizeof(SectionEntry) == 48);

inline constexpr u64 kTableBytes = sizeof(TileHeader) + kSectionCount * sizeof(SectionEntry);

/// The next multiple of the section alignment.
constexpr u64 alignSection(u64 offset)
{
    return (offset + kSectionAlignment - 1) / kSectionAlignment * kSectionAlignment;
}

} // namespace helio
