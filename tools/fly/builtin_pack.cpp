// SPDX-License-Identifier: Apache-2.0
#include "tools/fly/builtin_pack.h"

#include <cstdlib>
#include <iostream>

#include "city/base/file.h"
#include "city/base/hash.h"
#include "city/pack/pipeline.h"
#include "city/pack/writer.h"

namespace helio {

std::filesystem::path cacheFolder()
{
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && *cache) return std::filesystem::path(cache) / "heliopolis";
    const char* home = std::getenv("HOME");
    if (home && *home) return std::filesystem::path(home) / ".cache" / "heliopolis";
    return std::filesystem::temp_directory_path() / "heliopolis";
}

Result<std::filesystem::path> builtinPack(const std::filesystem::path& folder)
{
    const Result<std::string> program = readTextFile("/proc/self/exe");
    if (!program) return program.error();
    const std::string key = concat("program ", hashText(*program), "\n");
    const std::filesystem::path pack = folder / "builtin.pack", keyFile = folder / "builtin.key";

    const Result<std::string> known = readTextFile(keyFile);
    if (known && *known == key && Pack::open(pack)) return pack;

    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) return Error{concat(folder.string(), ": cannot make the folder: ", failure.message())};
    std::cout << "Baking the built-in city into " << pack.string() << std::endl;
    const Result<BakeResult> baked = bake({});
    if (!baked) return baked.error();
    if (const Result<LinkBytes> written = writePack(baked->content, pack); !written) return written.error();
    if (const Status written = writeTextAtomically(keyFile, key); !written) return written.error();
    return pack;
}

} // namespace helio
