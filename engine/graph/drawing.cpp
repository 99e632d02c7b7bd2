// SPDX-License-Identifier: Apache-2.0
#include "engine/graph/pass_context.h"

namespace helio {
namespace {

VkRenderingAttachmentInfo attachmentInfo(VkImageView view, VkImageLayout layout, VkAttachmentLoadOp load,
                                         VkAttachmentStoreOp store)
{
    VkRenderingAttachmentInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    info.imageView = view;
    info.imageLayout = layout;
    info.loadOp = load;
    info.storeOp = store;
    return info;
}

} // namespace

void PassContext::render(const RenderTargets& targets, const std::function<void(Drawing&)>& body)
{
    HELIO_CHECK(!targets.colors.empty() || targets.depth, "rendering without targets");
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const ColorAttachment& target : targets.colors) {
        checkDeclared(target.image.index, {Use::ColorTarget, Use::ColorTargetLoad});
        HELIO_CHECK(target.clear || declares(target.image.index, {Use::ColorTargetLoad}), "'",
                    image(target.image).desc().name, "' is neither cleared nor declared ColorTargetLoad");
        colors.push_back(attachmentInfo(
            image(target.image).view({target.layer, 1, false}), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
            target.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE));
        if (target.clear) colors.back().clearValue.color = *target.clear;
    }
    VkRenderingAttachmentInfo depth{};
    if (targets.depth) {
        const u32 index = targets.depth->image.index;
        const Image& texture = image(targets.depth->image);
        const bool writes = declares(index, {Use::DepthTarget, Use::DepthTargetLoad});
        checkDeclared(index, {Use::DepthTarget, Use::DepthTargetLoad, Use::DepthTest});
        HELIO_CHECK(targets.depth->clear ? writes : !declares(index, {Use::DepthTarget}), "'", texture.desc().name,
                    "': a cleared depth target is declared DepthTarget, a kept one DepthTargetLoad or DepthTest");
        depth =
            attachmentInfo(texture.view({targets.depth->layer, 1, false}),
                           writes ? VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL,
                           targets.depth->clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD,
                           writes ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_NONE);
        if (targets.depth->clear) depth.clearValue.depthStencil = {*targets.depth->clear, 0};
    }
    const ImageDesc& first = image(targets.colors.empty() ? targets.depth->image : targets.colors[0].image).desc();
    const u32 width = targets.width ? targets.width : first.width;
    const u32 height = targets.height ? targets.height : first.height;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea = {{i32(targets.x), i32(targets.y)}, {width, height}};
    info.layerCount = 1;
    info.colorAttachmentCount = u32(colors.size());
    info.pColorAttachments = colors.data();
    info.pDepthAttachment = targets.depth ? &depth : nullptr;
    vkCmdBeginRendering(commands(), &info);
    // A negative height turns clip-space +y up.
    const VkViewport viewport{float(targets.x), float(targets.y + height), float(width), -float(height), 0.0f, 1.0f};
    vkCmdSetViewport(commands(), 0, 1, &viewport);
    vkCmdSetScissor(commands(), 0, 1, &info.renderArea);
    Drawing drawing(*this, targets);
    body(drawing);
    vkCmdEndRendering(commands());
}

void Drawing::pipeline(GraphicsPipelineDesc desc)
{
    desc.colors.clear();
    for (const ColorAttachment& target : targets_.colors)
        desc.colors.push_back(context_.image(target.image).desc().format);
    desc.depth = targets_.depth ? context_.image(targets_.depth->image).desc().format : VK_FORMAT_UNDEFINED;
    pipeline_ = &context_.context().pipelines().graphics(desc);
    if (pipeline_->bindings.empty()) context_.recorder().bind(*pipeline_, {});
}

void Drawing::bind(std::span<const Binding> bindings)
{
    HELIO_CHECK(pipeline_, "resources are bound before a pipeline");
    context_.recorder().bind(*pipeline_, context_.resolve(bindings));
}

void Drawing::pushBytes(std::span<const std::byte> bytes)
{
    HELIO_CHECK(pipeline_, "constants are pushed before a pipeline");
    context_.recorder().push(*pipeline_, bytes);
}

void Drawing::vertices(u32 slot, Ref<Buffer> buffer, u64 offset)
{
    context_.checkDeclared(buffer.index, {Use::VertexAttribute});
    const VkBuffer handle = context_.buffer(buffer).handle();
    vkCmdBindVertexBuffers(context_.commands(), slot, 1, &handle, &offset);
}

void Drawing::indices(Ref<Buffer> buffer, u64 offset)
{
    context_.checkDeclared(buffer.index, {Use::Index});
    vkCmdBindIndexBuffer(context_.commands(), context_.buffer(buffer).handle(), offset, VK_INDEX_TYPE_UINT32);
}

void Drawing::depthBias(float constant, float slope)
{
    vkCmdSetDepthBias(context_.commands(), constant, 0.0f, slope);
}

void Drawing::scissor(u32 x, u32 y, u32 width, u32 height)
{
    const VkRect2D area{{i32(x), i32(y)}, {width, height}};
    vkCmdSetScissor(context_.commands(), 0, 1, &area);
}

void Drawing::draw(u32 vertexCount, u32 instanceCount, u32 firstVertex, u32 firstInstance)
{
    vkCmdDraw(context_.commands(), vertexCount, instanceCount, firstVertex, firstInstance);
}

void Drawing::drawIndexed(u32 indexCount, u32 instanceCount, u32 firstIndex, i32 vertexOffset, u32 firstInstance)
{
    vkCmdDrawIndexed(context_.commands(), indexCount, instanceCount, firstIndex, vertexOffset, firstInstance);
}

void Drawing::drawIndexedIndirect(Ref<Buffer> arguments, u64 offset, u32 count)
{
    context_.checkDeclared(arguments.index, {Use::Indirect});
    constexpr u32 kStride = sizeof(VkDrawIndexedIndirectCommand);
    const Buffer& buffer = context_.buffer(arguments);
    HELIO_CHECK(offset + u64(count) * kStride <= buffer.bytes(), count, " draws at ", offset, " of '",
                buffer.desc().name, "'");
    const bool multi = context_.context().facts().multiDrawIndirect;
    const u32 calls = multi ? 1 : count;
    for (u32 i = 0; i < calls; ++i) {
        vkCmdDrawIndexedIndirect(context_.commands(), buffer.handle(), offset + u64(i) * kStride, multi ? count : 1,
                                 kStride);
    }
}

} // namespace helio
