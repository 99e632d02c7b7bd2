// SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "test_shaders/embedded.h"
#include "tests/support/gpu_fixture.h"

namespace helio {
namespace {

using GraphExecute = GpuTest;

constexpr u32 kCount = 300;
constexpr u64 kBytes = kCount * sizeof(u32);

/// to[i] = 2 from[i] + i
Ref<Buffer> addScale(FrameGraph& graph, const char* name, Ref<Buffer> from, Ref<Buffer> to = {})
{
    return graph.addPass(name, [&](PassBuilder& pass) {
        pass.read(from, Use::ComputeRead);
        if (!to.valid()) to = pass.create(BufferDesc{name, kBytes});
        const Ref<Buffer> out = pass.write(to, Use::ComputeWrite);
        pass.record([=](PassContext& ctx) {
            ctx.dispatch(test_shaders::kScaleStorageComp, {storage(0, from), storage(1, out)}, kCount,
                         groupsFor(kCount, 64));
        });
        return out;
    });
}

std::vector<u32> scaled(std::vector<u32> values)
{
    for (u32 i = 0; i < values.size(); ++i) values[i] = 2 * values[i] + i;
    return values;
}

void run(Recorder& recorder, FrameGraph& graph)
{
    recorder.begin();
    graph.execute(recorder);
    recorder.submitAndWait();
}

TEST_F(GraphExecute, ReadbackToTheHost)
{
    const Buffer host(context(), {"host", kBytes, Memory::Readback});
    FrameGraph graph;
    const Ref<Buffer> filled = graph.addPass("fill", [](PassBuilder& pass) {
        const Ref<Buffer> to = pass.write(pass.create(BufferDesc{"filled", kBytes}), Use::CopyTo);
        pass.record([=](PassContext& ctx) { ctx.fill(to, 11); });
        return to;
    });
    addReadback(graph, addScale(graph, "scaled", filled), host);
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorder(context());
    const std::vector<u32> expected = scaled(std::vector<u32>(kCount, 11));
    for (int frame = 0; frame < 3; ++frame) {
        std::memset(host.mapped(), 0, kBytes);
        run(recorder, graph);
        host.invalidate();
        EXPECT_EQ(std::memcmp(host.mapped(), expected.data(), kBytes), 0) << "frame " << frame;
    }
}

// One graph makes the light when the sun moves, the other reads it every frame.
TEST_F(GraphExecute, WhatOneGraphWroteAnotherReadsWithoutRunningItAgain)
{
    const Buffer from = makeBuffer(context(), "from", std::vector<u32>(kCount, 1));
    const Buffer light(context(), {"light", kBytes});
    const Buffer picture(context(), {"picture", kBytes});
    FrameGraph solve("solve");
    addScale(solve, "solve", solve.import(from), solve.import(light));
    FrameGraph view("view");
    addScale(view, "view", view.import(light), view.import(picture));
    ASSERT_TRUE(solve.compile(context()));
    ASSERT_TRUE(view.compile(context()));
    Recorder recorder(context());
    std::vector<u32> expected(kCount, 1);
    for (const bool sunMoved : {true, false, false, true, false}) {
        recorder.begin();
        if (sunMoved) solve.execute(recorder);
        view.execute(recorder);
        recorder.submitAndWait();
        EXPECT_EQ(downloadItems<u32>(context(), picture), scaled(scaled(expected)));
    }
}

TEST_F(GraphExecute, TwoFramesInFlight)
{
    // No wait between the frames: the barriers alone must order them.
    const Buffer values = makeBuffer(context(), "values", std::vector<u32>(kCount, 3));
    FrameGraph graph;
    const Ref<Buffer> twice = addScale(graph, "first", graph.import(values));
    addScale(graph, "second", twice, graph.import(values));
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorders[2]{Recorder(context()), Recorder(context())};
    std::vector<u32> expected(kCount, 3);
    for (int frame = 0; frame < 6; ++frame) {
        Recorder& recorder = recorders[frame % 2];
        recorder.begin();
        graph.execute(recorder);
        recorder.submit();
        expected = scaled(scaled(expected));
    }
    for (Recorder& recorder : recorders) recorder.wait();
    EXPECT_EQ(downloadItems<u32>(context(), values), expected);
}

TEST_F(GraphExecute, CulledPassesDoNotRun)
{
    const Buffer from = makeBuffer(context(), "from", std::vector<u32>(kCount, 1));
    const Buffer to(context(), {"to", kBytes});
    FrameGraph graph;
    bool deadRan = false;
    graph.addPass("dead", [&](PassBuilder& pass) {
        (void)pass.write(pass.create(BufferDesc{"unread", kBytes}), Use::CopyTo);
        pass.record([&deadRan](PassContext&) { deadRan = true; });
    });
    addScale(graph, "live", graph.import(from), graph.import(to));
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorder(context());
    run(recorder, graph);
    EXPECT_FALSE(deadRan);
    EXPECT_EQ(downloadItems<u32>(context(), to), scaled(std::vector<u32>(kCount, 1)));
}

TEST_F(GraphExecute, RebindChangesTheImportedImage)
{
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const Image first(context(), {"first", 4, 4, VK_FORMAT_R32_UINT, 1, usage});
    const Image second(context(), {"second", 4, 4, VK_FORMAT_R32_UINT, 1, usage});
    FrameGraph graph;
    const Ref<Image> target = graph.import(first);
    graph.addPass("clear", [&](PassBuilder& pass) {
        const Ref<Image> to = pass.write(target, Use::ColorTarget);
        pass.record([=](PassContext& ctx) {
            ctx.render({.colors = {{to, VkClearColorValue{.uint32 = {42, 0, 0, 0}}}}, .depth = {}}, [](Drawing&) {});
        });
        graph.leave(to, Use::CopyFrom);
    });
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorder(context());
    graph.rebind(target, second);
    run(recorder, graph);
    EXPECT_EQ(downloadTexels<u32>(context(), second), std::vector<u32>(16, 42));
    EXPECT_EQ(first.state(), AccessState{}) << "nobody touched it";
}

TEST_F(GraphExecute, AnImportedImageMustHaveTheUsage)
{
    const Image image(context(), {"picture", 4, 4, VK_FORMAT_R32_UINT, 1, VK_IMAGE_USAGE_SAMPLED_BIT});
    FrameGraph graph("frame");
    graph.addPass("clear", [&](PassBuilder& pass) {
        (void)pass.write(pass.import(image), Use::ColorTarget);
        pass.record([](PassContext&) {});
    });
    const Status compiled = graph.compile(context());
    ASSERT_FALSE(compiled);
    EXPECT_EQ(compiled.error().message.find("graph 'frame': image 'picture' was made with usage "), 0u);
}

TEST_F(GraphExecute, TimesAreNamedOrderedAndPlausible)
{
    if (context().facts().timestampPeriodNs == 0) GTEST_SKIP() << "the queue has no timestamps";
    const Buffer from = makeBuffer(context(), "from", std::vector<u32>(kCount, 1));
    const Buffer to(context(), {"to", kBytes});
    FrameGraph graph;
    addScale(graph, "second", addScale(graph, "first", graph.import(from)), graph.import(to));
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorder(context());
    const auto start = std::chrono::steady_clock::now();
    recorder.begin();
    graph.execute(recorder, true);
    recorder.submitAndWait();
    const double wall = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const std::vector<PassTime> times = recorder.times();
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].name, "first");
    EXPECT_EQ(times[1].name, "second");
    double sum = 0;
    for (const PassTime& time : times) {
        EXPECT_GE(time.milliseconds, 0.0) << time.name;
        sum += time.milliseconds;
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_LE(sum, wall) << "the device cannot be busy for longer than we waited";
    run(recorder, graph);
    EXPECT_TRUE(recorder.times().empty()) << "no marks without timings";
}

using GraphExecuteDeathTest = GpuTest;

TEST_F(GraphExecuteDeathTest, UndeclaredResourcesAbort)
{
    const Buffer secret(context(), {"secret", kBytes});
    FrameGraph graph;
    const Ref<Buffer> hidden = graph.import(secret);
    graph.addPass("thief", [&](PassBuilder& pass) {
        pass.sideEffect();
        pass.record([=](PassContext& ctx) { ctx.buffer(hidden); });
    });
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorder(context());
    EXPECT_DEATH(run(recorder, graph), "pass 'thief' uses 'secret' without declaring it");
}

TEST_F(GraphExecuteDeathTest, ReadingWhatNobodyWroteAborts)
{
    const Buffer empty(context(), {"empty", kBytes});
    const Buffer to(context(), {"to", kBytes});
    FrameGraph graph("frame");
    addScale(graph, "scale", graph.import(empty), graph.import(to));
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorder(context());
    EXPECT_DEATH(run(recorder, graph), "graph 'frame' reads 'empty', which nobody has written yet");
}

TEST_F(GraphExecuteDeathTest, WrongPushConstantsAbort)
{
    const Buffer from = makeBuffer(context(), "from", std::vector<u32>(kCount, 1));
    const Buffer to(context(), {"to", kBytes});
    FrameGraph graph;
    graph.addPass("scale", [&](PassBuilder& pass) {
        const Ref<Buffer> in = pass.read(pass.import(from), Use::ComputeRead);
        const Ref<Buffer> out = pass.write(pass.import(to), Use::ComputeWrite);
        pass.record([=](PassContext& ctx) {
            ctx.dispatch(test_shaders::kScaleStorageComp, {storage(0, in), storage(1, out)}, u64(kCount), Groups{});
        });
    });
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorder(context());
    // A process of its own: a fork of this one need not have a working device.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(run(recorder, graph), "8 bytes of push constants, the shader has 4");
}

} // namespace
} // namespace helio
