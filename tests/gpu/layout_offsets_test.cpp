// SPDX-License-Identifier: Apache-2.0
// The bytes of every struct in shaders/shared, as the built SPIR-V says, against the C++ compiler's. No device.
#include <filesystem>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <sstream>

#include "city/base/file.h"
#include "shaders/compile/spirv_reader.h"
#include "shaders/embedded.h"
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"
#include "shaders/shared/sun.h"
#include "shaders/shared/view.h"
#include "test_shaders/embedded.h"

namespace helio {
namespace {

struct HostLayout
{
    u32 bytes = 0;
    std::vector<std::pair<std::string, u32>> members; // name, offset
};

// offsetof is only conditionally supported on types with GLM members; every compiler in use supports it, and says so.
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
// clang-format off
#define HELIO_AT(member) {#member, u32(offsetof(Type, member))}
#define HELIO_LAYOUT(Name, ...) \
    {#Name, []() -> HostLayout { using Type = gpu::Name; return {u32(sizeof(Type)), {__VA_ARGS__}}; }()}
// clang-format on

const std::map<std::string, HostLayout> kHost{
#include "layout_table.inc" // made from the headers' text at build time
};

/// Names of the structs between HELIO_SHARED_BEGIN and HELIO_SHARED_END of all shared headers.
std::set<std::string> structsInHeaders()
{
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(HELIO_SHADER_SOURCES)) {
        const Result<std::string> text = readTextFile(entry.path());
        EXPECT_TRUE(text) << text.error().message;
        std::istringstream lines(*text);
        for (std::string line; std::getline(lines, line);) {
            if (line.rfind("struct ", 0) == 0) names.insert(line.substr(7, line.find_first_of(" {", 7) - 7));
        }
    }
    return names;
}

/// GLSL cannot name a member after one of its keywords; interop.h gives such a name an underscore there.
std::string hostName(std::string name)
{
    if (!name.empty() && name.back() == '_') name.pop_back();
    return name;
}

TEST(LayoutOffsets, EverySharedStructIsInTheTable)
{
    std::set<std::string> inTable;
    for (const auto& [name, layout] : kHost) inTable.insert(name);
    EXPECT_EQ(structsInHeaders(), inTable);
}

TEST(LayoutOffsets, TheDeviceSeesTheHostsBytes)
{
    std::vector<const ShaderCode*> shaders(shaders::all().begin(), shaders::all().end());
    shaders.insert(shaders.end(), test_shaders::all().begin(), test_shaders::all().end());
    std::set<std::string> seen;
    for (const ShaderCode* shader : shaders) {
        const Result<SpirvModule> module = readSpirv(shader->words);
        ASSERT_TRUE(module) << shader->name << ": " << module.error().message;
        for (const SpirvStruct& device : module->structs) {
            const auto found = kHost.find(device.name);
            // Copies in local variables have no layout.
            if (found == kHost.end() || device.members.empty() || device.members[0].offset == kNoIndex) continue;
            SCOPED_TRACE(std::string(shader->name) + ", " + device.name);
            const HostLayout& host = found->second;
            ASSERT_EQ(device.members.size(), host.members.size());
            for (size_t i = 0; i < host.members.size(); ++i) {
                EXPECT_EQ(hostName(device.members[i].name), host.members[i].first);
                EXPECT_EQ(device.members[i].offset, host.members[i].second) << host.members[i].first;
            }
            const SpirvMember& last = device.members.back();
            EXPECT_EQ(last.offset + last.bytes, host.bytes) << "trailing bytes: pad the struct explicitly";
            if (device.stride > 0) {
                EXPECT_EQ(device.stride, host.bytes) << "stride of its arrays";
            }
            seen.insert(device.name);
        }
    }
    for (const auto& [name, layout] : kHost) {
        EXPECT_TRUE(seen.count(name)) << name << " is in no shader: add it to tests/gpu/shaders/layout_probe.comp";
    }
}

TEST(LayoutOffsets, ArraysInsideStructsAreTight)
{
    const Result<SpirvModule> module = readSpirv(test_shaders::kLayoutProbeComp.words);
    ASSERT_TRUE(module);
    for (const SpirvStruct& device : module->structs) {
        if (device.name != "InstanceRecord") continue;
        EXPECT_EQ(device.members[0].arrayStride, sizeof(glm::vec4));
        EXPECT_EQ(device.members[0].bytes, sizeof(gpu::InstanceRecord::worldFromLocal));
        return;
    }
    FAIL() << "InstanceRecord is not in the probe";
}

TEST(SpirvReader, BadInputIsRefused)
{
    const std::vector<u32> good(test_shaders::kLayoutProbeComp.words.begin(),
                                test_shaders::kLayoutProbeComp.words.end());
    EXPECT_FALSE(readSpirv({}));
    std::vector<u32> noMagic = good;
    noMagic[0] = 1;
    EXPECT_FALSE(readSpirv(noMagic));
    // Every cut inside an instruction is seen; a cut between two is a shorter module, which is not this reader's
    // business.
    std::vector<u32> cut(good.begin(), good.begin() + 6);
    const Result<SpirvModule> module = readSpirv(cut);
    ASSERT_FALSE(module);
    EXPECT_EQ(module.error().message, "truncated SPIR-V: instruction at word 5");
    std::vector<u32> zeroLength = good;
    zeroLength[5] &= 0xFFFFu;
    EXPECT_FALSE(readSpirv(zeroLength));
}

TEST(SpirvReader, ReadsBindingsAndPushConstants)
{
    const ShaderCode& scale = test_shaders::kScaleComp;
    ASSERT_EQ(scale.bindings.size(), 2u);
    EXPECT_EQ(scale.bindings[0].kind, BindingKind::UniformTexelBuffer);
    EXPECT_EQ(scale.bindings[1].kind, BindingKind::StorageBuffer);
    EXPECT_EQ(scale.pushBytes, 4u);
    EXPECT_EQ(test_shaders::kScaleStorageComp.bindings[0].kind, BindingKind::StorageBuffer);
    EXPECT_EQ(test_shaders::kCompareComp.bindings[0].kind, BindingKind::SampledImage);
    EXPECT_EQ(test_shaders::kCompareComp.pushBytes, 8u);
    EXPECT_EQ(test_shaders::kStepComp.pushBytes, 12u);
    EXPECT_TRUE(test_shaders::kTrianglesFrag.bindings.empty());
    EXPECT_EQ(test_shaders::kTrianglesFrag.pushBytes, 0u);
    EXPECT_EQ(test_shaders::kTrianglesVert.stage, ShaderStage::Vertex);
}

} // namespace
} // namespace helio
