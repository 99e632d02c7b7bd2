// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <span>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio {

/// A file mapped for reading; unmapped when the last copy goes. Shortening the file while it is mapped is not survived.
class MappedFile
{
public:
    /// Maps a whole file. The error names the path and the operating system's reason.
    static Result<MappedFile> open(const std::filesystem::path& path);
    std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

private:
    std::shared_ptr<const std::byte> data_;
    size_t size_ = 0;
};

} // namespace helio
