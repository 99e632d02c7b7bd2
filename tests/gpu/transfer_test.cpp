// SPDX-License-Identifier: Apache-2.0
#include <numeric>

#include "engine/gpu/transfer.h"
#include "tests/support/gpu_fixture.h"

namespace helio {
namespace {

using Transfer = GpuTest;

std::vector<u32> pattern(size_t count)
{
    std::vector<u32> items(count);
    std::iota(items.begin(), items.end(), 0x12340000u);
    return items;
}

TEST_F(Transfer, BuffersComeBackAsTheyWent)
{
    for (const size_t count : {size_t(1), size_t(3), size_t(257), size_t(10007)}) {
        const std::vector<u32> items = pattern(count);
        const Buffer buffer = makeBuffer(context(), "items", items);
        EXPECT_EQ(downloadItems<u32>(context(), buffer), items) << count;
    }
}

TEST_F(Transfer, LargeBuffersGoInPieces)
{
    const std::vector<u32> items = pattern((size_t(32) << 18) + 5); // 32 MiB and 20 bytes: two pieces
    const Buffer buffer = makeBuffer(context(), "items", items);
    EXPECT_TRUE(downloadItems<u32>(context(), buffer) == items);
}

TEST_F(Transfer, PartsLeaveTheRestAlone)
{
    const Buffer buffer = makeBuffer(context(), "items", std::vector<u32>{1, 2, 3, 4, 5});
    upload(context(), buffer, std::vector<u32>{9, 8}, 2 * sizeof(u32));
    EXPECT_EQ(downloadItems<u32>(context(), buffer), (std::vector<u32>{1, 2, 9, 8, 5}));
    EXPECT_EQ(asItems<u32>(download(context(), buffer, 4, 8)), (std::vector<u32>{2, 9}));
}

TEST_F(Transfer, AnEmptyListIsOneZeroItem)
{
    const Buffer buffer = makeBuffer(context(), "nothing", std::vector<u64>{});
    EXPECT_EQ(downloadItems<u64>(context(), buffer), std::vector<u64>{0});
}

TEST_F(Transfer, MovedBuffersKeepTheirContents)
{
    Buffer first = makeBuffer(context(), "items", std::vector<u32>{7, 8});
    Buffer second = std::move(first);
    EXPECT_EQ(first.handle(), VkBuffer(VK_NULL_HANDLE));
    EXPECT_EQ(downloadItems<u32>(context(), second), (std::vector<u32>{7, 8}));
    second = makeBuffer(context(), "others", std::vector<u32>{5});
    EXPECT_EQ(downloadItems<u32>(context(), second), std::vector<u32>{5});
}

TEST_F(Transfer, ImageLayersComeBackAsTheyWent)
{
    const Image image(context(),
                      {"ids", 33, 17, VK_FORMAT_R32_UINT, 3,
                       VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    std::vector<std::vector<u32>> layers;
    for (u32 layer = 0; layer < 3; ++layer) {
        layers.push_back(pattern(33 * 17));
        layers.back()[layer] = layer;
        uploadImage(context(), image, std::as_bytes(std::span(layers.back())), layer);
    }
    for (u32 layer = 0; layer < 3; ++layer)
        EXPECT_EQ(downloadTexels<u32>(context(), image, layer), layers[layer]) << layer;
}

TEST_F(Transfer, HostBuffersAreMapped)
{
    const Buffer host(context(), {"host", 16, Memory::Upload});
    ASSERT_NE(host.mapped(), nullptr);
    const u32 items[4] = {1, 2, 3, 4};
    std::memcpy(host.mapped(), items, sizeof(items));
    host.flush();
    EXPECT_EQ(downloadItems<u32>(context(), host), (std::vector<u32>{1, 2, 3, 4}));
}

} // namespace
} // namespace helio
