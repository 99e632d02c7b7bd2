// SPDX-License-Identifier: Apache-2.0
#include "tests/support/image_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <algorithm>
#include <cmath>
#include <exception>
#include <png.h>

namespace helio {
namespace {

Result<TestImage> readPng(const std::string& path)
{
    png_image file{};
    file.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&file, path.c_str())) return Error{concat(path, ": ", file.message)};
    file.format = PNG_FORMAT_RGB;
    std::vector<u8> bytes(PNG_IMAGE_SIZE(file));
    if (!png_image_finish_read(&file, nullptr, bytes.data(), 0, nullptr))
        return Error{concat(path, ": ", file.message)};
    return TestImage{file.width, file.height, std::vector<float>(bytes.begin(), bytes.end())};
}

Result<TestImage> readExr(const std::string& path)
{
    try {
        Imf::InputFile file(path.c_str());
        const Imath::Box2i window = file.header().dataWindow();
        TestImage image = makeTestImage(u32(window.max.x - window.min.x + 1), u32(window.max.y - window.min.y + 1), 0);
        constexpr size_t kPixelBytes = 3 * sizeof(float);
        const size_t rowBytes = kPixelBytes * image.width;
        Imf::FrameBuffer target;
        const char* names[3] = {"R", "G", "B"};
        for (size_t channel = 0; channel < 3; ++channel) {
            if (!file.header().channels().findChannel(names[channel]))
                return Error{concat(path, ": there is no channel ", names[channel])};
            target.insert(names[channel],
                          Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + channel, window, kPixelBytes, rowBytes));
        }
        file.setFrameBuffer(target);
        file.readPixels(window.min.y, window.max.y);
        return image;
    } catch (const std::exception& problem) {
        return Error{concat(path, ": ", problem.what())};
    }
}

Status writePng(const std::string& path, const TestImage& image)
{
    std::vector<u8> bytes(image.rgb.size());
    std::transform(image.rgb.begin(), image.rgb.end(), bytes.begin(),
                   [](float value) { return u8(std::lround(std::clamp(value, 0.0f, 255.0f))); });
    png_image file{};
    file.version = PNG_IMAGE_VERSION;
    file.width = image.width;
    file.height = image.height;
    file.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_file(&file, path.c_str(), 0, bytes.data(), 0, nullptr))
        return Error{concat(path, ": ", file.message)};
    return Nothing{};
}

Status writeExr(const std::string& path, const TestImage& image)
{
    try {
        std::vector<Imf::Rgba> pixels(size_t(image.width) * image.height);
        for (size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = Imf::Rgba(image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]);
        Imf::RgbaOutputFile file(path.c_str(), int(image.width), int(image.height), Imf::WRITE_RGB);
        file.setFrameBuffer(pixels.data(), 1, image.width);
        file.writePixels(int(image.height));
        return Nothing{};
    } catch (const std::exception& problem) {
        return Error{concat(path, ": ", problem.what())};
    }
}

} // namespace

TestImage makeTestImage(u32 width, u32 height, float value)
{
    return {width, height, std::vector<float>(size_t(width) * height * 3, value)};
}

Result<TestImage> readTestImage(const std::filesystem::path& path)
{
    if (path.extension() == ".exr") return readExr(path.string());
    return readPng(path.string());
}

Status writeTestImage(const std::filesystem::path& path, const TestImage& image)
{
    if (path.extension() == ".exr") return writeExr(path.string(), image);
    return writePng(path.string(), image);
}

} // namespace helio
