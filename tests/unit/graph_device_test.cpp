// SPDX-License-Identifier: Apache-2.0
// What the device layer decides without a device: who is refused, how failures end, how work is split into groups.
#include <gtest/gtest.h>

#include "engine/gpu/device_features.h"
#include "engine/gpu/recorder.h"
#include "engine/gpu/vk_check.h"

namespace helio {
namespace {

DeviceFacts completeDevice()
{
    DeviceFacts facts;
    facts.maxStageStorageBuffers = 16;
    facts.name = "Testdevice";
    facts.apiVersion = VK_API_VERSION_1_3;
    facts.dynamicRendering = facts.synchronization2 = facts.maintenance4 = facts.scalarBlockLayout = true;
    facts.subgroupBallot = facts.subgroupArithmetic = facts.graphicsAndComputeQueue = true;
    return facts;
}

TEST(DeviceFeatures, ACompleteDeviceServes)
{
    EXPECT_EQ(whyRefused(completeDevice()), "");
}

TEST(DeviceFeatures, OptionalFeaturesDoNotMatter)
{
    DeviceFacts facts = completeDevice();
    facts.multiDrawIndirect = facts.fragmentStoresAndAtomics = facts.depthClamp = false;
    facts.maxTexelBufferElements = 65536;
    facts.timestampPeriodNs = 0;
    EXPECT_EQ(whyRefused(facts), "");
}

TEST(DeviceFeatures, EachMissingFeatureIsNamedWithItsReason)
{
    const std::vector<std::pair<std::string, void (*)(DeviceFacts&)>> cases{
        {"Vulkan 1.3", [](DeviceFacts& f) { f.apiVersion = VK_API_VERSION_1_2; }},
        {"dynamicRendering", [](DeviceFacts& f) { f.dynamicRendering = false; }},
        {"synchronization2", [](DeviceFacts& f) { f.synchronization2 = false; }},
        {"maintenance4", [](DeviceFacts& f) { f.maintenance4 = false; }},
        {"scalarBlockLayout", [](DeviceFacts& f) { f.scalarBlockLayout = false; }},
        {"subgroup ballot in compute", [](DeviceFacts& f) { f.subgroupBallot = false; }},
        {"subgroup arithmetic in compute", [](DeviceFacts& f) { f.subgroupArithmetic = false; }},
        {"twelve storage buffers in one shader", [](DeviceFacts& f) { f.maxStageStorageBuffers = 11; }},
        {"a queue with graphics and compute", [](DeviceFacts& f) { f.graphicsAndComputeQueue = false; }},
    };
    ASSERT_EQ(cases.size(), requiredFeatures().size()) << "a required feature has no case here";
    for (size_t i = 0; i < cases.size(); ++i) {
        DeviceFacts facts = completeDevice();
        cases[i].second(facts);
        const std::string sentence = whyRefused(facts);
        EXPECT_EQ(sentence.find("device 'Testdevice' lacks " + cases[i].first + ": "), 0u) << sentence;
        EXPECT_NE(sentence.find(requiredFeatures()[i].reason), std::string::npos) << sentence;
    }
}

TEST(VkCheckDeathTest, AFailureEndsWithCodeTwoAndSaysWhat)
{
    EXPECT_EXIT(vkCheck(VK_ERROR_OUT_OF_DEVICE_MEMORY, "buffer 'links' of ", 12, " bytes"), testing::ExitedWithCode(2),
                "device error: buffer 'links' of 12 bytes: VK_ERROR_OUT_OF_DEVICE_MEMORY");
    setFailureNote(std::make_shared<const std::string>("digraph \"frame\""));
    EXPECT_EXIT(vkCheck(VK_ERROR_DEVICE_LOST, "wait"), testing::ExitedWithCode(2),
                "VK_ERROR_DEVICE_LOST\ndigraph \"frame\"");
    setFailureNote(nullptr);
}

TEST(Groups, CoverTheItemsAndStayInTheLimit)
{
    for (const u64 items : {u64(1), u64(63), u64(64), u64(65), u64(65535) * 64, u64(65535) * 64 + 1, u64(1) << 30}) {
        const Groups groups = groupsFor(items, 64);
        EXPECT_LE(groups.x, 65535u);
        EXPECT_LE(groups.y, 65535u);
        const u64 covered = u64(groups.x) * groups.y * 64;
        EXPECT_GE(covered, items);
        EXPECT_LT(covered, items + u64(64) * groups.y) << "less than one group a row is idle";
    }
    EXPECT_EQ(groupsFor(65535 * 64, 64).y, 1u);
    EXPECT_EQ(groupsFor(65535 * 64 + 1, 64).y, 2u);
    EXPECT_EQ(groupsFor2D(17, 8, 8, 8).x, 3u);
    EXPECT_EQ(groupsFor2D(17, 8, 8, 8).y, 1u);
}

} // namespace
} // namespace helio
