// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/resources.h"

#include <utility>
#include <vk_mem_alloc.h>

#include "engine/gpu/context.h"
#include "engine/gpu/vk_check.h"

namespace helio {
namespace {

// Drivers have no cost for unused ones, and one kind of buffer keeps every binding legal.
constexpr VkBufferUsageFlags kAllBufferUses =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
    VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
    VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr VkImageUsageFlags kViewableUses = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;

bool isDepthFormat(VkFormat format)
{
    return format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D16_UNORM;
}

} // namespace

Buffer::Buffer(Context& context, BufferDesc desc) : context_(&context), desc_(std::move(desc))
{
    HELIO_CHECK(desc_.bytes > 0, "buffer '", desc_.name, "' has no bytes");
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = desc_.bytes;
    info.usage = kAllBufferUses;
    VmaAllocationCreateInfo memory{};
    memory.usage = VMA_MEMORY_USAGE_AUTO;
    if (desc_.memory != Memory::Device) {
        memory.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT |
                       (desc_.memory == Memory::Upload ? VMA_ALLOCATION_CREATE_HOST_ACCESS_SEQUENTIAL_WRITE_BIT
                                                       : VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT);
    }
    VmaAllocationInfo allocated{};
    vkCheck(vmaCreateBuffer(context.allocator(), &info, &memory, &handle_, &allocation_, &allocated), "buffer '",
            desc_.name, "' of ", desc_.bytes, " bytes");
    mapped_ = desc_.memory == Memory::Device ? nullptr : allocated.pMappedData;
    context.nameObject(VK_OBJECT_TYPE_BUFFER, u64(handle_), desc_.name);
}

Buffer::~Buffer()
{
    release();
}

Buffer::Buffer(Buffer&& other) noexcept
{
    *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept
{
    if (this == &other) return *this;
    release();
    context_ = other.context_;
    desc_ = std::move(other.desc_);
    handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
    allocation_ = std::exchange(other.allocation_, nullptr);
    mapped_ = std::exchange(other.mapped_, nullptr);
    texelViews_ = std::exchange(other.texelViews_, {});
    state_ = std::exchange(other.state_, {});
    return *this;
}

void Buffer::release()
{
    for (const auto& [format, view] : texelViews_) vkDestroyBufferView(context_->device(), view, nullptr);
    texelViews_.clear();
    if (handle_) vmaDestroyBuffer(context_->allocator(), handle_, allocation_);
    handle_ = VK_NULL_HANDLE;
}

void Buffer::invalidate() const
{
    vkCheck(vmaInvalidateAllocation(context_->allocator(), allocation_, 0, VK_WHOLE_SIZE), "invalidating '", desc_.name,
            "'");
}

void Buffer::flush() const
{
    vkCheck(vmaFlushAllocation(context_->allocator(), allocation_, 0, VK_WHOLE_SIZE), "flushing '", desc_.name, "'");
}

VkBufferView Buffer::texelView(VkFormat format) const
{
    if (const auto found = texelViews_.find(format); found != texelViews_.end()) return found->second;
    const u32 texel = texelBytes(format);
    HELIO_CHECK(texel > 0, "buffer '", desc_.name, "': no texel size for format ", int(format));
    const u64 elements = desc_.bytes / texel;
    HELIO_CHECK(context_->texelsFit(elements), "buffer '", desc_.name, "' has ", elements,
                " texels, more than the device's ", context_->facts().maxTexelBufferElements,
                "; use the shader's storage-buffer variant");
    VkBufferViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
    info.buffer = handle_;
    info.format = format;
    info.range = elements * texel;
    VkBufferView view = VK_NULL_HANDLE;
    vkCheck(vkCreateBufferView(context_->device(), &info, nullptr, &view), "texel view of '", desc_.name, "'");
    texelViews_[format] = view;
    return view;
}

Image::Image(Context& context, ImageDesc desc) : context_(&context), desc_(std::move(desc))
{
    const u32 limit = context.facts().maxImageDimension2D;
    HELIO_CHECK(desc_.width > 0 && desc_.height > 0 && desc_.layers > 0, "image '", desc_.name, "' is empty");
    HELIO_CHECK(desc_.width <= limit && desc_.height <= limit && desc_.layers <= context.facts().maxImageArrayLayers,
                "image '", desc_.name, "' of ", desc_.width, "x", desc_.height, "x", desc_.layers,
                " is larger than the device allows (", limit, "x", limit, "x", context.facts().maxImageArrayLayers,
                ")");
    HELIO_CHECK(desc_.usage != 0, "image '", desc_.name, "' has no usage");
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc_.format;
    info.extent = {desc_.width, desc_.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = desc_.layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = desc_.usage;
    VmaAllocationCreateInfo memory{};
    memory.usage = VMA_MEMORY_USAGE_AUTO;
    vkCheck(vmaCreateImage(context.allocator(), &info, &memory, &handle_, &allocation_, nullptr), "image '", desc_.name,
            "' of ", desc_.width, "x", desc_.height, "x", desc_.layers, ", format ", int(desc_.format));
    context.nameObject(VK_OBJECT_TYPE_IMAGE, u64(handle_), desc_.name);
}

Image Image::borrow(Context& context, VkImage handle, ImageDesc desc)
{
    Image image;
    image.context_ = &context;
    image.desc_ = std::move(desc);
    image.handle_ = handle;
    context.nameObject(VK_OBJECT_TYPE_IMAGE, u64(handle), image.desc_.name);
    return image;
}

Image::~Image()
{
    release();
}

Image::Image(Image&& other) noexcept
{
    *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept
{
    if (this == &other) return *this;
    release();
    context_ = other.context_;
    desc_ = std::move(other.desc_);
    handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
    allocation_ = std::exchange(other.allocation_, nullptr);
    views_ = std::exchange(other.views_, {});
    state_ = std::exchange(other.state_, {});
    return *this;
}

void Image::release()
{
    for (const auto& [part, view] : views_) vkDestroyImageView(context_->device(), view, nullptr);
    views_.clear();
    if (handle_ && allocation_) vmaDestroyImage(context_->allocator(), handle_, allocation_);
    handle_ = VK_NULL_HANDLE;
}

bool Image::isDepth() const
{
    return isDepthFormat(desc_.format);
}

VkImageAspectFlags Image::aspect() const
{
    return isDepth() ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImageView Image::view(ImagePart part) const
{
    if (part.layers == 0) part.layers = desc_.layers - part.firstLayer;
    HELIO_CHECK(part.layers > 0 && part.firstLayer + part.layers <= desc_.layers, "image '", desc_.name, "' has ",
                desc_.layers, " layers, asked for ", part.firstLayer, " and ", part.layers, " more");
    part.array = part.array || part.layers > 1;
    if (const auto found = views_.find(part); found != views_.end()) return found->second;
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = handle_;
    info.viewType = part.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    info.format = desc_.format;
    info.subresourceRange = {aspect(), 0, 1, part.firstLayer, part.layers};
    VkImageViewUsageCreateInfo usage{};
    usage.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_USAGE_CREATE_INFO;
    usage.usage = desc_.usage & kViewableUses;
    info.pNext = &usage;
    VkImageView view = VK_NULL_HANDLE;
    vkCheck(vkCreateImageView(context_->device(), &info, nullptr, &view), "view of image '", desc_.name, "'");
    views_[part] = view;
    return view;
}

void Image::forget(VkPipelineStageFlags2 after) const
{
    state_ = {};
    state_.writeStages = after;
}

u32 texelBytes(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R8_UNORM:
        return 1;
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R16_UINT:
    case VK_FORMAT_D16_UNORM:
        return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SINT:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT:
        return 4;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UINT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SFLOAT:
        return 8;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return 16;
    default:
        return 0;
    }
}

} // namespace helio
