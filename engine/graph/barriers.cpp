// SPDX-License-Identifier: Apache-2.0
#include "engine/graph/barriers.h"

#include "city/base/check.h"

namespace helio {
namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 kVertex = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
constexpr VkPipelineStageFlags2 kFragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr VkPipelineStageFlags2 kDepthTests =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkPipelineStageFlags2 kColor = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkPipelineStageFlags2 kTransfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
// Texel buffers count as sampled: a buffer's reads always carry all, so that one stage has one set of read accesses
// and the union kept in AccessState never claims more than was made visible. Images change layout between the two
// instead.
constexpr VkAccessFlags2 kShaderRead =
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;
constexpr VkAccessFlags2 kShaderWrite = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
constexpr VkAccessFlags2 kColorRead = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT;
constexpr VkAccessFlags2 kColorWrite = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags2 kDepthRead = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
constexpr VkAccessFlags2 kDepthWrite = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

constexpr VkImageLayout kNoLayout = VK_IMAGE_LAYOUT_UNDEFINED;
constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
constexpr VkImageLayout kSampledLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
constexpr VkImageLayout kColorLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
constexpr VkImageLayout kDepthLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
constexpr VkImageLayout kDepthReadLayout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;

constexpr VkImageUsageFlags kStorageUsage = VK_IMAGE_USAGE_STORAGE_BIT;
constexpr VkImageUsageFlags kSampledUsage = VK_IMAGE_USAGE_SAMPLED_BIT;
constexpr VkImageUsageFlags kColorUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
constexpr VkImageUsageFlags kDepthUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;

// In the order of the enum. Columns: name, stages, reads, writes, layout, image usage, buffers, needs contents.
constexpr UseInfo kUses[] = {
    {"ComputeRead", kCompute, kShaderRead, 0, kGeneral, kStorageUsage, true, true},
    {"ComputeWrite", kCompute, 0, kShaderWrite, kGeneral, kStorageUsage, true, false},
    {"ComputeReadWrite", kCompute, kShaderRead, kShaderWrite, kGeneral, kStorageUsage, true, true},
    {"ComputeSample", kCompute, kShaderRead, 0, kSampledLayout, kSampledUsage, false, true},
    {"VertexRead", kVertex, kShaderRead, 0, kNoLayout, 0, true, true},
    {"FragmentRead", kFragment, kShaderRead, 0, kNoLayout, 0, true, true},
    {"VertexAndFragmentRead", kVertex | kFragment, kShaderRead, 0, kNoLayout, 0, true, true},
    {"FragmentSample", kFragment, kShaderRead, 0, kSampledLayout, kSampledUsage, false, true},
    {"VertexAttribute", VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, 0,
     kNoLayout, 0, true, true},
    {"Index", VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT, 0, kNoLayout, 0, true, true},
    {"Indirect", VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, 0, kNoLayout, 0, true,
     true},
    {"ColorTarget", kColor, 0, kColorWrite, kColorLayout, kColorUsage, false, false},
    {"ColorTargetLoad", kColor, kColorRead, kColorWrite, kColorLayout, kColorUsage, false, true},
    {"DepthTarget", kDepthTests, kDepthRead, kDepthWrite, kDepthLayout, kDepthUsage, false, false},
    {"DepthTargetLoad", kDepthTests, kDepthRead, kDepthWrite, kDepthLayout, kDepthUsage, false, true},
    {"DepthTest", kDepthTests, kDepthRead, 0, kDepthReadLayout, kDepthUsage, false, true},
    {"CopyFrom", kTransfer, VK_ACCESS_2_TRANSFER_READ_BIT, 0, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
     VK_IMAGE_USAGE_TRANSFER_SRC_BIT, true, true},
    {"CopyTo", kTransfer, 0, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
     VK_IMAGE_USAGE_TRANSFER_DST_BIT, true, false},
    {"HostRead", VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, 0, kNoLayout, 0, true, true},
    {"Present", VK_PIPELINE_STAGE_2_NONE, 0, 0, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, 0, false, true},
};
static_assert(std::size(kUses) == kUseCount);

} // namespace

const UseInfo& useInfo(Use use)
{
    HELIO_CHECK(u32(use) < kUseCount, u32(use));
    return kUses[u32(use)];
}

Access accessOf(u32 resource, bool image, Use use)
{
    const UseInfo& info = useInfo(use);
    Access access;
    access.resource = resource;
    access.image = image;
    access.stages = info.stages;
    access.reads = info.reads;
    access.writes = info.writes;
    access.layout = image ? info.layout : VK_IMAGE_LAYOUT_UNDEFINED;
    return access;
}

bool mergeAccess(Access& into, const Access& other)
{
    if (into.layout != other.layout) return false;
    into.stages |= other.stages;
    into.reads |= other.reads;
    into.writes |= other.writes;
    return true;
}

std::optional<Barrier> advance(AccessState& state, const Access& access)
{
    const bool changesLayout = access.image && state.layout != access.layout;
    const bool writes = access.writes != 0;
    Barrier barrier;
    barrier.resource = access.resource;
    barrier.image = access.image;
    barrier.dstStages = access.stages;
    barrier.dstAccess = access.reads | access.writes;
    barrier.oldLayout = access.keepContents ? state.layout : VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = access.layout;
    if (access.image && !changesLayout) barrier.oldLayout = access.layout;

    bool needed = changesLayout;
    if (!writes && !changesLayout) {
        // A read waits for the last write, unless an earlier barrier showed it to this stage already.
        const bool visible =
            (state.readStages & access.stages) == access.stages && (state.readAccess & access.reads) == access.reads;
        needed = state.writeStages != 0 && !visible;
        barrier.srcStages = state.writeStages;
        barrier.srcAccess = state.writeAccess;
        state.readStages |= access.stages;
        state.readAccess |= access.reads;
    } else {
        // A write (or a change of layout) waits for the last write and for all reads since; reads leave nothing to
        // flush.
        barrier.srcStages = state.writeStages | state.readStages;
        barrier.srcAccess = state.writeAccess;
        needed = needed || barrier.srcStages != 0;
        if (writes) {
            state.writeStages = access.stages;
            state.writeAccess = access.writes;
            state.readStages = 0;
            state.readAccess = 0;
        } else {
            // The change of layout happens before this access's stages: later readers wait for them, and for the write
            // before, because the change alone does not show them its contents.
            state.writeStages |= access.stages;
            state.readStages = access.stages;
            state.readAccess = access.reads;
        }
    }
    state.layout = access.layout;
    state.defined = state.defined || writes;
    if (!needed) return std::nullopt;
    return barrier;
}

std::vector<std::vector<Barrier>> deriveBarriers(std::span<AccessState> states,
                                                 std::span<const std::vector<Access>> passes)
{
    std::vector<std::vector<Barrier>> barriers(passes.size());
    for (size_t pass = 0; pass < passes.size(); ++pass) {
        for (const Access& access : passes[pass]) {
            HELIO_CHECK(access.resource < states.size(), access.resource, " of ", states.size());
            if (const std::optional<Barrier> barrier = advance(states[access.resource], access)) {
                barriers[pass].push_back(*barrier);
            }
        }
    }
    return barriers;
}

} // namespace helio
