// SPDX-License-Identifier: Apache-2.0
// Which passes of a graph survive, and what follows for its resources. No device.
#include <gtest/gtest.h>

#include "engine/graph/pass_context.h"

namespace helio {
namespace {

const auto kNothing = [](PassContext&) {};

Ref<Buffer> addPass(FrameGraph& graph, const char* name, std::vector<Ref<Buffer>> reads, Ref<Buffer> to = {},
                    Use use = Use::ComputeWrite)
{
    return graph.addPass(name, [&](PassBuilder& pass) {
        for (const Ref<Buffer> from : reads) pass.read(from, Use::ComputeRead);
        if (!to.valid()) to = pass.create(BufferDesc{name, 16});
        pass.record(kNothing);
        return pass.write(to, use);
    });
}

void addEnd(FrameGraph& graph, std::vector<Ref<Buffer>> reads)
{
    graph.addPass("end", [&](PassBuilder& pass) {
        for (const Ref<Buffer> from : reads) pass.read(from, Use::ComputeRead);
        pass.sideEffect();
        pass.record(kNothing);
    });
}

std::vector<u32> liveOf(const FrameGraph& graph)
{
    const Result<GraphPlan> plan = graph.plan();
    EXPECT_TRUE(plan) << plan.error().message;
    return plan ? plan->passes : std::vector<u32>{};
}

using Passes = std::vector<u32>;

//   (0) --> a --> (1) --> b        nobody wants b
TEST(GraphCulling, AChainThatNobodyReadsGoes)
{
    FrameGraph graph;
    addPass(graph, "1", {addPass(graph, "0", {})});
    EXPECT_EQ(liveOf(graph), Passes{});
}

//   (0) --> a --> (1) --> b --> (3 end)
//            `--> (2) --> c
TEST(GraphCulling, OnlyTheDeadBranchGoes)
{
    FrameGraph graph;
    const Ref<Buffer> a = addPass(graph, "0", {});
    const Ref<Buffer> b = addPass(graph, "1", {a});
    addPass(graph, "2", {a});
    addEnd(graph, {b});
    EXPECT_EQ(liveOf(graph), (Passes{0, 1, 3}));
}

//   (0) --> a 1 --> (1) --> a 2 --> (2 end)        a 2 contains what 0 wrote
TEST(GraphCulling, TheWriterBeforeIsNeeded)
{
    FrameGraph graph;
    const Ref<Buffer> first = addPass(graph, "0", {});
    const Ref<Buffer> second = addPass(graph, "1", {}, first, Use::ComputeWrite);
    EXPECT_EQ(second, (Ref<Buffer>{first.index, 2}));
    addEnd(graph, {second});
    EXPECT_EQ(liveOf(graph), (Passes{0, 1, 2}));
}

//   (0) --> a 1 --> (1 end)
//            `----> (2) --> a 2        the later version is dead, the earlier is not
TEST(GraphCulling, ALaterDeadVersionGoes)
{
    FrameGraph graph;
    const Ref<Buffer> first = addPass(graph, "0", {});
    addEnd(graph, {first});
    addPass(graph, "2", {}, first);
    EXPECT_EQ(liveOf(graph), (Passes{0, 1}));
}

//   (0) --> imported        what outlives the graph is wanted
TEST(GraphCulling, WritesToImportedResourcesStay)
{
    FrameGraph graph;
    const Buffer outside;
    addPass(graph, "0", {}, graph.import(outside));
    EXPECT_EQ(liveOf(graph), Passes{0});
}

//   imported --> (0) --> a        reading it is no effect
TEST(GraphCulling, ReadsOfImportedResourcesDoNotKeepAPass)
{
    FrameGraph graph;
    const Buffer outside;
    addPass(graph, "0", {graph.import(outside)});
    EXPECT_EQ(liveOf(graph), Passes{});
}

//   (0) --> a --leave--> host
TEST(GraphCulling, WhatIsLeftIsNeeded)
{
    FrameGraph graph;
    const Ref<Buffer> a = addPass(graph, "0", {});
    addPass(graph, "1", {});
    graph.leave(a, Use::HostRead);
    const Result<GraphPlan> plan = graph.plan();
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->passes, Passes{0});
    ASSERT_EQ(plan->accesses.size(), 2u) << "one list a live pass and one for what is left";
    ASSERT_EQ(plan->accesses[1].size(), 1u);
    EXPECT_EQ(plan->accesses[1][0].stages, VK_PIPELINE_STAGE_2_HOST_BIT);
}

TEST(GraphCulling, ImportingTwiceNamesTheNewestVersion)
{
    FrameGraph graph;
    const Buffer outside;
    const Ref<Buffer> before = graph.import(outside);
    const Ref<Buffer> after = addPass(graph, "0", {}, before);
    EXPECT_EQ(graph.import(outside), after);
    EXPECT_NE(before, after);
}

TEST(GraphPlan, SeveralUsesOfOneBufferAreOneAccess)
{
    FrameGraph graph;
    const Ref<Buffer> a = addPass(graph, "0", {});
    graph.addPass("draw", [&](PassBuilder& pass) {
        pass.read(a, Use::VertexRead);
        pass.read(a, Use::Index);
        pass.sideEffect();
        pass.record(kNothing);
    });
    const Result<GraphPlan> plan = graph.plan();
    ASSERT_TRUE(plan);
    ASSERT_EQ(plan->accesses[1].size(), 1u);
    EXPECT_EQ(plan->accesses[1][0].stages, VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT);
    EXPECT_TRUE(plan->accesses[1][0].reads & VK_ACCESS_2_INDEX_READ_BIT);
}

//   (raster) --ColorTarget--> image 1 --ComputeRead--> (histogram);   dead (view) --FragmentSample--> image
TEST(GraphPlan, ImageUsageFollowsFromLivePasses)
{
    FrameGraph graph;
    const Ref<Image> ids = graph.addPass("raster", [&](PassBuilder& pass) {
        pass.record(kNothing);
        return pass.write(pass.create(ImageDesc{"ids", 8, 8, VK_FORMAT_R32_UINT}), Use::ColorTarget);
    });
    graph.addPass("histogram", [&](PassBuilder& pass) {
        pass.read(ids, Use::ComputeRead);
        pass.sideEffect();
        pass.record(kNothing);
    });
    graph.addPass("view", [&](PassBuilder& pass) {
        pass.read(ids, Use::FragmentSample);
        pass.record(kNothing);
    });
    const Result<GraphPlan> plan = graph.plan();
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->imageUsages[ids.index],
              VkImageUsageFlags(VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT));
    EXPECT_FALSE(plan->accesses[0][0].keepContents) << "the graph's own image starts empty";
    EXPECT_TRUE(plan->accesses[1][0].keepContents);
}

TEST(GraphPlan, DumpNamesPassesVersionsAndUses)
{
    FrameGraph graph("city");
    addEnd(graph, {addPass(graph, "gather", {})});
    addPass(graph, "dead", {});
    const std::string dot = graph.dump();
    for (const char* part :
         {"digraph \"city\"", "p0 [shape=box, label=\"gather\"]", "p0 -> r0v1 [label=\"ComputeWrite\"]",
          "r0v1 -> p1 [label=\"ComputeRead\"]", "label=\"dead\", style=dashed"}) {
        EXPECT_NE(dot.find(part), std::string::npos) << part << "\n" << dot;
    }
}

} // namespace
} // namespace helio
