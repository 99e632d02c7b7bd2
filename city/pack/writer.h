// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>

#include "city/format/index_text.h"
#include "city/pack/content.h"

namespace helio {

struct WriteOptions
{
    /// Packs each section that gets smaller by it with zstd (level 3). Such sections are unpacked into memory when the
    /// pack is opened, all others are mapped.
    bool zstd = false;
    /// Stores links in the compact form of city/format/README.md: about a quarter of the bytes, with an error well
    /// below that of the links (encodeLinks). Expanded when the pack is opened.
    bool compactLinks = false;
    /// Asked between chunks; once it says true, what was written is removed and the error says "interrupted".
    std::function<bool()> cancelled{};
};

/// The bytes of a tile file, in memory: for tests and tools; writePack does not need them at once.
struct EncodedTile
{
    std::vector<std::byte> bytes;
    TileEntry entry;
};
EncodedTile encodeTile(const TileView& tile, bool zstd = false, bool compactLinks = false);

/// Says why a reader would refuse the content: a fault of the program that made it, never of its input. `name` stands
/// for the pack. writePack asks it, too; a program that asks first can tell its own faults from those of the disk.
Status checkContent(const PackContent& content, const std::string& name);

/// Writes a pack folder: to a temporary folder beside the target, then renamed into its place. An existing pack is
/// replaced; any other folder or file at the target is an error, and so is content that a reader would refuse. Bytes
/// depend on the content and the options alone. Returns what the links take in it.
Result<LinkBytes> writePack(const PackContent& content, const std::filesystem::path& folder,
                            const WriteOptions& options = {});

/// Says in one line why a pack cannot be written to `folder` (its parent is missing, something else lies there): to be
/// asked before hours of work.
Status checkPackTarget(const std::filesystem::path& folder);

} // namespace helio
