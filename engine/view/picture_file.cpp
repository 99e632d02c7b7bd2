// SPDX-License-Identifier: Apache-2.0
#include "engine/view/picture_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <csetjmp>
#include <cstring>
#include <limits>
#include <png.h>

#include "city/base/file.h"

namespace helio {

namespace {

void appendPng(png_structp png, png_bytep data, png_size_t size)
{
    auto& bytes = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
    const auto* first = reinterpret_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + size);
}

void flushPng(png_structp) {}

/// libpng reports errors by a long jump: nothing with a destructor lives in this frame.
bool encodePng(png_structp png, png_infop info, u32 width, u32 height, const u8* rgba, std::vector<std::byte>& bytes)
{
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &bytes, appendPng, flushPng);
    png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (u32 y = 0; y < height; ++y) png_write_row(png, rgba + size_t(y) * width * 4);
    png_write_end(png, info);
    return true;
}

/// An EXR in memory, so that it reaches the disk whole or not at all.
class MemoryStream : public Imf::OStream
{
public:
    MemoryStream() : Imf::OStream("picture") {}
    void write(const char data[], int size) override
    {
        if (bytes.size() < position_ + size_t(size)) bytes.resize(position_ + size_t(size));
        std::memcpy(bytes.data() + position_, data, size_t(size));
        position_ += size_t(size);
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = size_t(position); }

    std::vector<std::byte> bytes;

private:
    size_t position_ = 0;
};

} // namespace

Status writePng(const std::filesystem::path& path, u32 width, u32 height, std::span<const u8> rgba)
{
    HELIO_CHECK(rgba.size() == size_t(width) * height * 4, rgba.size(), " bytes for ", width, " x ", height);
    std::vector<std::byte> bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool ok = info && encodePng(png, info, width, height, rgba.data(), bytes);
    png_destroy_write_struct(&png, &info);
    if (!ok) return Error{concat(path.string(), ": the PNG encoder failed on ", width, " x ", height, " pixels")};
    return writeFileAtomically(path, bytes);
}

Status writeExr(const std::filesystem::path& path, u32 width, u32 height, std::span<const ExrChannel> channels)
{
    MemoryStream stream;
    try {
        Imf::Header header{int(width), int(height)};
        Imf::FrameBuffer frame;
        for (const ExrChannel& channel : channels) {
            const bool whole = !channel.uints.empty();
            HELIO_CHECK((whole ? channel.uints.size() : channel.floats.size()) == size_t(width) * height, channel.name);
            const Imf::PixelType type = whole ? Imf::UINT : Imf::FLOAT;
            header.channels().insert(channel.name, Imf::Channel(type));
            const void* data = whole ? static_cast<const void*>(channel.uints.data()) : channel.floats.data();
            // The library's slices are not const, but writing only reads them.
            frame.insert(channel.name,
                         Imf::Slice(type, static_cast<char*>(const_cast<void*>(data)), 4, 4 * size_t(width)));
        }
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(int(height));
    } catch (const std::exception& e) {
        return Error{concat(path.string(), ": the EXR encoder failed: ", e.what())};
    }
    return writeFileAtomically(path, stream.bytes);
}

std::vector<ExrChannel> exrChannels(const Picture& picture, u32 mode)
{
    const auto component = [&](const char* name, int c) {
        ExrChannel channel{name, {}, {}};
        for (const glm::vec4& v : picture.values) channel.floats.push_back(v[c]);
        return channel;
    };
    if (mode == gpu::kModeSunVisibility) return {component("Y", 0)};
    if (mode == gpu::kModeDepth) {
        ExrChannel z = component("Z", 0);
        for (size_t i = 0; i < z.floats.size(); ++i)
            if (picture.values[i].a < 0.0f) z.floats[i] = std::numeric_limits<float>::infinity();
        return {std::move(z)};
    }
    std::vector<ExrChannel> channels{component("R", 0), component("G", 1), component("B", 2)};
    if (mode == gpu::kModeId) {
        ExrChannel id{"id", {}, {}};
        for (const glm::vec4& v : picture.values) id.uints.push_back(v.a < 0.0f ? gpu::kNone : u32(v.a));
        channels.push_back(std::move(id));
    } else if (mode != gpu::kModeFinal) {
        channels.push_back(component("solar", 3));
    }
    return channels;
}

} // namespace helio
