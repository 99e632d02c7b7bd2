// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "test_shaders/embedded.h"
#include "tests/support/gpu_fixture.h"

namespace helio {
namespace {

using Compute = GpuTest;

std::vector<u32> numbers(u32 count)
{
    std::vector<u32> items(count);
    for (u32 i = 0; i < count; ++i) items[i] = i * 2654435761u;
    return items;
}

/// to[i] = factor from[i] + i, by one dispatch.
std::vector<u32> scaleOnDevice(Context& context, const ShaderCode& shader, const std::vector<u32>& from,
                               std::vector<SpecConstant> constants = {})
{
    const u32 count = u32(from.size());
    const Buffer source = makeBuffer(context, "from", from);
    FrameGraph graph("scale");
    const Ref<Buffer> to = graph.addPass("scale", [&](PassBuilder& pass) {
        const Ref<Buffer> in = pass.read(pass.import(source), Use::ComputeRead);
        const Ref<Buffer> out = pass.write(pass.create(BufferDesc{"to", from.size() * sizeof(u32)}), Use::ComputeWrite);
        pass.sideEffect();
        pass.record([=, &shader](PassContext& ctx) {
            ctx.dispatch(shader, {texels(0, in, VK_FORMAT_R32_UINT), storage(1, out)}, count, groupsFor(count, 64),
                         constants);
        });
        return out;
    });
    const Status compiled = graph.compile(context);
    EXPECT_TRUE(compiled) << compiled.error().message;
    Recorder recorder(context);
    recorder.begin();
    graph.execute(recorder);
    recorder.submitAndWait();
    return downloadItems<u32>(context, graph.buffer(to));
}

std::vector<u32> scaleOnHost(const std::vector<u32>& from, u32 factor)
{
    std::vector<u32> to(from.size());
    for (u32 i = 0; i < from.size(); ++i) to[i] = factor * from[i] + i;
    return to;
}

TEST_F(Compute, OddSizesBothWaysOfReading)
{
    for (const u32 count : {1u, 63u, 64u, 65u, 1000u}) {
        const std::vector<u32> from = numbers(count);
        const std::vector<u32> expected = scaleOnHost(from, 2);
        EXPECT_EQ(scaleOnDevice(context(), test_shaders::kScaleComp, from), expected) << count << " by texel buffer";
        EXPECT_EQ(scaleOnDevice(context(), test_shaders::kScaleStorageComp, from), expected)
            << count << " by storage buffer";
    }
}

TEST_F(Compute, MoreGroupsThanOneRowHolds)
{
    const u32 count = 65535 * 64 + 1; // one item more than 65535 groups
    ASSERT_GT(groupsFor(count, 64).y, 1u);
    const std::vector<u32> from = numbers(count);
    EXPECT_TRUE(scaleOnDevice(context(), test_shaders::kScaleStorageComp, from) == scaleOnHost(from, 2));
}

TEST_F(Compute, SpecialisationConstantsMakeTheirOwnPipeline)
{
    const std::vector<u32> from = numbers(100);
    EXPECT_EQ(scaleOnDevice(context(), test_shaders::kScaleComp, from, {{0, 5}}), scaleOnHost(from, 5));
    const u32 pipelines = context().pipelines().size();
    EXPECT_EQ(scaleOnDevice(context(), test_shaders::kScaleComp, from, {{0, 7}}), scaleOnHost(from, 7));
    EXPECT_EQ(context().pipelines().size(), pipelines + 1);
    EXPECT_EQ(scaleOnDevice(context(), test_shaders::kScaleComp, from, {{0, 5}}), scaleOnHost(from, 5));
    EXPECT_EQ(context().pipelines().size(), pipelines + 1) << "known pipelines are used again";
}

struct StepParams
{
    u32 count;
    u32 from;
    u32 to;
};

/// The same as step.comp, `steps` times, from one half to the other and back.
std::vector<u32> stepOnHost(std::vector<u32> values, u32 count, u32 steps)
{
    for (u32 step = 0; step < steps; ++step) {
        const u32 from = step % 2 * count;
        const u32 to = count - from;
        for (u32 i = 0; i < count; ++i) values[to + i] = 2 * values[from + i] + values[from + (i + 1) % count];
    }
    return values;
}

TEST_F(Compute, DispatchesInOnePassSeeEachOtherAfterABarrier)
{
    constexpr u32 kCount = 1000;
    constexpr u32 kSteps = 9;
    std::vector<u32> values = numbers(2 * kCount);
    const Buffer buffer = makeBuffer(context(), "values", values);
    FrameGraph graph("steps");
    graph.addPass("steps", [&](PassBuilder& pass) {
        const Ref<Buffer> both = pass.write(pass.import(buffer), Use::ComputeReadWrite);
        pass.record([=](PassContext& ctx) {
            for (u32 step = 0; step < kSteps; ++step) {
                if (step > 0) ctx.barrier();
                const u32 from = step % 2 * kCount;
                ctx.dispatch(test_shaders::kStepComp, {storage(0, both)}, StepParams{kCount, from, kCount - from},
                             groupsFor(kCount, 64));
            }
        });
    });
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorder(context());
    recorder.begin();
    graph.execute(recorder);
    recorder.submitAndWait();
    EXPECT_EQ(downloadItems<u32>(context(), buffer), stepOnHost(values, kCount, kSteps));
}

TEST_F(Compute, ManyDispatchesNeedManyDescriptorSets)
{
    // More than one descriptor pool holds, twice, so that pools are used again.
    constexpr u32 kCount = 64;
    constexpr u32 kSteps = 601;
    const std::vector<u32> values = numbers(2 * kCount);
    Recorder recorder(context());
    for (int round = 0; round < 2; ++round) {
        const Buffer buffer = makeBuffer(context(), "values", values);
        FrameGraph graph("steps");
        Ref<Buffer> both = graph.import(buffer);
        for (u32 step = 0; step < kSteps; ++step) {
            both = graph.addPass("step", [&](PassBuilder& pass) {
                const Ref<Buffer> next = pass.write(both, Use::ComputeReadWrite);
                pass.record([=](PassContext& ctx) {
                    const u32 from = step % 2 * kCount;
                    ctx.dispatch(test_shaders::kStepComp, {storage(0, next)}, StepParams{kCount, from, kCount - from},
                                 Groups{});
                });
                return next;
            });
        }
        ASSERT_TRUE(graph.compile(context()));
        recorder.begin();
        graph.execute(recorder);
        recorder.submitAndWait();
        EXPECT_EQ(downloadItems<u32>(context(), buffer), stepOnHost(values, kCount, kSteps)) << round;
    }
}

} // namespace
} // namespace helio
