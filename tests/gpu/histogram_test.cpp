// SPDX-License-Identifier: Apache-2.0
// Stage 2 against a count on the host: exact for every picture, in both variants.
#include "engine/stages/histogram.h"

#include "city/base/hash.h"
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage_twins.h"

namespace helio {

namespace {

TEST(StageTwins, CountsAPictureWrittenByHand)
{
    const std::vector<u32> ids{2, 2, 0, kNoIndex, 5, 2};
    EXPECT_EQ(twin::countIds(ids, 3), (std::vector<u32>{1, 0, 3}));
}

class HistogramTest : public GpuTest
{
protected:
    std::vector<u32> count(const std::vector<u32>& ids, u32 width, u32 height, u32 patchCount, HistogramVariant variant,
                           const std::vector<u32>& before)
    {
        const Image image(context(), {"ids", width, height, VK_FORMAT_R32_UINT, 1,
                                      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
        uploadImage(context(), image, std::as_bytes(std::span(ids)));
        const Buffer counts = makeBuffer(context(), "counts", before);
        FrameGraph graph("histogram");
        (void)addHistogram(graph, graph.import(image), graph.import(counts), width, height, patchCount, variant);
        const Status compiled = graph.compile(context());
        EXPECT_TRUE(compiled.ok());
        Recorder recorder(context());
        recorder.begin();
        graph.execute(recorder);
        recorder.submitAndWait();
        return downloadItems<u32>(context(), counts);
    }

    void expectExact(const std::vector<u32>& ids, u32 width, u32 height, u32 patchCount)
    {
        const std::vector<u32> expected = twin::countIds(ids, patchCount);
        const std::vector<u32> zero(patchCount, 0);
        EXPECT_EQ(count(ids, width, height, patchCount, HistogramVariant::Subgroups, zero), expected)
            << width << " x " << height << ", subgroups";
        EXPECT_EQ(count(ids, width, height, patchCount, HistogramVariant::Columns, zero), expected)
            << width << " x " << height << ", columns";
    }
};

TEST_F(HistogramTest, BackgroundIsNotCounted)
{
    expectExact(std::vector<u32>(256 * 192, kNoIndex), 256, 192, 7);
}

TEST_F(HistogramTest, OnePatchEverywhere)
{
    expectExact(std::vector<u32>(512 * 256, 3), 512, 256, 4);
}

TEST_F(HistogramTest, EveryTexelAnotherPatch)
{
    std::vector<u32> ids(300 * 200);
    for (u32 i = 0; i < ids.size(); ++i) ids[i] = i;
    expectExact(ids, 300, 200, u32(ids.size()));
}

TEST_F(HistogramTest, TheLastPatchCountsAndTheNextIsIgnored)
{
    std::vector<u32> ids(130 * 70, 9);
    for (u32 i = 0; i < ids.size(); i += 3) ids[i] = 10;
    ids[0] = 0xFFFFFFFEu;
    expectExact(ids, 130, 70, 10);
}

TEST_F(HistogramTest, SizesThatFillNoGroup)
{
    for (const auto& [width, height] :
         {std::pair(1u, 1u), {1u, 65u}, {65u, 1u}, {63u, 64u}, {64u, 63u}, {97u, 131u}, {257u, 66u}}) {
        std::vector<u32> ids(size_t(width) * height);
        Random random(width * 1000 + height);
        // Runs of random length, as in a picture, and background between them.
        u32 id = 0;
        for (u32& texel : ids) {
            if (random.uniform() < 0.2) id = u32(random.uniform() * 12.0);
            texel = id == 11 ? kNoIndex : id;
        }
        expectExact(ids, width, height, 11);
    }
}

TEST_F(HistogramTest, AddsToWhatOtherViewsCounted)
{
    const std::vector<u32> ids(64 * 64, 1);
    EXPECT_EQ(count(ids, 64, 64, 3, HistogramVariant::Columns, {5, 6, 7}), (std::vector<u32>{5, 6 + 64 * 64, 7}));
}

TEST_F(HistogramTest, TheFasterVariantIsOneOfTheTwo)
{
    const HistogramVariant variant = fasterHistogram(context());
    EXPECT_TRUE(variant == HistogramVariant::Columns || variant == HistogramVariant::Subgroups);
}

} // namespace

} // namespace helio
