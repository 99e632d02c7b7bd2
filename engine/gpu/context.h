// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

#include "city/base/result.h"
#include "engine/gpu/device_features.h"
#include "engine/gpu/messages.h"

VK_DEFINE_HANDLE(VmaAllocator)

namespace helio {

class PipelineCache;

struct ContextOptions
{
    bool validation = false;   // validation layer with synchronisation validation; messages() collects
    std::string device;        // part of the device's name; empty = environment HELIO_DEVICE, else automatic
    u32 texelElementLimit = 0; // if not 0, lowers the device's limit (forces the storage-buffer variants)
    std::vector<const char*> instanceExtensions; // what the window system asks for; none = headless
    /// Makes the surface to present to; null = headless. The context owns the surface. Only devices that can present to
    /// it are chosen, and the swapchain extension is enabled.
    std::function<VkResult(VkInstance, VkSurfaceKHR*)> makeSurface;
};

enum class Sampler : u32
{
    Nearest, // clamp to edge
    Linear,  // clamp to edge
    Shadow,  // compare: 1 where reference <= texel, bilinear over the four results; lit outside the image
};
inline constexpr u32 kSamplerCount = 3;

/// Instance, device, one queue for everything, allocator, samplers and pipelines. One thread at a time. Everything made
/// from a context must die before it.
class Context
{
public:
    /// Picks a device (discrete before integrated before the rest, in the loader's order; or the one asked for) and
    /// opens it. Error: one sentence that says what is missing and what to do.
    static Result<std::unique_ptr<Context>> create(const ContextOptions& options);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const DeviceFacts& facts() const { return facts_; }
    /// "name (driver)" for reports.
    std::string describe() const;
    /// Can a uniform texel buffer have this many elements? If not, use the shader's storage-buffer variant.
    bool texelsFit(u64 elements) const { return elements <= facts_.maxTexelBufferElements; }
    MessageLog& messages() { return *messages_; }
    /// The same log, for those who want to hear what the device says while it is closed.
    std::shared_ptr<MessageLog> sharedMessages() const { return messages_; }
    bool validating() const { return messenger_ != VK_NULL_HANDLE; }

    VkInstance instance() const { return instance_; }
    VkPhysicalDevice physicalDevice() const { return physical_; }
    VkDevice device() const { return device_; }
    VkQueue queue() const { return queue_; }
    u32 queueFamily() const { return queueFamily_; }
    VmaAllocator allocator() const { return allocator_; }
    VkSurfaceKHR surface() const { return surface_; }
    VkSampler sampler(Sampler kind) const { return samplers_[u32(kind)]; }
    PipelineCache& pipelines() { return *pipelines_; }

    /// Names an object for validation messages and debuggers; nothing without the debug extension.
    void nameObject(VkObjectType type, u64 handle, const std::string& name) const;
    void waitIdle() const;

private:
    Context() = default;
    Status createInstance(const ContextOptions& options);
    Status pickDevice(const ContextOptions& options);
    Status createDevice(const ContextOptions& options);
    void createSamplers();

    std::shared_ptr<MessageLog> messages_ = std::make_shared<MessageLog>();
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    u32 queueFamily_ = 0;
    VmaAllocator allocator_ = nullptr;
    VkSampler samplers_[kSamplerCount] = {};
    PFN_vkSetDebugUtilsObjectNameEXT setName_ = nullptr;
    DeviceFacts facts_;
    std::unique_ptr<PipelineCache> pipelines_;
};

} // namespace helio
