// SPDX-License-Identifier: Apache-2.0
// The only place that knows that a surface exists: a GLFW window with its input, and the swapchain that shows pictures
// in it. Order of life: Window, Context (with connect), Swapchain; destroyed in reverse.
#pragma once
#include <array>
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"
#include "engine/gpu/context.h"
#include "engine/gpu/recorder.h"
#include "engine/gpu/resources.h"
#include "engine/graph/frame_graph.h"

struct GLFWwindow;

namespace helio {

/// The keys that programs may ask for. Letters are places on a US keyboard, so that flying works on other layouts.
enum class Key : u32
{
    W,
    A,
    S,
    D,
    Q,
    E,
    P,
    Shift,
    Left,
    Right,
    Up,
    Down,
    BracketLeft,
    BracketRight,
    F2,
    Escape,
    Digit1,
    Digit2,
    Digit3,
    Digit4,
    Digit5,
    Digit6,
    Digit7,
    Digit8,
    Digit9,
};
inline constexpr u32 kKeyCount = u32(Key::Digit9) + 1;

/// A window of the desktop. One at a time, from the main thread.
class Window
{
public:
    /// Says in one sentence why no window can be opened here, to be asked before hours of work.
    static Status checkDisplay();
    /// Opens a window whose picture has `width` x `height` pixels where the desktop allows it. Error: one sentence when
    /// there is no display, or the display has no Vulkan.
    static Result<std::unique_ptr<Window>> open(const std::string& title, u32 width, u32 height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Fills in what a context needs to present to this window.
    void connect(ContextOptions& options) const;

    /// Takes in what happened since the last call. With `sleepSeconds` > 0 waits for the next event, at most that long.
    void poll(double sleepSeconds = 0);
    /// Has the user asked to close it?
    bool closing() const;
    bool isDown(Key key) const { return down_[u32(key)]; }
    /// Did the key go down between the last two polls?
    bool wasPressed(Key key) const { return pressed_[u32(key)]; }
    /// Pixels (right, down) that the mouse moved with a button held between the last two polls.
    glm::dvec2 dragged() const { return dragged_; }
    /// Size of the picture in pixels; 0 x 0 while minimised.
    glm::uvec2 pictureSize() const;
    /// Asks the desktop for another size; pictureSize tells what came of it after the next polls.
    void setSize(u32 width, u32 height);
    void setTitle(const std::string& title);

private:
    Window() = default;
    static void onKey(GLFWwindow* handle, int key, int scancode, int action, int mods);

    GLFWwindow* handle_ = nullptr;
    std::array<bool, kKeyCount> down_{};
    std::array<bool, kKeyCount> pressed_{};
    glm::dvec2 cursor_{0.0};
    glm::dvec2 dragged_{0.0};
    bool dragging_ = false;
};

/// A picture as it was shown: 8-bit sRGB, r g b a, rows from the top.
struct ShownPicture
{
    u32 width = 0;
    u32 height = 0;
    std::vector<u8> rgba;
};

/// Shows pictures in a window, in step with the display (FIFO), two frames in flight. Follows the window's size by
/// itself.
class Swapchain
{
public:
    /// Error: one sentence when the surface offers no 8-bit format for sRGB-encoded bytes, or cannot be copied to.
    static Result<std::unique_ptr<Swapchain>> create(Context& context, const Window& window);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    /// Shows a picture: an RGBA8 image with transfer-source usage whose bytes are sRGB-encoded already; stretched if
    /// its size is not the window's (for one frame after a resize). False if nothing was shown: minimised, or the
    /// window's size changed at this moment. With `capture`, waits and gives back the swapchain's own pixels.
    bool show(const Image& picture, ShownPicture* capture = nullptr);

    /// "B8G8R8A8_UNORM, sRGB, FIFO" and so on, for reports.
    std::string describe() const;

private:
    Swapchain(Context& context, const Window& window) : context_(context), window_(window) {}
    Status chooseFormat();
    bool rebuild();
    void destroyImages();
    void buildGraph(const Image& picture);
    ShownPicture readShown(const Image& image);

    static constexpr u32 kFramesInFlight = 2;

    Context& context_;
    const Window& window_;
    VkSurfaceFormatKHR format_{};
    VkSwapchainKHR handle_ = VK_NULL_HANDLE;
    VkExtent2D extent_{};
    bool stale_ = true;
    std::vector<Image> images_;
    std::vector<VkSemaphore> rendered_; // one an image: signalled when its picture is complete
    std::array<VkSemaphore, kFramesInFlight> acquired_{};
    std::vector<std::unique_ptr<Recorder>> recorders_;
    u64 frame_ = 0;

    // The graph that copies; made again when the picture or the swapchain changes.
    FrameGraph graph_;
    Ref<Image> from_, to_;
    const Image* picture_ = nullptr;
    VkImage pictureHandle_ = VK_NULL_HANDLE;
};

} // namespace helio
