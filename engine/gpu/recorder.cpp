// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/recorder.h"

#include <algorithm>

#include "engine/gpu/vk_check.h"

namespace helio {
namespace {

constexpr u32 kMaxMarks = 512; // stretches of one submission; more are not timed
constexpr u32 kSetsPerPool = 256;
constexpr u32 kMaxGroupsX = 65535; // what every device has

} // namespace

Groups groupsFor(u64 items, u32 groupSize)
{
    const u64 groups = std::max<u64>(1, (items + groupSize - 1) / groupSize);
    if (groups <= kMaxGroupsX) return {u32(groups), 1, 1};
    const u64 rows = (groups + kMaxGroupsX - 1) / kMaxGroupsX;
    HELIO_CHECK(rows <= kMaxGroupsX, items, " items in groups of ", groupSize);
    return {u32((groups + rows - 1) / rows), u32(rows), 1};
}

Groups groupsFor2D(u32 width, u32 height, u32 tileWidth, u32 tileHeight)
{
    return {(width + tileWidth - 1) / tileWidth, (height + tileHeight - 1) / tileHeight, 1};
}

Recorder::Recorder(Context& context) : context_(context)
{
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.queueFamilyIndex = context.queueFamily();
    vkCheck(vkCreateCommandPool(context.device(), &pool, nullptr, &pool_), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo buffer{};
    buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffer.commandPool = pool_;
    buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer.commandBufferCount = 1;
    vkCheck(vkAllocateCommandBuffers(context.device(), &buffer, &commands_), "vkAllocateCommandBuffers");
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    vkCheck(vkCreateFence(context.device(), &fence, nullptr, &fence_), "vkCreateFence");
    if (context.facts().timestampPeriodNs > 0) {
        VkQueryPoolCreateInfo queries{};
        queries.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
        queries.queryCount = kMaxMarks;
        vkCheck(vkCreateQueryPool(context.device(), &queries, nullptr, &queries_), "vkCreateQueryPool");
    }
    if (context.validating()) {
        beginLabel_ = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
            vkGetInstanceProcAddr(context.instance(), "vkCmdBeginDebugUtilsLabelEXT"));
        endLabel_ = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
            vkGetInstanceProcAddr(context.instance(), "vkCmdEndDebugUtilsLabelEXT"));
    }
}

Recorder::~Recorder()
{
    wait();
    const VkDevice device = context_.device();
    for (const VkDescriptorPool pool : descriptorPools_) vkDestroyDescriptorPool(device, pool, nullptr);
    vkDestroyQueryPool(device, queries_, nullptr);
    vkDestroyFence(device, fence_, nullptr);
    vkDestroyCommandPool(device, pool_, nullptr);
}

void Recorder::begin()
{
    wait();
    const VkDevice device = context_.device();
    vkCheck(vkResetCommandPool(device, pool_, 0), "vkResetCommandPool");
    for (const VkDescriptorPool pool : descriptorPools_)
        vkCheck(vkResetDescriptorPool(device, pool, 0), "vkResetDescriptorPool");
    usedPools_ = 0;
    marks_.clear();
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    vkCheck(vkBeginCommandBuffer(commands_, &info), "vkBeginCommandBuffer");
    if (queries_) vkCmdResetQueryPool(commands_, queries_, 0, kMaxMarks);
}

void Recorder::submit(VkSemaphore waitFor, VkSemaphore signal)
{
    vkCheck(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
    VkCommandBufferSubmitInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    commands.commandBuffer = commands_;
    VkSemaphoreSubmitInfo waitInfo{};
    waitInfo.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
    waitInfo.semaphore = waitFor;
    waitInfo.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSemaphoreSubmitInfo signalInfo = waitInfo;
    signalInfo.semaphore = signal;
    VkSubmitInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    info.waitSemaphoreInfoCount = waitFor ? 1 : 0;
    info.pWaitSemaphoreInfos = &waitInfo;
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &commands;
    info.signalSemaphoreInfoCount = signal ? 1 : 0;
    info.pSignalSemaphoreInfos = &signalInfo;
    vkCheck(vkQueueSubmit2(context_.queue(), 1, &info, fence_), "vkQueueSubmit2");
    submitted_ = true;
}

void Recorder::wait()
{
    if (!submitted_) return;
    vkCheck(vkWaitForFences(context_.device(), 1, &fence_, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    vkCheck(vkResetFences(context_.device(), 1, &fence_), "vkResetFences");
    submitted_ = false;
}

VkDescriptorSet Recorder::allocateSet(VkDescriptorSetLayout layout)
{
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    for (; usedPools_ < descriptorPools_.size(); ++usedPools_) {
        info.descriptorPool = descriptorPools_[usedPools_];
        const VkResult result = vkAllocateDescriptorSets(context_.device(), &info, &set);
        if (result == VK_SUCCESS) return set;
        if (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL)
            vkCheck(result, "descriptor set");
    }
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kSetsPerPool * 8},
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kSetsPerPool * 8},
        {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, kSetsPerPool * 8},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kSetsPerPool * 4},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kSetsPerPool * 4},
    };
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = kSetsPerPool;
    pool.poolSizeCount = u32(std::size(sizes));
    pool.pPoolSizes = sizes;
    vkCheck(vkCreateDescriptorPool(context_.device(), &pool, nullptr, &info.descriptorPool), "vkCreateDescriptorPool");
    descriptorPools_.push_back(info.descriptorPool);
    vkCheck(vkAllocateDescriptorSets(context_.device(), &info, &set), "vkAllocateDescriptorSets");
    return set;
}

void Recorder::bind(const Pipeline& pipeline, std::span<const Bound> bounds)
{
    vkCmdBindPipeline(commands_, pipeline.bindPoint, pipeline.handle);
    HELIO_CHECK(bounds.size() == pipeline.bindings.size(), bounds.size(), " resources given, the shader has ",
                pipeline.bindings.size(), " bindings");
    if (bounds.empty()) return;
    const VkDescriptorSet set = allocateSet(pipeline.setLayout);
    std::vector<VkDescriptorBufferInfo> buffers(bounds.size());
    std::vector<VkDescriptorImageInfo> images(bounds.size());
    std::vector<VkBufferView> views(bounds.size());
    std::vector<VkWriteDescriptorSet> writes(bounds.size());
    for (size_t i = 0; i < pipeline.bindings.size(); ++i) {
        const ShaderBinding& wanted = pipeline.bindings[i];
        const auto found =
            std::find_if(bounds.begin(), bounds.end(), [&](const Bound& b) { return b.binding == wanted.binding; });
        HELIO_CHECK(found != bounds.end(), "no resource for binding ", wanted.binding);
        const bool isImage = wanted.kind == BindingKind::SampledImage || wanted.kind == BindingKind::StorageImage;
        HELIO_CHECK(isImage ? found->image != nullptr : found->buffer != nullptr, "binding ", wanted.binding, " wants ",
                    isImage ? "an image" : "a buffer");
        VkWriteDescriptorSet& write = writes[i];
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = set;
        write.dstBinding = wanted.binding;
        write.descriptorCount = 1;
        switch (wanted.kind) {
        case BindingKind::UniformBlock:
        case BindingKind::StorageBuffer: {
            const Buffer& buffer = *found->buffer;
            const u64 bytes = found->bytes ? found->bytes : buffer.bytes() - found->offset;
            HELIO_CHECK(found->offset + bytes <= buffer.bytes() && bytes <= context_.facts().maxStorageBufferBytes,
                        "binding ", wanted.binding, " wants ", bytes, " bytes at ", found->offset, " of '",
                        buffer.desc().name, "', which has ", buffer.bytes(), "; the device binds at most ",
                        context_.facts().maxStorageBufferBytes);
            buffers[i] = {buffer.handle(), found->offset, bytes};
            write.descriptorType = wanted.kind == BindingKind::UniformBlock ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                                                            : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            write.pBufferInfo = &buffers[i];
            break;
        }
        case BindingKind::StorageTexelBuffer:
        case BindingKind::UniformTexelBuffer:
            HELIO_CHECK(found->format != VK_FORMAT_UNDEFINED, "binding ", wanted.binding,
                        " is a texel buffer: bind it with its format");
            views[i] = found->buffer->texelView(found->format);
            write.descriptorType = wanted.kind == BindingKind::StorageTexelBuffer
                                       ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER
                                       : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
            write.pTexelBufferView = &views[i];
            break;
        case BindingKind::SampledImage:
            images[i] = {context_.sampler(found->sampler), found->image->view(found->part),
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
            write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
            write.pImageInfo = &images[i];
            break;
        case BindingKind::StorageImage:
            images[i] = {VK_NULL_HANDLE, found->image->view(found->part), VK_IMAGE_LAYOUT_GENERAL};
            write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
            write.pImageInfo = &images[i];
            break;
        }
    }
    vkUpdateDescriptorSets(context_.device(), u32(writes.size()), writes.data(), 0, nullptr);
    vkCmdBindDescriptorSets(commands_, pipeline.bindPoint, pipeline.layout, 0, 1, &set, 0, nullptr);
}

void Recorder::push(const Pipeline& pipeline, std::span<const std::byte> bytes)
{
    HELIO_CHECK(bytes.size() == pipeline.pushBytes, bytes.size(), " bytes of push constants, the shader has ",
                pipeline.pushBytes);
    if (bytes.empty()) return;
    vkCmdPushConstants(commands_, pipeline.layout, pipeline.stages, 0, u32(bytes.size()), bytes.data());
}

void Recorder::barriers(std::span<const VkBufferMemoryBarrier2> buffers, std::span<const VkImageMemoryBarrier2> images)
{
    if (buffers.empty() && images.empty()) return;
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.bufferMemoryBarrierCount = u32(buffers.size());
    info.pBufferMemoryBarriers = buffers.data();
    info.imageMemoryBarrierCount = u32(images.size());
    info.pImageMemoryBarriers = images.data();
    vkCmdPipelineBarrier2(commands_, &info);
}

void Recorder::barrier(VkPipelineStageFlags2 srcStages, VkAccessFlags2 srcAccess, VkPipelineStageFlags2 dstStages,
                       VkAccessFlags2 dstAccess)
{
    VkMemoryBarrier2 memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    memory.srcStageMask = srcStages;
    memory.srcAccessMask = srcAccess;
    memory.dstStageMask = dstStages;
    memory.dstAccessMask = dstAccess;
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
    vkCmdPipelineBarrier2(commands_, &info);
}

void Recorder::mark(const std::string& name)
{
    if (!queries_ || marks_.size() == kMaxMarks) return;
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, u32(marks_.size()));
    marks_.push_back(name);
}

std::vector<PassTime> Recorder::times()
{
    HELIO_CHECK(!submitted_, "times are read after wait");
    if (marks_.size() < 2) return {};
    std::vector<u64> ticks(marks_.size());
    vkCheck(vkGetQueryPoolResults(context_.device(), queries_, 0, u32(ticks.size()), ticks.size() * sizeof(u64),
                                  ticks.data(), sizeof(u64), VK_QUERY_RESULT_64_BIT),
            "vkGetQueryPoolResults");
    std::vector<PassTime> times;
    for (size_t i = 1; i < marks_.size(); ++i) {
        if (marks_[i].empty()) continue; // a start: the stretch before it is nobody's
        times.push_back(
            {marks_[i], double(ticks[i] - ticks[i - 1]) * double(context_.facts().timestampPeriodNs) * 1e-6});
    }
    return times;
}

double totalTime(std::span<const PassTime> passes)
{
    double total = 0.0;
    for (const PassTime& pass : passes) total += pass.milliseconds;
    return total;
}

void Recorder::beginLabel(const std::string& name)
{
    if (!beginLabel_) return;
    VkDebugUtilsLabelEXT label{};
    label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
    label.pLabelName = name.c_str();
    beginLabel_(commands_, &label);
}

void Recorder::endLabel()
{
    if (endLabel_) endLabel_(commands_);
}

} // namespace helio
