// SPDX-License-Identifier: Apache-2.0
// Barriers as a function of access lists. Expectations follow from the Vulkan specification, chapter 7: a read waits
// for the last write, a write waits for the last write and for all reads since.
#include <gtest/gtest.h>

#include "engine/graph/barriers.h"

namespace helio {
namespace {

constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr auto kFragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr auto kTransfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
constexpr auto kColor = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr auto kStorageWrite = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
constexpr auto kStorageRead = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;

std::vector<std::vector<Barrier>> barriersOf(std::vector<Use> uses, bool image, AccessState* state = nullptr)
{
    AccessState fresh;
    std::vector<std::vector<Access>> passes;
    for (const Use use : uses) passes.push_back({accessOf(0, image, use)});
    return deriveBarriers(std::span(state ? state : &fresh, 1), passes);
}

TEST(GraphBarriers, TheFirstUseOfABufferNeedsNone)
{
    EXPECT_TRUE(barriersOf({Use::ComputeWrite}, false)[0].empty());
    EXPECT_TRUE(barriersOf({Use::Index}, false)[0].empty());
}

TEST(GraphBarriers, ReadAfterWriteFlushesAndWaits)
{
    const auto barriers = barriersOf({Use::ComputeWrite, Use::FragmentRead}, false);
    ASSERT_EQ(barriers[1].size(), 1u);
    EXPECT_EQ(barriers[1][0].srcStages, kCompute);
    EXPECT_EQ(barriers[1][0].srcAccess, kStorageWrite);
    EXPECT_EQ(barriers[1][0].dstStages, kFragment);
    EXPECT_TRUE(barriers[1][0].dstAccess & kStorageRead);
    EXPECT_FALSE(barriers[1][0].dstAccess & kStorageWrite);
}

TEST(GraphBarriers, ASecondReaderAtTheSameStageNeedsNone)
{
    const auto barriers = barriersOf({Use::ComputeWrite, Use::ComputeRead, Use::ComputeRead}, false);
    EXPECT_EQ(barriers[1].size(), 1u);
    EXPECT_TRUE(barriers[2].empty());
}

TEST(GraphBarriers, ASecondReaderAtAnotherStageWaitsForTheWriter)
{
    const auto barriers = barriersOf({Use::CopyTo, Use::ComputeRead, Use::FragmentRead}, false);
    ASSERT_EQ(barriers[2].size(), 1u);
    EXPECT_EQ(barriers[2][0].srcStages, kTransfer);
    EXPECT_EQ(barriers[2][0].srcAccess, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    EXPECT_EQ(barriers[2][0].dstStages, kFragment);
}

TEST(GraphBarriers, WriteAfterReadsWaitsForAllOfThem)
{
    const auto barriers = barriersOf({Use::CopyTo, Use::ComputeRead, Use::FragmentRead, Use::ComputeWrite}, false);
    ASSERT_EQ(barriers[3].size(), 1u);
    EXPECT_EQ(barriers[3][0].srcStages, kTransfer | kCompute | kFragment);
    EXPECT_EQ(barriers[3][0].dstStages, kCompute);
}

TEST(GraphBarriers, WriteAfterReadWithoutAnyWriteStillWaits)
{
    const auto barriers = barriersOf({Use::FragmentRead, Use::CopyTo}, false);
    ASSERT_EQ(barriers[1].size(), 1u);
    EXPECT_EQ(barriers[1][0].srcStages, kFragment);
    EXPECT_EQ(barriers[1][0].srcAccess, VK_ACCESS_2_NONE) << "reads leave nothing to flush";
}

TEST(GraphBarriers, WriteAfterWrite)
{
    const auto barriers = barriersOf({Use::CopyTo, Use::ComputeWrite}, false);
    ASSERT_EQ(barriers[1].size(), 1u);
    EXPECT_EQ(barriers[1][0].srcStages, kTransfer);
    EXPECT_EQ(barriers[1][0].srcAccess, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    EXPECT_EQ(barriers[1][0].dstAccess, kStorageWrite);
}

TEST(GraphBarriers, AtomicsWaitForAtomics)
{
    const auto barriers = barriersOf({Use::ComputeReadWrite, Use::ComputeReadWrite}, false);
    ASSERT_EQ(barriers[1].size(), 1u);
    EXPECT_TRUE(barriers[1][0].dstAccess & kStorageRead);
    EXPECT_TRUE(barriers[1][0].dstAccess & kStorageWrite);
}

TEST(GraphBarriers, ImagesChangeLayout)
{
    const auto barriers = barriersOf({Use::ColorTarget, Use::ComputeRead, Use::CopyFrom}, true);
    ASSERT_EQ(barriers[0].size(), 1u);
    EXPECT_EQ(barriers[0][0].oldLayout, VK_IMAGE_LAYOUT_UNDEFINED);
    EXPECT_EQ(barriers[0][0].newLayout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    ASSERT_EQ(barriers[1].size(), 1u);
    EXPECT_EQ(barriers[1][0].srcStages, kColor);
    EXPECT_EQ(barriers[1][0].oldLayout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    EXPECT_EQ(barriers[1][0].newLayout, VK_IMAGE_LAYOUT_GENERAL);
    ASSERT_EQ(barriers[2].size(), 1u);
    EXPECT_TRUE(barriers[2][0].srcStages & kCompute) << "the layout must not change under the reader before";
    EXPECT_EQ(barriers[2][0].newLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

TEST(GraphBarriers, AReaderAfterALayoutChangeWaitsForThatChange)
{
    // Both sample: the first reader's barrier changes the layout, the second must come after that change.
    const auto barriers = barriersOf({Use::ColorTarget, Use::ComputeSample, Use::FragmentSample}, true);
    ASSERT_EQ(barriers[2].size(), 1u);
    EXPECT_TRUE(barriers[2][0].srcStages & kCompute);
    EXPECT_EQ(barriers[2][0].oldLayout, barriers[2][0].newLayout);
}

TEST(GraphBarriers, ReadersInOneLayoutAndStageShareABarrier)
{
    const auto barriers = barriersOf({Use::DepthTarget, Use::FragmentSample, Use::FragmentSample}, true);
    EXPECT_EQ(barriers[1].size(), 1u);
    EXPECT_TRUE(barriers[2].empty());
}

TEST(GraphBarriers, OwnContentsMayBeDiscardedAtTheFirstUse)
{
    AccessState state;
    barriersOf({Use::ColorTarget, Use::ComputeRead}, true, &state);
    ASSERT_EQ(state.layout, VK_IMAGE_LAYOUT_GENERAL);
    Access again = accessOf(0, true, Use::ColorTarget);
    again.keepContents = false;
    const std::vector<Access> pass{again};
    const auto barriers = deriveBarriers(std::span(&state, 1), std::span(&pass, 1));
    ASSERT_EQ(barriers[0].size(), 1u);
    EXPECT_EQ(barriers[0][0].oldLayout, VK_IMAGE_LAYOUT_UNDEFINED);
    EXPECT_EQ(barriers[0][0].srcStages & kCompute, kCompute) << "but not before the last frame has read it";
}

TEST(GraphBarriers, StateLivesOnBetweenGraphs)
{
    // Graph one writes; graph two reads, twice: the second time nothing is to be waited for.
    AccessState state;
    barriersOf({Use::ComputeWrite}, false, &state);
    EXPECT_TRUE(state.defined);
    EXPECT_EQ(barriersOf({Use::FragmentRead}, false, &state)[0].size(), 1u);
    EXPECT_TRUE(barriersOf({Use::FragmentRead}, false, &state)[0].empty());
    EXPECT_EQ(barriersOf({Use::ComputeWrite}, false, &state)[0].size(), 1u);
}

TEST(GraphBarriers, AnAcquiredImageWaitsForItsSemaphore)
{
    const Image image;
    image.forget(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    const auto barriers = barriersOf({Use::ColorTarget, Use::Present}, true, &image.state());
    EXPECT_EQ(barriers[0][0].srcStages, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    EXPECT_EQ(barriers[0][0].oldLayout, VK_IMAGE_LAYOUT_UNDEFINED);
    EXPECT_EQ(barriers[1][0].newLayout, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    EXPECT_EQ(barriers[1][0].srcAccess, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
}

TEST(GraphBarriers, ResourcesDoNotMix)
{
    std::vector<AccessState> states(2);
    const std::vector<std::vector<Access>> passes{
        {accessOf(0, false, Use::ComputeWrite)},
        {accessOf(1, false, Use::ComputeRead)},
        {accessOf(0, false, Use::ComputeRead), accessOf(1, false, Use::CopyTo)}};
    const auto barriers = deriveBarriers(states, passes);
    EXPECT_TRUE(barriers[1].empty());
    ASSERT_EQ(barriers[2].size(), 2u);
    EXPECT_EQ(barriers[2][0].resource, 0u);
    EXPECT_EQ(barriers[2][1].resource, 1u);
}

TEST(GraphUses, TheTableHasSenseInEveryRow)
{
    for (u32 i = 0; i < kUseCount; ++i) {
        const UseInfo& info = useInfo(Use(i));
        SCOPED_TRACE(info.name);
        EXPECT_TRUE(info.buffers || info.layout != VK_IMAGE_LAYOUT_UNDEFINED) << "a use of nothing";
        EXPECT_TRUE(info.isWrite() || info.needsContents) << "a read needs contents";
        EXPECT_EQ(info.stages == VK_PIPELINE_STAGE_2_NONE, Use(i) == Use::Present);
        EXPECT_EQ(info.imageUsage != 0, info.layout != VK_IMAGE_LAYOUT_UNDEFINED && Use(i) != Use::Present);
    }
}

// The union of stages and of accesses that AccessState keeps is exact only if a stage reads in one way, in one layout.
TEST(GraphUses, OneStageReadsInOneWay)
{
    for (u32 i = 0; i < kUseCount; ++i) {
        for (u32 j = 0; j < kUseCount; ++j) {
            const UseInfo& a = useInfo(Use(i));
            const UseInfo& b = useInfo(Use(j));
            const bool bothRead = !a.isWrite() && !b.isWrite() && (a.stages & b.stages) != 0;
            if (bothRead && a.layout == b.layout) {
                EXPECT_EQ(a.reads, b.reads) << a.name << " and " << b.name;
            }
        }
    }
}

} // namespace
} // namespace helio
