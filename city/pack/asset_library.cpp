// SPDX-License-Identifier: Apache-2.0
#include "city/pack/asset_library.h"

#include "city/base/file.h"
#include "city/base/hash.h"
#include "city/pack/embedded_files.h"

namespace helio {

Result<const AssetMesh*> AssetLibrary::find(const std::string& nameInRule)
{
    if (const auto known = entries_.find(nameInRule); known != entries_.end()) return &known->second.mesh;

    std::string text;
    std::span<const std::byte> bytes;
    std::string file = concat("built-in ", nameInRule);
    const Result<std::filesystem::path> path = findAsset(nameInRule, folders_);
    if (path) {
        file = path->string();
        Result<std::string> read = readTextFile(*path);
        if (!read) return read.error();
        text = std::move(*read);
        bytes = std::as_bytes(std::span(text));
    } else {
        for (const EmbeddedFile& embedded : embeddedFiles())
            if (embedded.name == nameInRule) bytes = embedded.bytes;
        if (bytes.empty()) return path.error();
    }
    Result<AssetMesh> mesh = parseAsset(bytes, file, nameInRule);
    if (!mesh) return mesh.error();
    return &entries_.emplace(nameInRule, Entry{std::move(*mesh), hashBytes(bytes)}).first->second.mesh;
}

u64 AssetLibrary::hashOf(const std::string& nameInRule) const
{
    const auto known = entries_.find(nameInRule);
    HELIO_CHECK(known != entries_.end(), nameInRule);
    return known->second.hash;
}

} // namespace helio
