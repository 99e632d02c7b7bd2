// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <tuple>
#include <vulkan/vulkan.h>

#include "city/base/types.h"

VK_DEFINE_HANDLE(VmaAllocation)

namespace helio {

class Context;

/// How a resource was used last, which is all that the next barrier needs to know. Kept by the resource itself, so that
/// it survives from graph to graph and from frame to frame.
struct AccessState
{
    // The last write (a layout change counts) and the accesses through which it was made.
    VkPipelineStageFlags2 writeStages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 writeAccess = VK_ACCESS_2_NONE;
    // The reads since then. They see the write already, and the next write must wait for them.
    VkPipelineStageFlags2 readStages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 readAccess = VK_ACCESS_2_NONE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED; // images only
    bool defined = false;                             // was it ever written?

    bool operator==(const AccessState&) const = default;
};

enum class Memory : u32
{
    Device,   // not mapped; filled by upload() or by passes
    Upload,   // mapped, written by the host in order
    Readback, // mapped, read by the host at random
};

struct BufferDesc
{
    std::string name = {};
    u64 bytes = 0; // > 0
    Memory memory = Memory::Device;
};

/// A buffer with its memory. Every buffer may serve as storage, texel, vertex, index, indirect and copy buffer.
/// Move-only; an empty one (default constructed) has no handle.
class Buffer
{
public:
    Buffer() = default;
    /// Fails the process (exit code 2) when the device has no memory left; the message names the buffer and its size.
    Buffer(Context& context, BufferDesc desc);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    VkBuffer handle() const { return handle_; }
    const BufferDesc& desc() const { return desc_; }
    u64 bytes() const { return desc_.bytes; }
    /// Host address of Upload and Readback buffers, valid while the buffer lives; null for Device.
    void* mapped() const { return mapped_; }
    /// Makes device writes visible to the host (after the fence) and host writes to the device, on memory that needs
    /// it.
    void invalidate() const;
    void flush() const;
    /// View for samplerBuffer bindings, kept with the buffer. Checked: the element count is within the device's limit.
    VkBufferView texelView(VkFormat format) const;

    AccessState& state() const { return state_; }

private:
    void release();

    Context* context_ = nullptr;
    BufferDesc desc_;
    VkBuffer handle_ = VK_NULL_HANDLE;
    VmaAllocation allocation_ = nullptr;
    void* mapped_ = nullptr;
    mutable std::map<VkFormat, VkBufferView> texelViews_;
    mutable AccessState state_;
};

struct ImageDesc
{
    std::string name = {};
    u32 width = 0;  // texels, > 0
    u32 height = 0; // texels, > 0
    VkFormat format = VK_FORMAT_UNDEFINED;
    u32 layers = 1;              // > 1: 2-D array
    VkImageUsageFlags usage = 0; // 0: a graph derives it from the declared uses; outside of graphs it must be given
};

/// Part of an image as a shader or an attachment sees it.
struct ImagePart
{
    u32 firstLayer = 0;
    u32 layers = 0;     // 0 = all that follow
    bool array = false; // view type 2D_ARRAY even for one layer

    auto operator<=>(const ImagePart&) const = default;
};

/// A 2-D image (one mip level, one sample) with its memory, or a borrowed one (swapchain). Move-only.
class Image
{
public:
    Image() = default;
    /// Fails the process (exit code 2) when the format or size is not supported or memory is short; names the image.
    Image(Context& context, ImageDesc desc);
    /// Wraps an image that somebody else owns; its views are ours.
    static Image borrow(Context& context, VkImage handle, ImageDesc desc);
    ~Image();
    Image(Image&& other) noexcept;
    Image& operator=(Image&& other) noexcept;

    VkImage handle() const { return handle_; }
    const ImageDesc& desc() const { return desc_; }
    bool isDepth() const;
    VkImageAspectFlags aspect() const;
    /// View of a part, kept with the image. Images with several layers are viewed as 2D_ARRAY unless one layer is asked
    /// for.
    VkImageView view(ImagePart part = {}) const;
    /// The contents are gone and whoever writes next must wait for `after` (a swapchain image that was just acquired).
    void forget(VkPipelineStageFlags2 after) const;

    AccessState& state() const { return state_; }

private:
    void release();

    Context* context_ = nullptr;
    ImageDesc desc_;
    VkImage handle_ = VK_NULL_HANDLE;
    VmaAllocation allocation_ = nullptr; // null when borrowed
    mutable std::map<ImagePart, VkImageView> views_;
    mutable AccessState state_;
};

/// Bytes of one texel of the uncompressed formats that we use; 0 for any other format.
u32 texelBytes(VkFormat format);

} // namespace helio
