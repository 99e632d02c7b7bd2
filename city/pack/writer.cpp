// SPDX-License-Identifier: Apache-2.0
#include "city/pack/writer.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include "city/base/file.h"
#include "city/base/hash.h"
#include "city/format/sections.h"
#include "city/format/validate.h"
#include "city/pack/encode_links.h"

namespace helio {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const std::byte>;

constexpr int kZstdLevel = 3;
constexpr size_t kChunkBytes = size_t(8) << 20; ///< between two looks at WriteOptions::cancelled

/// A tile file as pieces, ready to be written one after the other.
struct TilePieces
{
    std::vector<std::byte> table;
    std::array<Bytes, kSectionCount> stored;
    std::array<u64, kSectionCount> offset{};
    std::vector<std::vector<std::byte>> packed; ///< what `stored` points into where a section is packed
    TileEntry entry;

    LinkBytes linkBytes() const
    {
        const auto size = [&](SectionId id) { return u64(stored[u32(id) - 1].size()); };
        return {size(SectionId::LinkColumns), size(SectionId::LinkFactors), size(SectionId::LinkMoments)};
    }
};

std::vector<std::byte> packBytes(Bytes raw)
{
    std::vector<std::byte> packed(ZSTD_compressBound(raw.size()));
    const size_t size = ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), kZstdLevel);
    HELIO_CHECK(!ZSTD_isError(size), ZSTD_getErrorName(size));
    packed.resize(size);
    packed.shrink_to_fit();
    return packed;
}

TilePieces layOut(const TileView& tile, bool zstd, bool compactLinks)
{
    TilePieces pieces;
    TileHeader header;
    std::array<SectionEntry, kSectionCount> entries;
    CompactLinks links;
    if (compactLinks) links = encodeLinks(tile);
    u64 end = kTableBytes;
    forEachSection(tile, [&]<class T>(SectionId id, const char*, std::span<const T> span) {
        const u32 i = u32(id) - 1;
        const Bytes raw = std::as_bytes(span);
        Bytes stored = raw;
        bool packed = false, compact = false;
        if (std::vector<std::byte>* payload = links.of(id); payload != nullptr && payload->size() < raw.size()) {
            compact = true;
            stored = pieces.packed.emplace_back(std::move(*payload));
        }
        if (zstd && !raw.empty()) {
            std::vector<std::byte> frame = packBytes(stored);
            if (frame.size() < stored.size()) {
                packed = true;
                stored = pieces.packed.emplace_back(std::move(frame));
            }
        }
        const SectionCodec codec = compact ? (packed ? SectionCodec::CompactZstd : SectionCodec::Compact)
                                           : (packed ? SectionCodec::Zstd : SectionCodec::Raw);
        pieces.stored[i] = stored;
        pieces.offset[i] = alignSection(end);
        entries[i] = {u32(id), u32(codec), pieces.offset[i], stored.size(), raw.size(), hashBytes(stored), 0};
        end = pieces.offset[i] + stored.size();
    });
    header.fileBytes = end;
    pieces.table.resize(kTableBytes);
    std::memcpy(pieces.table.data(), &header, sizeof header);
    std::memcpy(pieces.table.data() + sizeof header, entries.data(), sizeof entries);
    header.tableChecksum = hashBytes(pieces.table);
    std::memcpy(pieces.table.data(), &header, sizeof header);
    pieces.entry = {header.fileBytes, header.tableChecksum};
    return pieces;
}

/// Calls write(bytes) for all bytes of the tile file in order, zeros between the sections included.
template <class Write> void forEachPiece(const TilePieces& pieces, Write&& write)
{
    constexpr std::array<std::byte, kSectionAlignment> zeros{};
    write(Bytes(pieces.table));
    u64 end = kTableBytes;
    for (u32 i = 0; i < kSectionCount; ++i) {
        write(Bytes(zeros).first(pieces.offset[i] - end));
        write(pieces.stored[i]);
        end = pieces.offset[i] + pieces.stored[i].size();
    }
}

/// The folder that is being filled; removed with all that is in it unless it was kept.
class TemporaryFolder
{
public:
    explicit TemporaryFolder(fs::path path) : path_(std::move(path))
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored); // What a killed bake left behind.
        fs::create_directory(path_, failure_);
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const fs::path& path() const { return path_; }
    const std::error_code& failure() const { return failure_; }

private:
    fs::path path_;
    std::error_code failure_;
};

/// A file written in chunks; the first failure sticks.
class ChunkedFile
{
public:
    ChunkedFile(const fs::path& path, const WriteOptions& options)
        : options_(options), file_(std::fopen(path.c_str(), "wbx")), failed_(file_ == nullptr), errno_(errno)
    {
    }
    ~ChunkedFile()
    {
        if (file_ != nullptr) std::fclose(file_);
    }
    ChunkedFile(const ChunkedFile&) = delete;
    ChunkedFile& operator=(const ChunkedFile&) = delete;

    void write(Bytes bytes)
    {
        for (size_t at = 0; at < bytes.size() && !failed_ && !interrupted_; at += kChunkBytes) {
            const Bytes chunk = bytes.subspan(at, std::min(kChunkBytes, bytes.size() - at));
            interrupted_ = options_.cancelled && options_.cancelled();
            if (!interrupted_ && std::fwrite(chunk.data(), 1, chunk.size(), file_) != chunk.size()) fail();
        }
    }
    Status close(const fs::path& target)
    {
        if (file_ != nullptr && std::fclose(std::exchange(file_, nullptr)) != 0) fail();
        if (interrupted_) return Error{concat(target.string(), ": interrupted, nothing was written")};
        if (failed_) return Error{concat(target.string(), ": cannot be written: ", std::strerror(errno_))};
        return Nothing{};
    }

private:
    void fail()
    {
        failed_ = true;
        errno_ = errno;
    }
    const WriteOptions& options_;
    std::FILE* file_;
    bool failed_, interrupted_ = false;
    int errno_;
};

/// Puts `from` in the place of `to`; what was there before takes the place of `from`.
std::error_code exchangeFolders(const fs::path& from, const fs::path& to)
{
    std::error_code failure;
    if (!fs::exists(to, failure)) {
        fs::rename(from, to, failure);
        return failure;
    }
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return {};
    if (errno != EINVAL && errno != ENOSYS) return {errno, std::generic_category()};
    // A file system without exchange: there is a moment without a pack, never one with half a pack.
    fs::path old = from;
    old += ".old";
    fs::rename(to, old, failure);
    if (failure) return failure;
    fs::rename(from, to, failure);
    std::error_code ignored;
    fs::rename(old, failure ? to : from, ignored);
    return failure;
}

/// A folder that holds an index, tiles and nothing else: what may be replaced.
bool isPackFolder(const fs::path& folder)
{
    std::error_code failure;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure)) {
        const std::string name = entry.path().filename().string();
        if (name != kIndexFile && name.rfind("tile-", 0) != 0) return false;
    }
    const Result<std::string> index = failure ? Result<std::string>(Error{}) : readTextFile(folder / kIndexFile);
    return index && index->rfind(kIndexMagic, 0) == 0;
}

fs::path withoutTrailingSlash(const fs::path& folder)
{
    return folder.has_filename() ? folder : folder.parent_path();
}

} // namespace

EncodedTile encodeTile(const TileView& tile, bool zstd, bool compactLinks)
{
    const TilePieces pieces = layOut(tile, zstd, compactLinks);
    EncodedTile out{{}, pieces.entry};
    out.bytes.reserve(pieces.entry.bytes);
    forEachPiece(pieces, [&](Bytes bytes) { out.bytes.insert(out.bytes.end(), bytes.begin(), bytes.end()); });
    return out;
}

Status checkPackTarget(const fs::path& folder)
{
    const fs::path target = withoutTrailingSlash(folder);
    std::error_code failure;
    const fs::path parent = target.has_parent_path() ? target.parent_path() : fs::path(".");
    if (target.empty() || target.filename() == "." || target.filename() == "..")
        return Error{concat("'", folder.string(), "' cannot be the name of a pack: give the name of a new folder")};
    if (!fs::is_directory(parent, failure))
        return Error{
            concat(parent.string(), ": there is no such folder to write ", target.filename().string(), " into")};
    if (access(parent.c_str(), W_OK | X_OK) != 0)
        return Error{concat(parent.string(), ": cannot be written to: ", std::strerror(errno))};
    if (!fs::exists(fs::symlink_status(target, failure))) return Nothing{};
    if (!isPackFolder(target))
        return Error{concat(target.string(),
                            ": exists and is not a pack; it is not replaced, choose another name or remove it")};
    return Nothing{};
}

Status checkContent(const PackContent& content, const std::string& name)
{
    SectionPlaces places;
    places.file = concat(name, ": not written, the bake is faulty");
    return validateTile(content.view(), content.index, places);
}

Result<LinkBytes> writePack(const PackContent& content, const fs::path& folder, const WriteOptions& options)
{
    const TileView tile = content.view();
    if (Status status = checkPackTarget(folder); !status) return status.error();
    const fs::path target = withoutTrailingSlash(folder);
    if (Status status = checkContent(content, target.string()); !status) return status.error();

    const TilePieces pieces = layOut(tile, options.zstd, options.compactLinks);
    fs::path temporary = target;
    temporary += concat(".part-", getpid());
    TemporaryFolder part(temporary);
    if (part.failure()) return Error{concat(target.string(), ": cannot be written: ", part.failure().message())};

    ChunkedFile tileFile(part.path() / kTileFile, options);
    forEachPiece(pieces, [&](Bytes bytes) { tileFile.write(bytes); });
    if (Status status = tileFile.close(target); !status) return status.error();
    ChunkedFile indexFile(part.path() / kIndexFile, options);
    const std::string text = encodeIndex(content.index, pieces.entry);
    indexFile.write(std::as_bytes(std::span(text)));
    if (Status status = indexFile.close(target); !status) return status.error();

    if (const std::error_code failure = exchangeFolders(part.path(), target))
        return Error{concat(target.string(), ": cannot be written: ", failure.message())};
    return pieces.linkBytes();
}

} // namespace helio
