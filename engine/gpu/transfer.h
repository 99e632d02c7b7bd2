// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstring>
#include <span>
#include <vector>

#include "city/base/check.h"
#include "engine/gpu/context.h"
#include "engine/gpu/resources.h"

namespace helio {

/// Copies bytes into a buffer through a staging buffer (in pieces of at most 32 MiB) and waits. offset and size must be
/// within the buffer; any memory kind.
void upload(Context& context, const Buffer& to, std::span<const std::byte> bytes, u64 offset = 0);

template <class T> void upload(Context& context, const Buffer& to, const std::vector<T>& items, u64 offset = 0)
{
    upload(context, to, std::as_bytes(std::span(items)), offset);
}

/// A device buffer that holds these items; an empty list makes a buffer of one zero item, because Vulkan has no empty
/// ones.
template <class T> Buffer makeBuffer(Context& context, std::string name, std::span<const T> items)
{
    const u64 bytes = items.empty() ? sizeof(T) : items.size_bytes();
    Buffer buffer(context, {std::move(name), (bytes + 3) / 4 * 4});
    const T zero{};
    upload(context, buffer, items.empty() ? std::as_bytes(std::span(&zero, 1)) : std::as_bytes(items));
    return buffer;
}
template <class T> Buffer makeBuffer(Context& context, std::string name, const std::vector<T>& items)
{
    return makeBuffer(context, std::move(name), std::span<const T>(items));
}

/// Copies one layer's texels, tightly packed in rows, into an image (usage TRANSFER_DST) and waits.
void uploadImage(Context& context, const Image& to, std::span<const std::byte> texels, u32 layer = 0);

/// Waits for the device and returns the buffer's bytes [offset, offset + size); size 0 = to the end.
std::vector<std::byte> download(Context& context, const Buffer& from, u64 offset = 0, u64 size = 0);

/// Waits for the device and returns one layer's texels, rows tightly packed. The image needs usage TRANSFER_SRC.
std::vector<std::byte> downloadImage(Context& context, const Image& from, u32 layer = 0);

/// Reinterprets downloaded bytes; their number must be a multiple of sizeof(T).
template <class T> std::vector<T> asItems(const std::vector<std::byte>& bytes)
{
    HELIO_CHECK(bytes.size() % sizeof(T) == 0, bytes.size(), " bytes are not whole items of ", sizeof(T));
    std::vector<T> items(bytes.size() / sizeof(T));
    if (!items.empty()) std::memcpy(items.data(), bytes.data(), bytes.size());
    return items;
}
template <class T> std::vector<T> downloadItems(Context& context, const Buffer& from)
{
    return asItems<T>(download(context, from));
}
template <class T> std::vector<T> downloadTexels(Context& context, const Image& from, u32 layer = 0)
{
    return asItems<T>(downloadImage(context, from, layer));
}

} // namespace helio
