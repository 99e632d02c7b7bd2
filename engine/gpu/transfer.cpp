// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/transfer.h"

#include <algorithm>

#include "engine/gpu/recorder.h"

namespace helio {
namespace {

constexpr u64 kStagingBytes = u64(32) << 20;

/// Waits for everything before: transfers outside of graphs are rare and must be right in any state of the resource.
void fullBarrier(Recorder& recorder)
{
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                     VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

void noteCopyTo(AccessState& state, VkImageLayout layout)
{
    state = {};
    state.writeStages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    state.writeAccess = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    state.layout = layout;
    state.defined = true;
}

/// Changes the layout of all layers; everything before is waited for, everything after waits.
void changeLayout(Recorder& recorder, const Image& image, VkImageLayout from, VkImageLayout to)
{
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {image.aspect(), 0, 1, 0, image.desc().layers};
    recorder.barriers({}, std::span(&barrier, 1));
}

u64 layerBytes(const Image& image)
{
    const u32 texel = texelBytes(image.desc().format);
    HELIO_CHECK(texel > 0, "image '", image.desc().name, "': no texel size for format ", int(image.desc().format));
    return u64(image.desc().width) * image.desc().height * texel;
}

VkBufferImageCopy layerCopy(const Image& image, u32 layer)
{
    HELIO_CHECK(layer < image.desc().layers, "image '", image.desc().name, "' has no layer ", layer);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {image.aspect(), 0, layer, 1};
    copy.imageExtent = {image.desc().width, image.desc().height, 1};
    return copy;
}

} // namespace

void upload(Context& context, const Buffer& to, std::span<const std::byte> bytes, u64 offset)
{
    HELIO_CHECK(offset + bytes.size() <= to.bytes(), bytes.size(), " bytes at ", offset, " do not fit into '",
                to.desc().name, "' of ", to.bytes());
    if (bytes.empty()) return;
    const Buffer staging(context, {"staging", std::min<u64>(bytes.size(), kStagingBytes), Memory::Upload});
    Recorder recorder(context);
    for (u64 at = 0; at < bytes.size(); at += kStagingBytes) {
        const u64 part = std::min<u64>(kStagingBytes, bytes.size() - at);
        std::memcpy(staging.mapped(), bytes.data() + at, part);
        staging.flush();
        recorder.begin();
        fullBarrier(recorder);
        const VkBufferCopy copy{0, offset + at, part};
        vkCmdCopyBuffer(recorder.commands(), staging.handle(), to.handle(), 1, &copy);
        recorder.submitAndWait();
    }
    noteCopyTo(to.state(), VK_IMAGE_LAYOUT_UNDEFINED);
}

void uploadImage(Context& context, const Image& to, std::span<const std::byte> texels, u32 layer)
{
    HELIO_CHECK(texels.size() == layerBytes(to), texels.size(), " bytes for a layer of ", layerBytes(to), " of image '",
                to.desc().name, "'");
    const Buffer staging(context, {"staging", texels.size(), Memory::Upload});
    std::memcpy(staging.mapped(), texels.data(), texels.size());
    staging.flush();
    Recorder recorder(context);
    recorder.begin();
    changeLayout(recorder, to, to.state().layout, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkBufferImageCopy copy = layerCopy(to, layer);
    vkCmdCopyBufferToImage(recorder.commands(), staging.handle(), to.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &copy);
    recorder.submitAndWait();
    noteCopyTo(to.state(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
}

std::vector<std::byte> download(Context& context, const Buffer& from, u64 offset, u64 size)
{
    if (size == 0) size = from.bytes() - offset;
    HELIO_CHECK(offset + size <= from.bytes(), size, " bytes at ", offset, " of '", from.desc().name, "', which has ",
                from.bytes());
    context.waitIdle();
    std::vector<std::byte> bytes(size);
    const Buffer staging(context, {"staging", std::min<u64>(size, kStagingBytes), Memory::Readback});
    Recorder recorder(context);
    for (u64 at = 0; at < size; at += kStagingBytes) {
        const u64 part = std::min<u64>(kStagingBytes, size - at);
        recorder.begin();
        fullBarrier(recorder);
        const VkBufferCopy copy{offset + at, 0, part};
        vkCmdCopyBuffer(recorder.commands(), from.handle(), staging.handle(), 1, &copy);
        recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                         VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
        recorder.submitAndWait();
        staging.invalidate();
        std::memcpy(bytes.data() + at, staging.mapped(), part);
    }
    from.state().readStages |= VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    from.state().readAccess |= VK_ACCESS_2_TRANSFER_READ_BIT;
    return bytes;
}

std::vector<std::byte> downloadImage(Context& context, const Image& from, u32 layer)
{
    HELIO_CHECK(from.state().layout != VK_IMAGE_LAYOUT_UNDEFINED, "image '", from.desc().name, "' was never written");
    context.waitIdle();
    std::vector<std::byte> texels(layerBytes(from));
    const Buffer staging(context, {"staging", texels.size(), Memory::Readback});
    Recorder recorder(context);
    recorder.begin();
    const VkImageLayout layout = from.state().layout;
    changeLayout(recorder, from, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    const VkBufferImageCopy copy = layerCopy(from, layer);
    vkCmdCopyImageToBuffer(recorder.commands(), from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.handle(),
                           1, &copy);
    changeLayout(recorder, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                     VK_ACCESS_2_HOST_READ_BIT);
    recorder.submitAndWait();
    staging.invalidate();
    std::memcpy(texels.data(), staging.mapped(), texels.size());
    // The last barrier let everything after wait for everything before.
    from.state().writeStages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    from.state().writeAccess = VK_ACCESS_2_MEMORY_WRITE_BIT;
    from.state().readStages = VK_PIPELINE_STAGE_2_NONE;
    from.state().readAccess = VK_ACCESS_2_NONE;
    return texels;
}

} // namespace helio
