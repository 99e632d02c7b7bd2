// SPDX-License-Identifier: Apache-2.0
#include "engine/graph/pass_context.h"

#include <algorithm>

#include "engine/graph/frame_graph_impl.h"

namespace helio {

Binding storage(u32 binding, Ref<Buffer> buffer, u64 offset, u64 bytes)
{
    Binding result{{}, buffer};
    result.how.binding = binding;
    result.how.offset = offset;
    result.how.bytes = bytes;
    return result;
}

Binding texels(u32 binding, Ref<Buffer> buffer, VkFormat format)
{
    Binding result{{}, buffer};
    result.how.binding = binding;
    result.how.format = format;
    return result;
}

Binding storage(u32 binding, Ref<Image> image, ImagePart part)
{
    Binding result{{}, image};
    result.how.binding = binding;
    result.how.part = part;
    return result;
}

Binding sampled(u32 binding, Ref<Image> image, Sampler sampler, ImagePart part)
{
    Binding result{{}, image};
    result.how.binding = binding;
    result.how.sampler = sampler;
    result.how.part = part;
    return result;
}

Context& PassContext::context() const
{
    return recorder_.context();
}

bool PassContext::declares(u32 resource, std::initializer_list<Use> uses) const
{
    const auto& declared = graph_.impl_->passes[pass_].uses;
    return std::any_of(declared.begin(), declared.end(), [&](const auto& d) {
        return d.resource == resource && (uses.size() == 0 || std::find(uses.begin(), uses.end(), d.use) != uses.end());
    });
}

void PassContext::checkDeclared(u32 resource, std::initializer_list<Use> uses) const
{
    const FrameGraph::Impl& impl = *graph_.impl_;
    HELIO_CHECK(resource < impl.resources.size(), "pass '", impl.passes[pass_].name, "' uses an unknown reference");
    HELIO_CHECK(declares(resource, uses), "pass '", impl.passes[pass_].name, "' uses '", impl.resources[resource].name,
                "' without declaring it", uses.size() ? concat(" as ", useInfo(*uses.begin()).name) : std::string());
}

const Buffer& PassContext::buffer(Ref<Buffer> ref) const
{
    checkDeclared(ref.index, {});
    return graph_.buffer(ref);
}

const Image& PassContext::image(Ref<Image> ref) const
{
    checkDeclared(ref.index, {});
    return graph_.image(ref);
}

std::vector<Bound> PassContext::resolve(std::span<const Binding> bindings) const
{
    std::vector<Bound> bounds;
    for (const Binding& binding : bindings) {
        Bound bound = binding.how;
        if (const auto* asBuffer = std::get_if<Ref<Buffer>>(&binding.what))
            bound.buffer = &buffer(*asBuffer);
        else
            bound.image = &image(std::get<Ref<Image>>(binding.what));
        bounds.push_back(bound);
    }
    return bounds;
}

void PassContext::dispatchBytes(const ShaderCode& shader, std::span<const Binding> bindings,
                                std::span<const std::byte> params, Groups groups, std::vector<SpecConstant> constants)
{
    const u32 limit = context().facts().maxDispatchGroups;
    HELIO_CHECK(groups.x <= limit, "'", shader.name, "' dispatches ", groups.x, " groups in x, the device allows ",
                limit);
    const Pipeline& pipeline = context().pipelines().compute({&shader, std::move(constants)});
    recorder_.bind(pipeline, resolve(bindings));
    recorder_.push(pipeline, params);
    vkCmdDispatch(commands(), groups.x, groups.y, groups.z);
}

void PassContext::barrier()
{
    constexpr VkPipelineStageFlags2 kStages =
        VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
    constexpr VkAccessFlags2 kReads =
        VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT;
    recorder_.barrier(kStages, kWrites, kStages, kReads | kWrites);
}

void PassContext::fill(Ref<Buffer> ref, u32 value)
{
    checkDeclared(ref.index, {Use::CopyTo});
    vkCmdFillBuffer(commands(), graph_.buffer(ref).handle(), 0, VK_WHOLE_SIZE, value);
}

void PassContext::copy(Ref<Buffer> from, Ref<Buffer> to, u64 bytes, u64 fromOffset, u64 toOffset)
{
    checkDeclared(from.index, {Use::CopyFrom});
    checkDeclared(to.index, {Use::CopyTo});
    const Buffer& source = graph_.buffer(from);
    const Buffer& target = graph_.buffer(to);
    if (bytes == 0) bytes = std::min(source.bytes() - fromOffset, target.bytes() - toOffset);
    HELIO_CHECK(fromOffset + bytes <= source.bytes() && toOffset + bytes <= target.bytes(), bytes, " bytes from '",
                source.desc().name, "' to '", target.desc().name, "'");
    const VkBufferCopy region{fromOffset, toOffset, bytes};
    vkCmdCopyBuffer(commands(), source.handle(), target.handle(), 1, &region);
}

void PassContext::copy(Ref<Image> from, u32 layer, Ref<Buffer> to, u64 toOffset)
{
    checkDeclared(from.index, {Use::CopyFrom});
    checkDeclared(to.index, {Use::CopyTo});
    const Image& source = graph_.image(from);
    const Buffer& target = graph_.buffer(to);
    const ImageDesc& desc = source.desc();
    const u64 bytes = u64(desc.width) * desc.height * texelBytes(desc.format);
    HELIO_CHECK(layer < desc.layers && toOffset + bytes <= target.bytes(), "layer ", layer, " of '", desc.name, "' (",
                bytes, " bytes) at ", toOffset, " of '", target.desc().name, "'");
    VkBufferImageCopy region{};
    region.bufferOffset = toOffset;
    region.imageSubresource = {source.aspect(), 0, layer, 1};
    region.imageExtent = {desc.width, desc.height, 1};
    vkCmdCopyImageToBuffer(commands(), source.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.handle(), 1,
                           &region);
}

Ref<Buffer> addFill(FrameGraph& graph, Ref<Buffer> buffer, u32 value)
{
    return graph.addPass("fill", [&](PassBuilder& pass) {
        const Ref<Buffer> filled = pass.write(buffer, Use::CopyTo);
        pass.record([=](PassContext& ctx) { ctx.fill(filled, value); });
        return filled;
    });
}

void addReadback(FrameGraph& graph, Ref<Buffer> from, const Buffer& host)
{
    graph.addPass("read back", [&](PassBuilder& pass) {
        pass.read(from, Use::CopyFrom);
        const Ref<Buffer> to = pass.write(pass.import(host), Use::CopyTo);
        pass.record([=](PassContext& ctx) { ctx.copy(from, to); });
        graph.leave(to, Use::HostRead);
    });
}

void addReadback(FrameGraph& graph, Ref<Image> from, u32 layer, const Buffer& host)
{
    graph.addPass("read back", [&](PassBuilder& pass) {
        pass.read(from, Use::CopyFrom);
        const Ref<Buffer> to = pass.write(pass.import(host), Use::CopyTo);
        pass.record([=](PassContext& ctx) { ctx.copy(from, layer, to); });
        graph.leave(to, Use::HostRead);
    });
}

} // namespace helio
