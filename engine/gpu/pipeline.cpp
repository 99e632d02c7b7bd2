// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/pipeline.h"

#include <algorithm>
#include <deque>

#include "engine/gpu/context.h"
#include "engine/gpu/vk_check.h"

namespace helio {
namespace {

VkShaderStageFlagBits stageBit(ShaderStage stage)
{
    switch (stage) {
    case ShaderStage::Vertex:
        return VK_SHADER_STAGE_VERTEX_BIT;
    case ShaderStage::Fragment:
        return VK_SHADER_STAGE_FRAGMENT_BIT;
    case ShaderStage::Compute:
        break;
    }
    return VK_SHADER_STAGE_COMPUTE_BIT;
}

VkDescriptorType descriptorType(BindingKind kind)
{
    switch (kind) {
    case BindingKind::UniformBlock:
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case BindingKind::StorageTexelBuffer:
        return VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    case BindingKind::UniformTexelBuffer:
        return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    case BindingKind::SampledImage:
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case BindingKind::StorageImage:
        return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    case BindingKind::StorageBuffer:
        break;
    }
    return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

/// A shader module for as long as a pipeline is being made.
class Module
{
public:
    Module(const Context& context, const ShaderCode& shader) : device_(context.device())
    {
        VkShaderModuleCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        info.codeSize = shader.words.size_bytes();
        info.pCode = shader.words.data();
        vkCheck(vkCreateShaderModule(device_, &info, nullptr, &handle_), "shader module '", shader.name, "'");
    }
    ~Module() { vkDestroyShaderModule(device_, handle_, nullptr); }
    Module(const Module&) = delete;
    Module& operator=(const Module&) = delete;
    VkShaderModule handle() const { return handle_; }

private:
    VkDevice device_;
    VkShaderModule handle_ = VK_NULL_HANDLE;
};

/// Specialisation constants in the form that Vulkan wants. Points into itself: not to be moved.
struct Specialisation
{
    explicit Specialisation(const std::vector<SpecConstant>& constants)
    {
        for (const SpecConstant& constant : constants) {
            entries.push_back({constant.id, u32(values.size() * sizeof(u32)), sizeof(u32)});
            values.push_back(constant.value);
        }
        info.mapEntryCount = u32(entries.size());
        info.pMapEntries = entries.data();
        info.dataSize = values.size() * sizeof(u32);
        info.pData = values.data();
    }
    Specialisation(const Specialisation&) = delete;
    Specialisation& operator=(const Specialisation&) = delete;

    std::vector<VkSpecializationMapEntry> entries;
    std::vector<u32> values;
    VkSpecializationInfo info{};
};

VkPipelineShaderStageCreateInfo stageInfo(const Module& module, ShaderStage stage, const Specialisation& constants)
{
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = stageBit(stage);
    info.module = module.handle();
    info.pName = "main";
    info.pSpecializationInfo = &constants.info;
    return info;
}

} // namespace

// Dozens of pipelines: a search through a list is enough, and a deque keeps the references valid.
struct PipelineCache::Entries
{
    std::deque<std::pair<ComputePipelineDesc, Pipeline>> compute;
    std::deque<std::pair<GraphicsPipelineDesc, Pipeline>> graphics;
};

PipelineCache::PipelineCache(Context& context) : context_(context), entries_(std::make_unique<Entries>()) {}

PipelineCache::~PipelineCache()
{
    const auto destroy = [&](const Pipeline& pipeline) {
        vkDestroyPipeline(context_.device(), pipeline.handle, nullptr);
        vkDestroyPipelineLayout(context_.device(), pipeline.layout, nullptr);
        vkDestroyDescriptorSetLayout(context_.device(), pipeline.setLayout, nullptr);
    };
    for (const auto& entry : entries_->compute) destroy(entry.second);
    for (const auto& entry : entries_->graphics) destroy(entry.second);
}

u32 PipelineCache::size() const
{
    return u32(entries_->compute.size() + entries_->graphics.size());
}

Pipeline PipelineCache::makeLayout(const std::vector<const ShaderCode*>& shaders)
{
    Pipeline pipeline;
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const ShaderCode* shader : shaders) {
        pipeline.stages |= stageBit(shader->stage);
        pipeline.pushBytes = std::max(pipeline.pushBytes, shader->pushBytes);
        for (const ShaderBinding& binding : shader->bindings) {
            const auto same = [&](const ShaderBinding& other) { return other.binding == binding.binding; };
            const auto found = std::find_if(pipeline.bindings.begin(), pipeline.bindings.end(), same);
            if (found == pipeline.bindings.end()) {
                pipeline.bindings.push_back(binding);
                bindings.push_back(
                    {binding.binding, descriptorType(binding.kind), 1, u32(stageBit(shader->stage)), nullptr});
                continue;
            }
            HELIO_CHECK(found->kind == binding.kind, "binding ", binding.binding, " of '", shader->name,
                        "' is of another kind in the stage before it");
            bindings[size_t(found - pipeline.bindings.begin())].stageFlags |= stageBit(shader->stage);
        }
    }
    HELIO_CHECK(pipeline.pushBytes <= context_.facts().maxPushConstantBytes, "'", shaders[0]->name, "' pushes ",
                pipeline.pushBytes, " bytes");
    VkDescriptorSetLayoutCreateInfo setInfo{};
    setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    setInfo.bindingCount = u32(bindings.size());
    setInfo.pBindings = bindings.data();
    vkCheck(vkCreateDescriptorSetLayout(context_.device(), &setInfo, nullptr, &pipeline.setLayout), "set layout of '",
            shaders[0]->name, "'");
    const VkPushConstantRange range{pipeline.stages, 0, pipeline.pushBytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 1;
    info.pSetLayouts = &pipeline.setLayout;
    info.pushConstantRangeCount = pipeline.pushBytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    vkCheck(vkCreatePipelineLayout(context_.device(), &info, nullptr, &pipeline.layout), "pipeline layout of '",
            shaders[0]->name, "'");
    return pipeline;
}

const Pipeline& PipelineCache::compute(const ComputePipelineDesc& desc)
{
    for (const auto& [known, pipeline] : entries_->compute) {
        if (known == desc) return pipeline;
    }
    HELIO_CHECK(desc.shader && desc.shader->stage == ShaderStage::Compute, "not a compute shader");
    Pipeline pipeline = makeLayout({desc.shader});
    const Module module(context_, *desc.shader);
    const Specialisation constants(desc.constants);
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage = stageInfo(module, ShaderStage::Compute, constants);
    info.layout = pipeline.layout;
    vkCheck(vkCreateComputePipelines(context_.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.handle),
            "compute pipeline '", desc.shader->name, "'");
    context_.nameObject(VK_OBJECT_TYPE_PIPELINE, u64(pipeline.handle), desc.shader->name);
    return entries_->compute.emplace_back(desc, pipeline).second;
}

const Pipeline& PipelineCache::graphics(const GraphicsPipelineDesc& desc)
{
    for (const auto& [known, pipeline] : entries_->graphics) {
        if (known == desc) return pipeline;
    }
    HELIO_CHECK(desc.vertex && desc.vertex->stage == ShaderStage::Vertex, "not a vertex shader");
    HELIO_CHECK(!desc.fragment || desc.fragment->stage == ShaderStage::Fragment, "not a fragment shader");
    std::vector<const ShaderCode*> shaders{desc.vertex};
    if (desc.fragment) shaders.push_back(desc.fragment);
    Pipeline pipeline = makeLayout(shaders);
    pipeline.bindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;

    const Specialisation constants(desc.constants);
    const Module vertexModule(context_, *desc.vertex);
    std::vector<VkPipelineShaderStageCreateInfo> stages{stageInfo(vertexModule, ShaderStage::Vertex, constants)};
    std::unique_ptr<Module> fragmentModule;
    if (desc.fragment) {
        fragmentModule = std::make_unique<Module>(context_, *desc.fragment);
        stages.push_back(stageInfo(*fragmentModule, ShaderStage::Fragment, constants));
    }

    std::vector<VkVertexInputBindingDescription> slots;
    for (const VertexSlot& slot : desc.vertexSlots) {
        slots.push_back({u32(slots.size()), slot.stride,
                         slot.perInstance ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX});
    }
    std::vector<VkVertexInputAttributeDescription> attributes;
    for (const VertexAttribute& a : desc.attributes) attributes.push_back({a.location, a.slot, a.format, a.offset});
    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    input.vertexBindingDescriptionCount = u32(slots.size());
    input.pVertexBindingDescriptions = slots.data();
    input.vertexAttributeDescriptionCount = u32(attributes.size());
    input.pVertexAttributeDescriptions = attributes.data();

    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = desc.topology;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.depthClampEnable = desc.depthClamp && context_.facts().depthClamp;
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = desc.cull;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.depthBiasEnable = desc.depthBias;
    raster.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    const bool hasDepth = desc.depth != VK_FORMAT_UNDEFINED;
    depth.depthTestEnable = hasDepth && desc.depthTest;
    depth.depthWriteEnable = hasDepth && desc.depthWrite;
    depth.depthCompareOp = desc.depthCompare;

    VkPipelineColorBlendAttachmentState target{};
    target.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    target.blendEnable = desc.blend;
    target.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    target.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    target.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    target.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    const std::vector<VkPipelineColorBlendAttachmentState> targets(desc.colors.size(), target);
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = u32(targets.size());
    blend.pAttachments = targets.data();

    std::vector<VkDynamicState> dynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    if (desc.depthBias) dynamic.push_back(VK_DYNAMIC_STATE_DEPTH_BIAS);
    VkPipelineDynamicStateCreateInfo dynamics{};
    dynamics.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamics.dynamicStateCount = u32(dynamic.size());
    dynamics.pDynamicStates = dynamic.data();

    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = u32(desc.colors.size());
    rendering.pColorAttachmentFormats = desc.colors.data();
    rendering.depthAttachmentFormat = desc.depth;
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.stageCount = u32(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamics;
    info.layout = pipeline.layout;
    vkCheck(vkCreateGraphicsPipelines(context_.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.handle),
            "graphics pipeline '", desc.vertex->name, "'");
    context_.nameObject(VK_OBJECT_TYPE_PIPELINE, u64(pipeline.handle), desc.vertex->name);
    return entries_->graphics.emplace_back(desc, pipeline).second;
}

} // namespace helio
