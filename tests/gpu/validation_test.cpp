// SPDX-License-Identifier: Apache-2.0
// Proves that the checker of all other GPU tests can fail: planted mistakes are caught.
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "test_shaders/embedded.h"
#include "tests/support/gpu_fixture.h"

namespace helio {
namespace {

using Validation = GpuTest;

bool anyContains(const std::vector<std::string>& messages, const std::string& part)
{
    for (const std::string& message : messages) {
        if (message.find(part) != std::string::npos) return true;
    }
    return false;
}

enum class Plant
{
    Nothing,
    FillThenRead,
    DispatchThenRead
};

/// Two steps in one pass, the second of which reads what the first one wrote; with the barrier between, or planted
/// without. (The layer overlooks two writes through descriptors on purpose, so each plant is a read after a write.)
void runPlanted(Context& context, Plant plant)
{
    const u64 bytes = 64 * sizeof(u32);
    const Buffer a = makeBuffer(context, "a", std::vector<u32>(64, 1));
    const Buffer b = makeBuffer(context, "b", std::vector<u32>(64, 1));
    const Buffer c(context, {"c", bytes});
    FrameGraph graph;
    graph.addPass("fill, scale, scale", [&](PassBuilder& pass) {
        const Ref<Buffer> first = pass.write(pass.write(pass.import(a), Use::CopyTo), Use::ComputeReadWrite);
        const Ref<Buffer> second = pass.write(pass.import(b), Use::ComputeReadWrite);
        const Ref<Buffer> third = pass.write(pass.import(c), Use::ComputeReadWrite);
        pass.record([=](PassContext& ctx) {
            ctx.fill(first, 5);
            if (plant != Plant::FillThenRead) ctx.barrier();
            ctx.dispatch(test_shaders::kScaleStorageComp, {storage(0, first), storage(1, second)}, 64u, Groups{});
            if (plant != Plant::DispatchThenRead) ctx.barrier();
            ctx.dispatch(test_shaders::kScaleStorageComp, {storage(0, second), storage(1, third)}, 64u, Groups{});
        });
    });
    ASSERT_TRUE(graph.compile(context));
    Recorder recorder(context);
    recorder.begin();
    graph.execute(recorder);
    recorder.submitAndWait();
}

TEST_F(Validation, AMissingBarrierAfterAFillIsCaught)
{
    runPlanted(context(), Plant::FillThenRead);
    EXPECT_TRUE(anyContains(takeMessages(), "SYNC-HAZARD-READ-AFTER-WRITE"));
}

TEST_F(Validation, AMissingBarrierBetweenDispatchesIsCaught)
{
    runPlanted(context(), Plant::DispatchThenRead);
    EXPECT_TRUE(anyContains(takeMessages(), "SYNC-HAZARD-READ-AFTER-WRITE"));
}

TEST_F(Validation, WithTheBarriersItIsSilent)
{
    runPlanted(context(), Plant::Nothing);
    EXPECT_EQ(context().messages().count(), 0u);
}

TEST_F(Validation, AWrongCallIsCaught)
{
    // A copy beyond the end of the source: VUID-vkCmdCopyBuffer-srcOffset-00113.
    const Buffer from(context(), {"from", 64});
    const Buffer to(context(), {"to", 256});
    Recorder recorder(context());
    recorder.begin();
    const VkBufferCopy region{128, 0, 16};
    vkCmdCopyBuffer(recorder.commands(), from.handle(), to.handle(), 1, &region);
    EXPECT_TRUE(anyContains(takeMessages(), "VUID-vkCmdCopyBuffer-srcOffset-00113"));
}

} // namespace
} // namespace helio
