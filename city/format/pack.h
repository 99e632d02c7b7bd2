// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"
#include "shaders/shared/records.h"

namespace helio {

inline constexpr u32 kPackVersion = 3;

/// What the index of a pack says. Little endian JSON text with a checksum line; see city/format/README.md.
struct PackIndex
{
    u32 version = kPackVersion;
    std::string crs;
    glm::dvec3 origin{0.0}; ///< m, of the tile frame
    double latitudeDeg = 0.0, longitudeDeg = 0.0;
    double northDeg = 0.0;             ///< clockwise angle from true north to grid north (+y)
    std::string source, rules, method; ///< input's name without its folder, rule file's name, link method
    u64 inputHash = 0, rulesHash = 0, seed = 0;
    std::string options;                        ///< bake options that change the result, as JSON text
    u32 sourceFaceCount = 0;                    ///< faces of the OBJ, 0 for cities
    glm::vec3 boundsMin{0.0f}, boundsMax{0.0f}; ///< m, of everything drawn
};

/// Sections of a tile, as spans of the mapped file (or of PackContent's vectors).
struct TileView
{
    std::span<const gpu::PatchRecord> patches;
    std::span<const gpu::NodeRecord> nodes; ///< patches first, then inner nodes by rising height
    std::span<const gpu::NodeInfoRecord> nodeInfos;
    std::span<const u32> children;
    std::span<const u32> outlineRows;  ///< nodeCount + 1 offsets into outlineRings
    std::span<const u32> outlineRings; ///< per ring: first point << 1 | isHole; plus one sentinel (pointCount << 1)
    std::span<const glm::vec3> outlinePoints; ///< m, tile frame
    std::span<const glm::vec3> outlineRests; ///< m, what rounding took from outlinePoints: their sum in double is exact
    std::span<const u32> linkRows;           ///< nodeCount + 1 offsets, one row a receiver
    std::span<const u32> linkColumns;        ///< sender node
    std::span<const float> linkFactors;      ///< F(receiver to sender) x visibility
    std::span<const float> linkMoments;      ///< empty (constant senders), or two a link
    std::span<const gpu::SkyPatchRecord> skyPatches;
    std::span<const u32> skyRows;      ///< patchCount + 1 offsets
    std::span<const u32> skyColumns;   ///< sky patch
    std::span<const float> skyFactors; ///< fraction of the patch's cosine-weighted hemisphere that sees it
    std::span<const gpu::VertexRecord> vertices;
    std::span<const u32> indices;
    std::span<const gpu::InstanceRecord> instances; ///< instance 0 is the static mesh
    std::span<const gpu::DrawRecord> draws;
    std::span<const char> nodeNames; ///< '\n'-terminated names
    std::span<const char> surfaceNames;
    std::span<const char> buildingIds;
    /// One an entry of `children` where there are link moments, else empty: constant senders.
    std::span<const gpu::ChildSlopeRecord> childSlopes;
    /// One a sky link, or empty: the middle of what the patch sees of the sky patch, two snorm16 (SkyTable::offset).
    std::span<const u32> skyOffsets;
    /// One a patch, or empty: the error of its E_indirect that the bake expects, rms, as a share of the mean E_indirect
    /// of all patches (PredictedError::ofPatch).
    std::span<const float> patchErrors;
};

/// What the links take in the file, bytes; rows not counted.
struct LinkBytes
{
    u64 columns = 0, factors = 0, moments = 0;
};

/// Number of sky patches that are parts of the sky: all but the ground beyond the scene, which comes last if at all.
u32 skyCellCount(std::span<const gpu::SkyPatchRecord> skyPatches);
/// Reflectance of the ground beyond the scene; 0 = there is none.
glm::vec4 farGroundOf(const TileView& tile);

/// A pack opened for reading. Every offset, count and index in it has been checked against its bounds.
class Pack
{
public:
    /// Opens and checks a pack folder. Errors name file, section and offset: not a pack, other version, truncated, bad
    /// checksum, index out of range.
    static Result<Pack> open(const std::filesystem::path& folder);

    const PackIndex& index() const { return index_; }
    const TileView& tile() const { return tile_; }
    const LinkBytes& linkBytes() const { return linkBytes_; }
    u32 patchCount() const { return u32(tile_.patches.size()); }
    u32 nodeCount() const { return u32(tile_.nodes.size()); }

private:
    PackIndex index_;
    TileView tile_;
    LinkBytes linkBytes_;
    std::shared_ptr<const void> bytes_; ///< keeps the mapping (or the decompressed sections) alive
};

/// Splits a names section.
std::vector<std::string> splitNames(std::span<const char> section);

} // namespace helio
