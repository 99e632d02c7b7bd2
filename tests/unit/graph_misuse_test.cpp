// SPDX-License-Identifier: Apache-2.0
// One test for each graph that must be rejected, drawn above it. No device.
#include <gtest/gtest.h>

#include "engine/graph/pass_context.h"

namespace helio {
namespace {

const BufferDesc kCounts{"counts", 64};
const ImageDesc kIds{"ids", 8, 8, VK_FORMAT_R32_UINT};
const auto kNothing = [](PassContext&) {};

std::string errorOf(const FrameGraph& graph)
{
    const Result<GraphPlan> plan = graph.plan();
    return plan ? "" : plan.error().message;
}

/// (fill) --CopyTo--> counts 1
Ref<Buffer> addWriter(FrameGraph& graph, const char* name)
{
    return graph.addPass(name, [&](PassBuilder& pass) {
        const Ref<Buffer> to = pass.write(pass.create(kCounts), Use::CopyTo);
        pass.record(kNothing);
        return to;
    });
}

Ref<Buffer> addUpdate(FrameGraph& graph, const char* name, Ref<Buffer> buffer, Use use)
{
    return graph.addPass(name, [&](PassBuilder& pass) {
        const Ref<Buffer> to = pass.write(buffer, use);
        pass.sideEffect();
        pass.record(kNothing);
        return to;
    });
}

void addReader(FrameGraph& graph, const char* name, Ref<Buffer> buffer, Use use)
{
    graph.addPass(name, [&](PassBuilder& pass) {
        pass.read(buffer, use);
        pass.sideEffect();
        pass.record(kNothing);
    });
}

//   (histogram) --ComputeWrite--> counts 1 --ComputeRead--> (gather)      fine: the base of all that follow
TEST(GraphMisuse, AWellFormedGraphIsAccepted)
{
    FrameGraph graph;
    const Ref<Buffer> counts = addUpdate(graph, "histogram", addWriter(graph, "fill"), Use::ComputeReadWrite);
    addReader(graph, "gather", counts, Use::ComputeRead);
    EXPECT_EQ(errorOf(graph), "");
}

//   counts 0 --ComputeRead--> (gather)
TEST(GraphMisuse, ReadBeforeWrite)
{
    FrameGraph graph;
    graph.addPass("gather", [&](PassBuilder& pass) {
        pass.read(pass.create(kCounts), Use::ComputeRead);
        pass.record(kNothing);
    });
    EXPECT_EQ(errorOf(graph), "pass 'gather' reads 'counts', which no pass has written");
}

//   counts 0 <--ComputeReadWrite--> (histogram)      adds to what nobody cleared
TEST(GraphMisuse, AddingToUnwrittenContents)
{
    FrameGraph graph;
    graph.addPass("histogram", [&](PassBuilder& pass) {
        (void)pass.write(pass.create(kCounts), Use::ComputeReadWrite);
        pass.record(kNothing);
    });
    EXPECT_EQ(errorOf(graph),
              "pass 'histogram' uses 'counts' as ComputeReadWrite, which reads it first, but no pass has written it");
}

//   (fill) --> counts 1 --> (histogram) --> counts 2
//                   `--ComputeRead--> (gather)          gather comes after histogram
TEST(GraphMisuse, StaleVersion)
{
    FrameGraph graph;
    const Ref<Buffer> stale = addWriter(graph, "fill");
    (void)addUpdate(graph, "histogram", stale, Use::ComputeReadWrite);
    addReader(graph, "gather", stale, Use::ComputeRead);
    EXPECT_EQ(errorOf(graph),
              "pass 'gather' reads version 1 of 'counts', which pass 'histogram' replaced by version 2: "
              "use the reference that write returned");
}

//   (fill) --> counts 1 --> (histogram)
//                   `-----> (clear)
TEST(GraphMisuse, TwoWritersOfOneVersion)
{
    FrameGraph graph;
    const Ref<Buffer> counts = addWriter(graph, "fill");
    (void)addUpdate(graph, "histogram", counts, Use::ComputeReadWrite);
    (void)addUpdate(graph, "clear", counts, Use::CopyTo);
    EXPECT_EQ(errorOf(graph), "pass 'histogram' and pass 'clear' both write version 1 of 'counts': "
                              "use the reference that the first write returned");
}

//   graph a: (fill) --> counts 1          graph b: counts 1 --> (gather)
TEST(GraphMisuse, ReferenceOfAnotherGraph)
{
    FrameGraph other("other");
    const Ref<Buffer> counts = addWriter(other, "fill");
    FrameGraph graph("mine");
    addReader(graph, "gather", counts, Use::ComputeRead);
    EXPECT_EQ(errorOf(graph), "pass 'gather' uses a reference that graph 'mine' did not make");
}

//   Ref<Image> that names a buffer
TEST(GraphMisuse, ReferenceOfAnotherKind)
{
    FrameGraph graph("mine");
    const Ref<Buffer> counts = addWriter(graph, "fill");
    graph.addPass("shade", [&](PassBuilder& pass) {
        pass.read(Ref<Image>{counts.index, counts.version}, Use::FragmentSample);
        pass.record(kNothing);
    });
    EXPECT_EQ(errorOf(graph), "pass 'shade' uses a reference that graph 'mine' did not make");
}

//   (raster) --ColorTarget--> ids 1 --FragmentSample--> (shade) --ColorTargetLoad--> ids 2      one image, two layouts
TEST(GraphMisuse, TwoLayoutsInOnePass)
{
    FrameGraph graph;
    const Ref<Image> ids = graph.addPass("raster", [&](PassBuilder& pass) {
        const Ref<Image> to = pass.write(pass.create(kIds), Use::ColorTarget);
        pass.record(kNothing);
        return to;
    });
    graph.addPass("shade", [&](PassBuilder& pass) {
        pass.read(ids, Use::FragmentSample);
        (void)pass.write(ids, Use::ColorTargetLoad);
        pass.sideEffect();
        pass.record(kNothing);
    });
    EXPECT_EQ(errorOf(graph), "pass 'shade' uses image 'ids' in two layouts at once; the second is ColorTargetLoad: "
                              "split the pass");
}

//   counts --ColorTarget--> : a buffer is no target;   ids --Index--> : an image holds no indices
TEST(GraphMisuse, UseThatDoesNotFitTheResource)
{
    FrameGraph first;
    (void)addUpdate(first, "raster", addWriter(first, "fill"), Use::ColorTarget);
    EXPECT_EQ(errorOf(first), "pass 'raster' uses buffer 'counts' as ColorTarget, which is no use of a buffer");

    FrameGraph second;
    second.addPass("draw", [&](PassBuilder& pass) {
        pass.read(pass.create(kIds), Use::Index);
        pass.record(kNothing);
    });
    EXPECT_EQ(errorOf(second), "pass 'draw' uses image 'ids' as Index, which is no use of an image");
}

//   read(..., ComputeWrite) and write(..., ComputeRead)
TEST(GraphMisuse, WrongDirection)
{
    FrameGraph first;
    addReader(first, "gather", addWriter(first, "fill"), Use::ComputeWrite);
    EXPECT_EQ(errorOf(first),
              "pass 'gather' reads 'counts' with the use ComputeWrite, which writes: declare it with write");

    FrameGraph second;
    (void)addUpdate(second, "gather", addWriter(second, "fill"), Use::ComputeRead);
    EXPECT_EQ(errorOf(second),
              "pass 'gather' writes 'counts' with the use ComputeRead, which only reads: declare it with read");
}

TEST(GraphMisuse, PassWithoutRecord)
{
    FrameGraph graph;
    graph.addPass("forgotten", [](PassBuilder&) {});
    EXPECT_EQ(errorOf(graph), "pass 'forgotten' has no record function");
}

TEST(GraphMisuse, ResourceWithoutSize)
{
    FrameGraph graph;
    graph.addPass("fill", [](PassBuilder& pass) {
        (void)pass.write(pass.create(BufferDesc{"empty", 0}), Use::CopyTo);
        pass.sideEffect();
        pass.record(kNothing);
    });
    EXPECT_EQ(errorOf(graph), "buffer 'empty' has no size");
}

//   counts 1 --leave(CopyTo)--> outside
TEST(GraphMisuse, LeavingForAWrite)
{
    FrameGraph graph;
    graph.leave(addWriter(graph, "fill"), Use::CopyTo);
    EXPECT_EQ(errorOf(graph), "the end of the graph leaves 'counts' for CopyTo, which writes");
}

TEST(GraphMisuse, TheFirstMistakeIsReported)
{
    FrameGraph graph;
    const Ref<Buffer> counts = addWriter(graph, "fill");
    addReader(graph, "first", counts, Use::ComputeWrite);
    addReader(graph, "second", counts, Use::ComputeWrite);
    EXPECT_EQ(errorOf(graph).substr(0, 12), "pass 'first'");
}

} // namespace
} // namespace helio
