// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

#include "engine/gpu/context.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/resources.h"

namespace helio {

/// A resource for one binding of set 0. Make it with the functions below.
struct Bound
{
    u32 binding = 0;
    const Buffer* buffer = nullptr;
    const Image* image = nullptr;
    VkFormat format = VK_FORMAT_UNDEFINED; // of the texels, if the shader reads a texel buffer
    u64 offset = 0;                        // storage buffers, bytes
    u64 bytes = 0;                         // storage buffers, 0 = to the end
    Sampler sampler = Sampler::Nearest;    // sampled images
    ImagePart part = {};                   // images
};

/// Number of work groups along each axis.
struct Groups
{
    u32 x = 1;
    u32 y = 1;
    u32 z = 1;
};

/// Groups of `groupSize` invocations that cover `items`. Above 65535 groups the rest goes to y: the shader's linear
/// group index is gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x, and it must compare its item with the item
/// count.
Groups groupsFor(u64 items, u32 groupSize);
/// Groups that cover an image of width x height with tiles.
Groups groupsFor2D(u32 width, u32 height, u32 tileWidth, u32 tileHeight);

struct PassTime
{
    std::string name;
    double milliseconds = 0;
};

/// Milliseconds of all passes together.
double totalTime(std::span<const PassTime> passes);

/// One command buffer with what it needs until the device is done: descriptor pools, timestamps, a fence. Use two of
/// them in turn to have two frames in flight. begin, record, submit, wait; begin waits by itself.
class Recorder
{
public:
    explicit Recorder(Context& context);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Waits for the previous submission of this recorder and starts recording.
    void begin();
    /// Ends recording and submits; the queue waits for `wait` at all stages and signals `signal` (both may be null).
    void submit(VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
    /// Blocks until the last submission is complete; nothing if there is none.
    void wait();
    void submitAndWait()
    {
        submit();
        wait();
    }

    Context& context() const { return context_; }
    VkCommandBuffer commands() const { return commands_; }

    /// Binds a pipeline and a fresh descriptor set. Checked: every binding of the shader is given once, with a resource
    /// of its kind, storage ranges within the device's limit. Barriers: none, the caller's.
    void bind(const Pipeline& pipeline, std::span<const Bound> bounds);
    /// Push constants of the bound pipeline; `bytes` must have the size of the shader's block.
    void push(const Pipeline& pipeline, std::span<const std::byte> bytes);
    /// Records dependencies; nothing when both lists are empty.
    void barriers(std::span<const VkBufferMemoryBarrier2> buffers, std::span<const VkImageMemoryBarrier2> images);
    /// A memory barrier over all resources.
    void barrier(VkPipelineStageFlags2 srcStages, VkAccessFlags2 srcAccess, VkPipelineStageFlags2 dstStages,
                 VkAccessFlags2 dstAccess);

    /// Marks the end of a named stretch of work, which began at the previous mark; an empty name only marks where the
    /// next one begins. Order on tiled software drivers: EndRendering; mark; barrier. Barriers: none. Nothing if the
    /// queue has no timestamps.
    void mark(const std::string& name);
    /// After wait: the stretches of the last submission in order. Empty without timestamps.
    std::vector<PassTime> times();

    void beginLabel(const std::string& name);
    void endLabel();

private:
    VkDescriptorSet allocateSet(VkDescriptorSetLayout layout);

    Context& context_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    bool submitted_ = false;
    std::vector<VkDescriptorPool> descriptorPools_;
    u32 usedPools_ = 0;
    VkQueryPool queries_ = VK_NULL_HANDLE;
    std::vector<std::string> marks_;
    PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel_ = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT endLabel_ = nullptr;
};

} // namespace helio
