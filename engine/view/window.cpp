// SPDX-License-Identifier: Apache-2.0
#include "engine/view/window.h"

#include <algorithm>
#include <utility>

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include "engine/gpu/vk_check.h"
#include "engine/graph/pass_context.h"

namespace helio {
namespace {

constexpr std::array<std::pair<Key, int>, 26> kKeyCodes{{
    {Key::W, GLFW_KEY_W},
    {Key::A, GLFW_KEY_A},
    {Key::S, GLFW_KEY_S},
    {Key::D, GLFW_KEY_D},
    {Key::Q, GLFW_KEY_Q},
    {Key::E, GLFW_KEY_E},
    {Key::P, GLFW_KEY_P},
    {Key::Shift, GLFW_KEY_LEFT_SHIFT},
    {Key::Shift, GLFW_KEY_RIGHT_SHIFT},
    {Key::Left, GLFW_KEY_LEFT},
    {Key::Right, GLFW_KEY_RIGHT},
    {Key::Up, GLFW_KEY_UP},
    {Key::Down, GLFW_KEY_DOWN},
    {Key::BracketLeft, GLFW_KEY_LEFT_BRACKET},
    {Key::BracketRight, GLFW_KEY_RIGHT_BRACKET},
    {Key::F2, GLFW_KEY_F2},
    {Key::Escape, GLFW_KEY_ESCAPE},
    {Key::Digit1, GLFW_KEY_1},
    {Key::Digit2, GLFW_KEY_2},
    {Key::Digit3, GLFW_KEY_3},
    {Key::Digit4, GLFW_KEY_4},
    {Key::Digit5, GLFW_KEY_5},
    {Key::Digit6, GLFW_KEY_6},
    {Key::Digit7, GLFW_KEY_7},
    {Key::Digit8, GLFW_KEY_8},
    {Key::Digit9, GLFW_KEY_9},
}};

// Formats whose bytes are shown as they are. The pictures that we show are sRGB-encoded already, so an _SRGB format,
// which encodes once more while it is written, is the wrong one.
constexpr std::array<VkFormat, 2> kFormats{VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM};

std::string lastGlfwReason()
{
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "no reason given";
}

template <class T, class Call> std::vector<T> enumerate(const char* what, Call&& call)
{
    u32 count = 0;
    std::vector<T> items;
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {
        vkCheck(call(&count, static_cast<T*>(nullptr)), what);
        items.resize(count);
        result = call(&count, items.data());
    }
    vkCheck(result, what);
    items.resize(count);
    return items;
}

VkSurfaceCapabilitiesKHR surfaceCapabilities(const Context& context)
{
    VkSurfaceCapabilitiesKHR capabilities{};
    vkCheck(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context.physicalDevice(), context.surface(), &capabilities),
            "asking the surface for its capabilities");
    return capabilities;
}

VkSemaphore makeSemaphore(const Context& context)
{
    VkSemaphoreCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    vkCheck(vkCreateSemaphore(context.device(), &info, nullptr, &semaphore), "creating a semaphore");
    return semaphore;
}

} // namespace

Status Window::checkDisplay()
{
    if (glfwInit() != GLFW_TRUE)
        return Error{concat("no window: there is no display to open it on (", lastGlfwReason(),
                            "); set DISPLAY, or use heliopolis-render, which needs none")};
    const bool supported = glfwVulkanSupported() == GLFW_TRUE;
    const std::string reason = supported ? "" : lastGlfwReason();
    glfwTerminate();
    if (!supported)
        return Error{concat("no window: the Vulkan loader or a driver that can present is missing (", reason,
                            "); install mesa-vulkan-drivers or the driver of your GPU")};
    return Nothing{};
}

Result<std::unique_ptr<Window>> Window::open(const std::string& title, u32 width, u32 height)
{
    if (Status status = checkDisplay(); !status) return status.error();
    if (glfwInit() != GLFW_TRUE) return Error{concat("no window: the display went away (", lastGlfwReason(), ")")};
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    std::unique_ptr<Window> window(new Window);
    window->handle_ = glfwCreateWindow(int(width), int(height), title.c_str(), nullptr, nullptr);
    if (!window->handle_) return Error{concat("no window: the desktop refused it (", lastGlfwReason(), ")")};
    glfwSetWindowUserPointer(window->handle_, window.get());
    glfwSetKeyCallback(window->handle_, onKey);
    glfwGetCursorPos(window->handle_, &window->cursor_.x, &window->cursor_.y);
    return window;
}

Window::~Window()
{
    if (handle_) glfwDestroyWindow(handle_);
    glfwTerminate();
}

void Window::connect(ContextOptions& options) const
{
    u32 count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    options.instanceExtensions.insert(options.instanceExtensions.end(), names, names + count);
    options.makeSurface = [handle = handle_](VkInstance instance, VkSurfaceKHR* surface) {
        return glfwCreateWindowSurface(instance, handle, nullptr, surface);
    };
}

void Window::onKey(GLFWwindow* handle, int key, int, int action, int)
{
    Window& window = *static_cast<Window*>(glfwGetWindowUserPointer(handle));
    for (const auto& [name, code] : kKeyCodes)
        if (code == key && action == GLFW_PRESS) window.pressed_[u32(name)] = true;
}

void Window::poll(double sleepSeconds)
{
    pressed_.fill(false);
    if (sleepSeconds > 0)
        glfwWaitEventsTimeout(sleepSeconds);
    else
        glfwPollEvents();
    down_.fill(false);
    for (const auto& [name, code] : kKeyCodes)
        if (glfwGetKey(handle_, code) == GLFW_PRESS) down_[u32(name)] = true;

    glm::dvec2 cursor{0.0};
    glfwGetCursorPos(handle_, &cursor.x, &cursor.y);
    const bool held = glfwGetMouseButton(handle_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS ||
                      glfwGetMouseButton(handle_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    // The first poll with the button down only says where the drag begins.
    dragged_ = held && dragging_ ? cursor - cursor_ : glm::dvec2(0.0);
    dragging_ = held;
    cursor_ = cursor;
}

bool Window::closing() const
{
    return glfwWindowShouldClose(handle_) == GLFW_TRUE;
}

glm::uvec2 Window::pictureSize() const
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(handle_, &width, &height);
    if (width <= 0 || height <= 0 || glfwGetWindowAttrib(handle_, GLFW_ICONIFIED) == GLFW_TRUE) return {0, 0};
    return {u32(width), u32(height)};
}

void Window::setSize(u32 width, u32 height)
{
    glfwSetWindowSize(handle_, int(width), int(height));
}

void Window::setTitle(const std::string& title)
{
    glfwSetWindowTitle(handle_, title.c_str());
}

Result<std::unique_ptr<Swapchain>> Swapchain::create(Context& context, const Window& window)
{
    HELIO_CHECK(context.surface() != VK_NULL_HANDLE, "the context was made without Window::connect");
    std::unique_ptr<Swapchain> chain(new Swapchain(context, window));
    if (Status status = chain->chooseFormat(); !status) return status.error();
    for (VkSemaphore& semaphore : chain->acquired_) semaphore = makeSemaphore(context);
    for (u32 i = 0; i < kFramesInFlight; ++i) chain->recorders_.push_back(std::make_unique<Recorder>(context));
    return chain;
}

Swapchain::~Swapchain()
{
    context_.waitIdle();
    recorders_.clear();
    destroyImages();
    for (VkSemaphore semaphore : acquired_) vkDestroySemaphore(context_.device(), semaphore, nullptr);
    vkDestroySwapchainKHR(context_.device(), handle_, nullptr);
}

Status Swapchain::chooseFormat()
{
    const auto formats =
        enumerate<VkSurfaceFormatKHR>("asking the surface for its formats", [&](u32* n, VkSurfaceFormatKHR* items) {
            return vkGetPhysicalDeviceSurfaceFormatsKHR(context_.physicalDevice(), context_.surface(), n, items);
        });
    for (const VkFormat wanted : kFormats)
        for (const VkSurfaceFormatKHR& offered : formats)
            if (offered.format == wanted && offered.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR &&
                format_.format == VK_FORMAT_UNDEFINED)
                format_ = offered;
    if (format_.format == VK_FORMAT_UNDEFINED)
        return Error{
            "no window: the display offers neither B8G8R8A8_UNORM nor R8G8B8A8_UNORM with the sRGB colour space; "
            "use heliopolis-render"};
    constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    if ((surfaceCapabilities(context_).supportedUsageFlags & kUsage) != kUsage)
        return Error{"no window: the display's images cannot be copied to and from; use heliopolis-render"};
    return Nothing{};
}

void Swapchain::destroyImages()
{
    images_.clear();
    for (VkSemaphore semaphore : rendered_) vkDestroySemaphore(context_.device(), semaphore, nullptr);
    rendered_.clear();
    picture_ = nullptr;
}

bool Swapchain::rebuild()
{
    const VkSurfaceCapabilitiesKHR capabilities = surfaceCapabilities(context_);
    VkExtent2D extent = capabilities.currentExtent;
    if (extent.width == 0xFFFFFFFFu) { // the desktop leaves the size to us
        const glm::uvec2 size = window_.pictureSize();
        extent.width = std::clamp(size.x, capabilities.minImageExtent.width, capabilities.maxImageExtent.width);
        extent.height = std::clamp(size.y, capabilities.minImageExtent.height, capabilities.maxImageExtent.height);
    }
    if (extent.width == 0 || extent.height == 0) return false;
    context_.waitIdle();
    destroyImages();

    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = context_.surface();
    info.minImageCount = capabilities.minImageCount + 1; // one more, so that acquiring does not wait for the display
    if (capabilities.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, capabilities.maxImageCount);
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = capabilities.currentTransform;
    info.compositeAlpha = capabilities.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR; // in step with the display; the only mode that every driver has
    info.clipped = VK_TRUE;
    info.oldSwapchain = handle_;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    vkCheck(vkCreateSwapchainKHR(context_.device(), &info, nullptr, &made), "creating a swapchain of ", extent.width,
            " x ", extent.height);
    vkDestroySwapchainKHR(context_.device(), handle_, nullptr);
    handle_ = made;
    extent_ = extent;

    const auto handles = enumerate<VkImage>("asking the swapchain for its images", [&](u32* n, VkImage* items) {
        return vkGetSwapchainImagesKHR(context_.device(), handle_, n, items);
    });
    for (VkImage image : handles) {
        images_.push_back(Image::borrow(context_, image,
                                        {.name = "swapchain",
                                         .width = extent.width,
                                         .height = extent.height,
                                         .format = format_.format,
                                         .usage = info.imageUsage}));
        rendered_.push_back(makeSemaphore(context_));
    }
    stale_ = false;
    return true;
}

void Swapchain::buildGraph(const Image& picture)
{
    graph_ = FrameGraph("present");
    from_ = graph_.import(picture);
    to_ = graph_.import(images_.front());
    const Ref<Image> shown = graph_.addPass("show", [&](PassBuilder& pass) {
        const Ref<Image> from = pass.read(from_, Use::CopyFrom);
        const Ref<Image> to = pass.write(to_, Use::CopyTo);
        pass.record([from, to](PassContext& ctx) {
            const Image& source = ctx.image(from);
            const Image& target = ctx.image(to);
            VkImageBlit region{};
            region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.srcOffsets[1] = {i32(source.desc().width), i32(source.desc().height), 1};
            region.dstOffsets[1] = {i32(target.desc().width), i32(target.desc().height), 1};
            // barriers: the graph's, from the declared uses.
            vkCmdBlitImage(ctx.commands(), source.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
        });
        return to;
    });
    graph_.leave(shown, Use::Present);
    const Status compiled = graph_.compile(context_);
    HELIO_CHECK(compiled.ok(), compiled.error().message);
    picture_ = &picture;
    pictureHandle_ = picture.handle();
}

bool Swapchain::show(const Image& picture, ShownPicture* capture)
{
    const glm::uvec2 size = window_.pictureSize();
    if (size.x == 0 || size.y == 0) return false;
    // Some desktops never report a swapchain of the wrong size: compare it ourselves.
    if (size.x != extent_.width || size.y != extent_.height) stale_ = true;
    if (stale_ && !rebuild()) return false;

    const u32 slot = u32(frame_ % kFramesInFlight);
    Recorder& recorder = *recorders_[slot];
    recorder.wait(); // the semaphore of this slot is free again
    u32 index = 0;
    const VkResult acquired =
        vkAcquireNextImageKHR(context_.device(), handle_, ~u64(0), acquired_[slot], VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        stale_ = true;
        return false;
    }
    if (acquired != VK_SUBOPTIMAL_KHR) vkCheck(acquired, "acquiring a swapchain image");

    if (picture_ != &picture || pictureHandle_ != picture.handle()) buildGraph(picture);
    // The presentation engine is done with the image when the semaphore is signalled, on which all stages wait.
    images_[index].forget(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    graph_.rebind(to_, images_[index]);
    recorder.begin();
    graph_.execute(recorder);
    recorder.submit(acquired_[slot], rendered_[index]);
    ++frame_;
    if (capture) *capture = readShown(images_[index]);

    VkPresentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &rendered_[index];
    info.swapchainCount = 1;
    info.pSwapchains = &handle_;
    info.pImageIndices = &index;
    const VkResult presented = vkQueuePresentKHR(context_.queue(), &info);
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR || acquired == VK_SUBOPTIMAL_KHR)
        stale_ = true;
    else
        vkCheck(presented, "presenting");
    return true;
}

ShownPicture Swapchain::readShown(const Image& image)
{
    const Buffer host(context_, {"shown picture", u64(extent_.width) * extent_.height * 4, Memory::Readback});
    FrameGraph graph("read shown picture");
    const Ref<Image> shown = graph.import(image);
    addReadback(graph, shown, 0, host);
    graph.leave(shown, Use::Present);
    const Status compiled = graph.compile(context_);
    HELIO_CHECK(compiled.ok(), compiled.error().message);
    Recorder recorder(context_);
    recorder.begin();
    graph.execute(recorder);
    recorder.submitAndWait();
    host.invalidate();

    ShownPicture result{extent_.width, extent_.height, {}};
    const u8* bytes = static_cast<const u8*>(host.mapped());
    result.rgba.assign(bytes, bytes + host.bytes());
    if (format_.format == VK_FORMAT_B8G8R8A8_UNORM)
        for (size_t i = 0; i < result.rgba.size(); i += 4) std::swap(result.rgba[i], result.rgba[i + 2]);
    for (size_t i = 3; i < result.rgba.size(); i += 4) result.rgba[i] = 255; // the window is opaque
    return result;
}

std::string Swapchain::describe() const
{
    return concat(format_.format == VK_FORMAT_B8G8R8A8_UNORM ? "B8G8R8A8_UNORM" : "R8G8B8A8_UNORM",
                  ", sRGB colour space, FIFO, ", images_.size(), " images of ", extent_.width, " x ", extent_.height);
}

} // namespace helio
