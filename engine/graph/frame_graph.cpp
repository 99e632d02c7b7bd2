// SPDX-License-Identifier: Apache-2.0
#include "engine/graph/frame_graph.h"

#include <algorithm>

#include "engine/gpu/vk_check.h"
#include "engine/graph/frame_graph_impl.h"
#include "engine/graph/pass_context.h"

namespace helio {
namespace {

/// The barriers of one pass in Vulkan's form, recorded.
void recordBarriers(Recorder& recorder, const std::vector<Barrier>& barriers,
                    const std::function<VkBuffer(u32)>& bufferOf, const std::function<const Image&(u32)>& imageOf)
{
    std::vector<VkBufferMemoryBarrier2> buffers;
    std::vector<VkImageMemoryBarrier2> images;
    for (const Barrier& barrier : barriers) {
        if (barrier.image) {
            const Image& image = imageOf(barrier.resource);
            VkImageMemoryBarrier2 info{};
            info.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
            info.srcStageMask = barrier.srcStages;
            info.srcAccessMask = barrier.srcAccess;
            info.dstStageMask = barrier.dstStages;
            info.dstAccessMask = barrier.dstAccess;
            info.oldLayout = barrier.oldLayout;
            info.newLayout = barrier.newLayout;
            info.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            info.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            info.image = image.handle();
            info.subresourceRange = {image.aspect(), 0, 1, 0, image.desc().layers};
            images.push_back(info);
        } else {
            VkBufferMemoryBarrier2 info{};
            info.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2;
            info.srcStageMask = barrier.srcStages;
            info.srcAccessMask = barrier.srcAccess;
            info.dstStageMask = barrier.dstStages;
            info.dstAccessMask = barrier.dstAccess;
            info.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            info.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            info.buffer = bufferOf(barrier.resource);
            info.size = VK_WHOLE_SIZE;
            buffers.push_back(info);
        }
    }
    recorder.barriers(buffers, images);
}

} // namespace

Ref<Buffer> PassBuilder::create(BufferDesc desc)
{
    FrameGraph::Impl::Resource resource;
    resource.name = desc.name;
    resource.bufferDesc = std::move(desc);
    return {graph_.impl_->addResource(std::move(resource)), 0};
}

Ref<Image> PassBuilder::create(ImageDesc desc)
{
    FrameGraph::Impl::Resource resource;
    resource.name = desc.name;
    resource.image = true;
    resource.imageDesc = std::move(desc);
    return {graph_.impl_->addResource(std::move(resource)), 0};
}

Ref<Buffer> PassBuilder::import(const Buffer& buffer)
{
    return graph_.import(buffer);
}

Ref<Image> PassBuilder::import(const Image& image)
{
    return graph_.import(image);
}

Ref<Buffer> PassBuilder::read(Ref<Buffer> ref, Use use)
{
    graph_.impl_->declareRead(pass_, ref.index, ref.version, false, use);
    return ref;
}

Ref<Image> PassBuilder::read(Ref<Image> ref, Use use)
{
    graph_.impl_->declareRead(pass_, ref.index, ref.version, true, use);
    return ref;
}

Ref<Buffer> PassBuilder::write(Ref<Buffer> ref, Use use)
{
    return {ref.index, graph_.impl_->declareWrite(pass_, ref.index, ref.version, false, use)};
}

Ref<Image> PassBuilder::write(Ref<Image> ref, Use use)
{
    return {ref.index, graph_.impl_->declareWrite(pass_, ref.index, ref.version, true, use)};
}

void PassBuilder::sideEffect()
{
    graph_.impl_->passes[pass_].sideEffect = true;
}

void PassBuilder::record(std::function<void(PassContext&)> body)
{
    graph_.impl_->passes[pass_].body = std::move(body);
}

FrameGraph::FrameGraph(std::string name) : impl_(std::make_unique<Impl>())
{
    impl_->name = std::move(name);
}

FrameGraph::~FrameGraph() = default;
FrameGraph::FrameGraph(FrameGraph&&) noexcept = default;
FrameGraph& FrameGraph::operator=(FrameGraph&&) noexcept = default;

u32 FrameGraph::openPass(std::string name)
{
    HELIO_CHECK(!impl_->compiled, "graph '", impl_->name, "' is compiled: pass '", name, "' comes too late");
    impl_->passes.emplace_back().name = std::move(name);
    return u32(impl_->passes.size()) - 1;
}

Ref<Buffer> FrameGraph::import(const Buffer& buffer)
{
    for (u32 i = 0; i < impl_->resources.size(); ++i) {
        if (impl_->resources[i].buffer == &buffer) return {i, impl_->resources[i].newestVersion()};
    }
    Impl::Resource resource;
    resource.name = buffer.desc().name;
    resource.imported = true;
    resource.bufferDesc = buffer.desc();
    resource.buffer = &buffer;
    return {impl_->addResource(std::move(resource)), 0};
}

Ref<Image> FrameGraph::import(const Image& image)
{
    for (u32 i = 0; i < impl_->resources.size(); ++i) {
        if (impl_->resources[i].texture == &image) return {i, impl_->resources[i].newestVersion()};
    }
    Impl::Resource resource;
    resource.name = image.desc().name;
    resource.image = true;
    resource.imported = true;
    resource.imageDesc = image.desc();
    resource.texture = &image;
    return {impl_->addResource(std::move(resource)), 0};
}

void FrameGraph::rebind(Ref<Image> imported, const Image& image)
{
    HELIO_CHECK(imported.index < impl_->resources.size(), imported.index);
    Impl::Resource& resource = impl_->resources[imported.index];
    HELIO_CHECK(resource.image && resource.imported, "'", resource.name, "' is not an imported image");
    HELIO_CHECK(image.desc().format == resource.imageDesc.format && image.desc().width == resource.imageDesc.width &&
                    image.desc().height == resource.imageDesc.height &&
                    image.desc().layers == resource.imageDesc.layers,
                "'", image.desc().name, "' differs from '", resource.name, "' in format or size");
    resource.texture = &image;
}

void FrameGraph::leave(Ref<Buffer> ref, Use use)
{
    impl_->declareFinal(ref.index, ref.version, false, use);
}

void FrameGraph::leave(Ref<Image> ref, Use use)
{
    impl_->declareFinal(ref.index, ref.version, true, use);
}

Result<GraphPlan> FrameGraph::plan() const
{
    return impl_->makePlan();
}

Status FrameGraph::compile(Context& context)
{
    HELIO_CHECK(!impl_->compiled, "graph '", impl_->name, "' is compiled already");
    Result<GraphPlan> plan = impl_->makePlan();
    if (!plan) return Error{concat("graph '", impl_->name, "': ", plan.error().message)};
    std::vector<bool> touched(impl_->resources.size(), false);
    for (const auto& accesses : plan->accesses) {
        for (const Access& access : accesses) touched[access.resource] = true;
    }
    for (u32 i = 0; i < impl_->resources.size(); ++i) {
        Impl::Resource& resource = impl_->resources[i];
        if (!touched[i]) continue;
        if (resource.imported) {
            if (resource.image && (plan->imageUsages[i] & ~resource.imageDesc.usage) != 0) {
                return Error{concat("graph '", impl_->name, "': image '", resource.name, "' was made with usage ",
                                    resource.imageDesc.usage, ", its passes need ", plan->imageUsages[i])};
            }
            continue;
        }
        if (resource.image) {
            // TRANSFER_SRC costs nothing and lets every result be downloaded.
            resource.imageDesc.usage |= plan->imageUsages[i] | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
            impl_->ownImages.push_back(std::make_unique<Image>(context, resource.imageDesc));
            resource.texture = impl_->ownImages.back().get();
        } else {
            impl_->ownBuffers.push_back(std::make_unique<Buffer>(context, resource.bufferDesc));
            resource.buffer = impl_->ownBuffers.back().get();
        }
    }
    impl_->compiled = std::move(*plan);
    impl_->note = std::make_shared<const std::string>(dump());
    return Nothing{};
}

void FrameGraph::execute(Recorder& recorder, bool timings)
{
    HELIO_CHECK(impl_->compiled, "graph '", impl_->name, "' is not compiled");
    const GraphPlan& plan = *impl_->compiled;
    setFailureNote(impl_->note);

    std::vector<AccessState> states(impl_->resources.size());
    std::vector<bool> touched(impl_->resources.size(), false);
    for (size_t i = 0; i < plan.accesses.size(); ++i) {
        for (const Access& access : plan.accesses[i]) {
            if (touched[access.resource]) continue;
            touched[access.resource] = true;
            const Impl::Resource& resource = impl_->resources[access.resource];
            AccessState& state = states[access.resource];
            state = resource.state();
            const bool hostWritten = !resource.image && resource.bufferDesc.memory == Memory::Upload;
            HELIO_CHECK(access.writes != 0 || state.defined || hostWritten, "graph '", impl_->name, "' reads '",
                        resource.name, "', which nobody has written yet");
        }
    }
    const std::vector<std::vector<Barrier>> barriers = deriveBarriers(states, plan.accesses);
    const auto bufferOf = [&](u32 resource) { return impl_->resources[resource].buffer->handle(); };
    const auto imageOf = [&](u32 resource) -> const Image& { return *impl_->resources[resource].texture; };

    if (timings) recorder.mark("");
    for (size_t i = 0; i < plan.passes.size(); ++i) {
        const Impl::Pass& pass = impl_->passes[plan.passes[i]];
        recordBarriers(recorder, barriers[i], bufferOf, imageOf);
        if (timings && barriers[i].empty()) {
            // Tiled software drivers bill a timestamp to the work that is still being binned: only a barrier ends that.
            recorder.barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE,
                             VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE);
        }
        recorder.beginLabel(pass.name);
        PassContext context(*this, plan.passes[i], recorder);
        pass.body(context);
        recorder.endLabel();
        if (timings) recorder.mark(pass.name);
    }
    recordBarriers(recorder, barriers.back(), bufferOf, imageOf);
    for (u32 i = 0; i < states.size(); ++i) {
        if (touched[i]) impl_->resources[i].state() = states[i];
    }
}

const Buffer& FrameGraph::buffer(Ref<Buffer> ref) const
{
    HELIO_CHECK(ref.index < impl_->resources.size() && !impl_->resources[ref.index].image, ref.index);
    const Impl::Resource& resource = impl_->resources[ref.index];
    HELIO_CHECK(resource.buffer, "buffer '", resource.name,
                "' is not allocated: the graph is not compiled, or no live pass uses it");
    return *resource.buffer;
}

const Image& FrameGraph::image(Ref<Image> ref) const
{
    HELIO_CHECK(ref.index < impl_->resources.size() && impl_->resources[ref.index].image, ref.index);
    const Impl::Resource& resource = impl_->resources[ref.index];
    HELIO_CHECK(resource.texture, "image '", resource.name,
                "' is not allocated: the graph is not compiled, or no live pass uses it");
    return *resource.texture;
}

} // namespace helio
