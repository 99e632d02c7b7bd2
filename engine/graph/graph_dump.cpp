// SPDX-License-Identifier: Apache-2.0
#include "engine/graph/frame_graph_impl.h"

namespace helio {

namespace {

/// "12.3 MiB"
std::string sizeText(double bytes)
{
    const char* const units[] = {"B", "KiB", "MiB", "GiB"};
    u32 unit = 0;
    for (; bytes >= 1024.0 && unit < 3; ++unit) bytes /= 1024.0;
    char text[32];
    std::snprintf(text, sizeof(text), unit == 0 ? "%.0f %s" : "%.1f %s", bytes, units[unit]);
    return text;
}

std::string stagesText(VkPipelineStageFlags2 stages)
{
    const std::pair<VkPipelineStageFlags2, const char*> names[] = {
        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"},
        {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "copy"},
        {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "indirect"},
        {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, "input"},
        {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex"},
        {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "depth"},
        {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"},
        {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "colour"},
        {VK_PIPELINE_STAGE_2_HOST_BIT, "host"}};
    std::string text;
    for (const auto& [stage, name] : names)
        if (stages & stage) text += concat(text.empty() ? "" : "+", name);
    return text.empty() ? "start" : text;
}

} // namespace

std::string FrameGraph::dump() const
{
    // Barriers of a first execution: imported resources come as if nobody had touched them.
    std::vector<std::vector<Barrier>> barriers;
    std::vector<u32> livePlace(impl_->passes.size(), kNoIndex);
    if (impl_->compiled) {
        std::vector<AccessState> states(impl_->resources.size());
        barriers = deriveBarriers(states, impl_->compiled->accesses);
        for (u32 i = 0; i < impl_->compiled->passes.size(); ++i) livePlace[impl_->compiled->passes[i]] = i;
    }
    std::string out = concat("digraph \"", impl_->name, "\" {\n  rankdir=LR;\n");
    const std::vector<bool> live = impl_->livePasses();
    for (u32 i = 0; i < impl_->passes.size(); ++i) {
        const Impl::Pass& pass = impl_->passes[i];
        std::string label = pass.name;
        if (livePlace[i] != kNoIndex)
            for (const Barrier& b : barriers[livePlace[i]])
                label += concat("\\nwait: ", impl_->resources[b.resource].name, ", ", stagesText(b.srcStages), " to ",
                                stagesText(b.dstStages));
        out += concat("  p", i, " [shape=box, label=\"", label, "\"", live[i] ? "" : ", style=dashed", "];\n");
        for (const Impl::Declared& use : pass.uses) {
            const std::string node = concat("r", use.resource, "v", use.version);
            const char* name = useInfo(use.use).name;
            out += use.write ? concat("  p", i, " -> ", node, " [label=\"", name, "\"];\n")
                             : concat("  ", node, " -> p", i, " [label=\"", name, "\"];\n");
        }
    }
    for (u32 i = 0; i < impl_->resources.size(); ++i) {
        const Impl::Resource& resource = impl_->resources[i];
        const ImageDesc& image = resource.imageDesc;
        const std::string size =
            resource.image ? concat(image.width, " x ", image.height, image.layers > 1 ? concat(" x ", image.layers) : "",
                                    ", ",
                                    sizeText(double(image.width) * image.height * image.layers * texelBytes(image.format)))
                           : sizeText(double(resource.bufferDesc.bytes));
        for (u32 version = 0; version <= resource.newestVersion(); ++version) {
            out += concat("  r", i, "v", version, " [label=\"", resource.name, " ", version,
                          resource.imported ? " (imported)" : "", "\\n", size, "\"];\n");
            if (version > 0) out += concat("  r", i, "v", version - 1, " -> r", i, "v", version, " [style=dotted];\n");
        }
    }
    return out + "}\n";
}

} // namespace helio
