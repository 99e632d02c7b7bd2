// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/context.h"

#include "tests/support/gpu_fixture.h"

namespace helio {
namespace {

using ContextTest = GpuTest;

TEST_F(ContextTest, ReportsTheDevice)
{
    const DeviceFacts& facts = context().facts();
    EXPECT_FALSE(facts.name.empty());
    EXPECT_NE(context().describe().find(facts.name), std::string::npos);
    EXPECT_GE(facts.subgroupSize, 1u);
    // Minima of the specification, Vulkan 1.3, table "Required Limits".
    EXPECT_GE(facts.maxPushConstantBytes, 128u);
    EXPECT_GE(facts.maxTexelBufferElements, 65536u);
    EXPECT_GE(facts.maxStorageBufferBytes, u64(1) << 27);
    EXPECT_GE(facts.maxDispatchGroups, 65535u);
}

TEST_F(ContextTest, AnUnknownDeviceIsRefusedWithTheListOfNames)
{
    ContextOptions options;
    options.device = "no such device";
    const auto made = Context::create(options);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().message.find("no Vulkan device has 'no such device' in its name; there are: '"), 0u)
        << made.error().message;
    EXPECT_NE(made.error().message.find(context().facts().name), std::string::npos);
}

TEST_F(ContextTest, ADeviceIsFoundByPartOfItsName)
{
    ContextOptions options;
    options.device = context().facts().name.substr(1);
    const auto made = Context::create(options);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ((*made)->facts().name, context().facts().name);
    EXPECT_FALSE((*made)->validating());
}

TEST_F(ContextTest, TheTexelLimitCanBeLowered)
{
    ContextOptions options;
    options.texelElementLimit = 1000;
    const auto made = Context::create(options);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE((*made)->texelsFit(1000));
    EXPECT_FALSE((*made)->texelsFit(1001));
    EXPECT_TRUE(context().texelsFit(1001));
}

TEST_F(ContextTest, AFailingSurfaceIsAnError)
{
    ContextOptions options;
    options.makeSurface = [](VkInstance, VkSurfaceKHR*) { return VK_ERROR_INITIALIZATION_FAILED; };
    const auto made = Context::create(options);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().message, "cannot make a window surface: VK_ERROR_INITIALIZATION_FAILED");
}

} // namespace
} // namespace helio
