// SPDX-License-Identifier: Apache-2.0
#include "city/format/mapped_file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace helio {

Result<MappedFile> MappedFile::open(const std::filesystem::path& path)
{
    const auto reason = [&](const char* what) {
        return Error{concat(path.string(), ": ", what, ": ", std::strerror(errno))};
    };
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return reason("cannot be opened");
    struct stat status
    {
    };
    if (fstat(descriptor, &status) != 0) {
        const Error error = reason("cannot be examined");
        close(descriptor);
        return error;
    }
    if (!S_ISREG(status.st_mode)) {
        close(descriptor);
        return Error{concat(path.string(), ": is not a plain file")};
    }
    MappedFile file;
    file.size_ = size_t(status.st_size);
    if (file.size_ > 0) { // A mapping of no bytes is an error to the system, not to us.
        void* address = mmap(nullptr, file.size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
        if (address == MAP_FAILED) {
            const Error error = reason("cannot be mapped");
            close(descriptor);
            return error;
        }
        file.data_ = {static_cast<const std::byte*>(address),
                      [size = file.size_](const std::byte* p) { munmap(const_cast<std::byte*>(p), size); }};
    }
    close(descriptor);
    return file;
}

} // namespace helio
