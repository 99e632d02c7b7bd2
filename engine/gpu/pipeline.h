// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>
#include <vulkan/vulkan.h>

#include "city/base/types.h"
#include "shaders/shader_code.h"

namespace helio {

class Context;

/// Value of `layout(constant_id = id) const`, as its 32 bits (std::bit_cast for floats; 0 and 1 for bool).
struct SpecConstant
{
    u32 id = 0;
    u32 value = 0;
    bool operator==(const SpecConstant&) const = default;
};

struct ComputePipelineDesc
{
    const ShaderCode* shader = nullptr;
    std::vector<SpecConstant> constants = {};
    bool operator==(const ComputePipelineDesc&) const = default;
};

struct VertexAttribute
{
    u32 location = 0;
    u32 slot = 0; // index into GraphicsPipelineDesc::vertexSlots
    VkFormat format = VK_FORMAT_UNDEFINED;
    u32 offset = 0; // bytes
    bool operator==(const VertexAttribute&) const = default;
};

struct VertexSlot
{
    u32 stride = 0; // bytes
    bool perInstance = false;
    bool operator==(const VertexSlot&) const = default;
};

/// Triangle lists with dynamic rendering; viewport, scissor and the depth bias values are set while recording. Counter-
/// clockwise in a y-up clip space is the front (the viewport is flipped so that clip-space +y points up on the
/// picture).
struct GraphicsPipelineDesc
{
    const ShaderCode* vertex = nullptr;
    const ShaderCode* fragment = nullptr; // null = depth only
    std::vector<VkFormat> colors = {};
    VkFormat depth = VK_FORMAT_UNDEFINED; // UNDEFINED = no depth attachment
    bool depthTest = true;                // ignored without a depth attachment
    bool depthWrite = true;
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
    bool depthBias = false;
    bool depthClamp = false; // clamps instead of clipping at near and far; needs the device feature, else clips
    VkCullModeFlags cull = VK_CULL_MODE_NONE;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    bool blend = false;                       // source alpha over, all colour targets
    std::vector<VertexSlot> vertexSlots = {}; // empty = the vertex shader pulls from storage buffers
    std::vector<VertexAttribute> attributes = {};
    std::vector<SpecConstant> constants = {}; // for both stages
    bool operator==(const GraphicsPipelineDesc&) const = default;
};

struct Pipeline
{
    VkPipeline handle = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    VkShaderStageFlags stages = 0;
    u32 pushBytes = 0;                   // of the larger block of the stages
    std::vector<ShaderBinding> bindings; // union of the stages, ascending
};

/// Makes each described pipeline once. The reference stays valid as long as the context.
class PipelineCache
{
public:
    explicit PipelineCache(Context& context);
    ~PipelineCache();
    const Pipeline& compute(const ComputePipelineDesc& desc);
    const Pipeline& graphics(const GraphicsPipelineDesc& desc);
    u32 size() const;

private:
    struct Entries;
    Pipeline makeLayout(const std::vector<const ShaderCode*>& shaders);

    Context& context_;
    std::unique_ptr<Entries> entries_;
};

} // namespace helio
