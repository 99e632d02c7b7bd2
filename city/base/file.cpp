// SPDX-License-Identifier: Apache-2.0
#include "city/base/file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>
#include <unistd.h>

namespace helio {

Result<std::string> readTextFile(const std::filesystem::path& path)
{
    std::error_code failure;
    if (std::filesystem::is_directory(path, failure))
        return Error{concat(path.string(), ": is a folder, a file is needed")};
    std::ifstream in(path, std::ios::binary);
    if (!in) return Error{concat(path.string(), ": cannot be opened: ", std::strerror(errno))};
    std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (in.bad()) return Error{concat(path.string(), ": cannot be read: ", std::strerror(errno))};
    return text;
}

Status writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes)
{
    std::filesystem::path temporary = path;
    temporary += ".part";
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    out.close();
    std::error_code failure;
    if (!out) {
        const std::string reason = std::strerror(errno);
        std::filesystem::remove(temporary, failure);
        return Error{concat(path.string(), ": cannot be written: ", reason)};
    }
    std::filesystem::rename(temporary, path, failure);
    if (failure) {
        const std::string reason = failure.message();
        std::filesystem::remove(temporary, failure);
        return Error{concat(path.string(), ": cannot be written: ", reason)};
    }
    return Nothing{};
}

Status checkFileTarget(const std::filesystem::path& path)
{
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    std::error_code failure;
    if (!std::filesystem::is_directory(folder, failure))
        return Error{concat(path.string(), ": cannot be written: there is no folder ", folder.string())};
    if (!path.has_filename() || std::filesystem::is_directory(path, failure))
        return Error{concat(path.string(), ": cannot be written: it is a folder, a file is needed")};
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        return Error{concat(path.string(), ": cannot be written: ", folder.string(), ": ", std::strerror(errno))};
    return Nothing{};
}

Status writeTextAtomically(const std::filesystem::path& path, std::string_view text)
{
    return writeFileAtomically(path, std::as_bytes(std::span(text)));
}

} // namespace helio
