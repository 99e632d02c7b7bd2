// SPDX-License-Identifier: Apache-2.0
// Window and swapchain under a virtual display: run by xvfb-run.
#include "engine/view/window.h"

#include <gtest/gtest.h>

#include "engine/gpu/transfer.h"

namespace helio {
namespace {

constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

/// A picture whose bytes tell channel and place.
struct TestPicture
{
    std::vector<u8> rgba;
    Image image;

    TestPicture(Context& context, u32 width, u32 height)
        : image(context, {"picture", width, height, VK_FORMAT_R8G8B8A8_UNORM, 1, kUsage})
    {
        for (u32 y = 0; y < height; ++y)
            for (u32 x = 0; x < width; ++x)
                for (u32 value : {x * 5 % 256, y * 7 % 256, (x + y) * 3 % 256, 255u}) rgba.push_back(u8(value));
        uploadImage(context, image, std::as_bytes(std::span(rgba)));
    }
};

struct Shown
{
    std::unique_ptr<Window> window;
    std::unique_ptr<Context> context;
    std::unique_ptr<Swapchain> swapchain;

    Shown(u32 width, u32 height)
    {
        window = std::move(Window::open("window test", width, height).value());
        ContextOptions options;
        options.validation = true;
        options.device = "llvmpipe";
        window->connect(options);
        context = std::move(Context::create(options).value());
        swapchain = std::move(Swapchain::create(*context, *window).value());
    }

    /// Polls until the window has this size; the desktop needs a moment.
    bool waitForSize(glm::uvec2 size)
    {
        for (int attempt = 0; attempt < 100 && window->pictureSize() != size; ++attempt) window->poll(0.02);
        return window->pictureSize() == size;
    }

    void expectNoMessages()
    {
        ASSERT_TRUE(context->validating()) << "install vulkan-validationlayers";
        for (const std::string& message : context->messages().all()) ADD_FAILURE() << message;
    }
};

TEST(Window, ShowsTheBytesOfThePicture)
{
    Shown shown(160, 90);
    const TestPicture picture(*shown.context, 160, 90);
    for (int frame = 0; frame < 5; ++frame) { // more frames than images
        shown.window->poll();
        ShownPicture pixels;
        ASSERT_TRUE(shown.swapchain->show(picture.image, &pixels));
        EXPECT_EQ(pixels.width, 160u);
        EXPECT_EQ(pixels.height, 90u);
        EXPECT_EQ(pixels.rgba, picture.rgba);
        EXPECT_TRUE(shown.swapchain->show(picture.image));
    }
    EXPECT_NE(shown.swapchain->describe().find("_UNORM, sRGB"), std::string::npos) << shown.swapchain->describe();
    shown.expectNoMessages();
}

TEST(Window, FollowsItsSizeAndStretches)
{
    Shown shown(160, 90);
    const TestPicture small(*shown.context, 160, 90), large(*shown.context, 320, 180);
    ASSERT_TRUE(shown.swapchain->show(small.image));
    shown.window->setSize(320, 180);
    ASSERT_TRUE(shown.waitForSize({320, 180}));
    ShownPicture pixels;
    ASSERT_TRUE(shown.swapchain->show(large.image, &pixels));
    EXPECT_EQ(pixels.rgba, large.rgba);
    // A picture of half the size is stretched: every pixel four times.
    ASSERT_TRUE(shown.swapchain->show(small.image, &pixels));
    ASSERT_EQ(pixels.width, 320u);
    for (u32 y = 0; y < 180; y += 7)
        for (u32 x = 0; x < 320; x += 3)
            ASSERT_EQ(pixels.rgba[(y * 320 + x) * 4], small.rgba[(y / 2 * 160 + x / 2) * 4]) << x << ", " << y;
    shown.expectNoMessages();
}

} // namespace
} // namespace helio
