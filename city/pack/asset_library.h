// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "city/assets/asset.h"
#include "city/base/result.h"

namespace helio {

/// Loads the assets that rules name, each once: from the folders, in their order, else from those that the program
/// carries.
class AssetLibrary
{
public:
    explicit AssetLibrary(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

    /// The asset of a name in a rule; loads it on the first call. The error names what is wrong, or where it was looked
    /// for. The pointer lives as long as the library.
    Result<const AssetMesh*> find(const std::string& nameInRule);
    /// Hash of the bytes of an asset that find() gave.
    u64 hashOf(const std::string& nameInRule) const;

private:
    struct Entry
    {
        AssetMesh mesh;
        u64 hash = 0;
    };
    std::vector<std::filesystem::path> folders_;
    std::map<std::string, Entry> entries_;
};

} // namespace helio
