// SPDX-License-Identifier: Apache-2.0
// The shader compile tool: what it accepts, how it reports mistakes, what it reads out of SPIR-V.
#include <filesystem>
#include <gtest/gtest.h>

#include "city/base/file.h"
#include "shaders/compile/glsl_compiler.h"
#include "shaders/compile/spirv_reader.h"

namespace helio {
namespace {

class ShaderCompile : public testing::Test
{
protected:
    void SetUp() override
    {
        folder_ =
            std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
        std::filesystem::create_directories(folder_ / "lib");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& text)
    {
        EXPECT_TRUE(writeTextAtomically(folder_ / name, text));
        return (folder_ / name).string();
    }
    Result<CompiledShader> compile(const std::string& text, std::vector<std::string> defines = {})
    {
        return compileGlsl({write("test.comp", text), {folder_.string()}, std::move(defines)});
    }

    std::filesystem::path folder_;
};

constexpr const char* kHead = "#version 460\nlayout(local_size_x = 8) in;\n";

TEST_F(ShaderCompile, AMistakeIsReportedWithFileAndLine)
{
    const auto compiled = compile(std::string(kHead) + "void main()\n{\n    nonsense = 1;\n}\n");
    ASSERT_FALSE(compiled);
    EXPECT_EQ(compiled.error().message.find((folder_ / "test.comp").string() + ":5: error: 'nonsense'"), 0u)
        << compiled.error().message;
}

TEST_F(ShaderCompile, AMistakeInAnIncludeIsReportedThere)
{
    write("lib/broken.glsl", "\nfloat f() { return g; }\n");
    const auto compiled = compile(std::string(kHead) + "#include \"lib/broken.glsl\"\nvoid main() {}\n");
    ASSERT_FALSE(compiled);
    EXPECT_NE(compiled.error().message.find("lib/broken.glsl:2: error: 'g'"), std::string::npos)
        << compiled.error().message;
}

TEST_F(ShaderCompile, AMissingIncludeIsNamed)
{
    const auto compiled = compile(std::string(kHead) + "#include \"lib/nowhere.glsl\"\nvoid main() {}\n");
    ASSERT_FALSE(compiled);
    EXPECT_NE(compiled.error().message.find("test.comp:3: error: "), std::string::npos) << compiled.error().message;
    EXPECT_NE(compiled.error().message.find("lib/nowhere.glsl"), std::string::npos) << compiled.error().message;
}

TEST_F(ShaderCompile, IncludesAreListedOnceAlsoNestedOnes)
{
    write("lib/outer.glsl", "#include \"inner.glsl\"\n");
    write("lib/inner.glsl", "#ifndef INNER\n#define INNER\nconst uint kInner = 3;\n#endif\n");
    const auto compiled =
        compile(std::string(kHead) + "#include \"lib/outer.glsl\"\n#include \"lib/inner.glsl\"\nvoid main() {}\n");
    ASSERT_TRUE(compiled) << compiled.error().message;
    EXPECT_EQ(compiled->includes,
              (std::vector<std::string>{(folder_ / "lib/inner.glsl").string(), (folder_ / "lib/outer.glsl").string()}));
}

TEST_F(ShaderCompile, DefinitionsReachTheShader)
{
    const std::string text =
        std::string(kHead) + "#if FIRST != 7 || !defined(SECOND)\n#error no\n#endif\nvoid main() {}\n";
    EXPECT_TRUE(compile(text, {"FIRST=7", "SECOND"}));
    EXPECT_FALSE(compile(text, {"FIRST=8", "SECOND"}));
}

TEST_F(ShaderCompile, ItMakesSpirv16)
{
    const auto compiled = compile(std::string(kHead) + "void main() {}\n");
    ASSERT_TRUE(compiled);
    ASSERT_GT(compiled->words.size(), 5u);
    EXPECT_EQ(compiled->words[1], 0x00010600u); // the version word of SPIR-V 1.6
}

TEST_F(ShaderCompile, UnknownStagesAreRefused)
{
    const auto compiled = compileGlsl({write("test.geom", "void main() {}"), {}, {}});
    ASSERT_FALSE(compiled);
    EXPECT_NE(compiled.error().message.find("unknown shader stage '.geom'"), std::string::npos);
}

TEST_F(ShaderCompile, KindsOfBindingsAreRead)
{
    const auto compiled = compile(std::string(kHead) + R"(
layout(binding = 4) buffer B { uint b[]; };
layout(binding = 0) uniform usamplerBuffer t;
layout(binding = 1) uniform textureBuffer u;
layout(binding = 2, r32ui) uniform uimage2D i;
layout(binding = 3) uniform sampler2DArrayShadow s;
layout(binding = 5, r32ui) uniform readonly uimageBuffer w;
layout(binding = 6) uniform U { uint x; };
layout(push_constant) uniform P { vec4 a; mat4 m; float c[3]; };
void main()
{
    b[0] = texelFetch(t, 0).x + uint(texelFetch(u, 0).x) + imageLoad(i, ivec2(0)).x;
    b[1] = uint(texture(s, vec4(0)) + a.x + m[0][0] + c[2]) + imageLoad(w, 0).x + x;
})");
    ASSERT_TRUE(compiled) << compiled.error().message;
    const auto module = readSpirv(compiled->words);
    ASSERT_TRUE(module) << module.error().message;
    const BindingKind kinds[] = {BindingKind::UniformTexelBuffer, BindingKind::UniformTexelBuffer,
                                 BindingKind::StorageImage,       BindingKind::SampledImage,
                                 BindingKind::StorageBuffer,      BindingKind::StorageTexelBuffer,
                                 BindingKind::UniformBlock};
    ASSERT_EQ(module->bindings.size(), 7u);
    for (u32 i = 0; i < 7; ++i) {
        EXPECT_EQ(module->bindings[i].binding, i);
        EXPECT_EQ(module->bindings[i].kind, kinds[i]) << i;
    }
    EXPECT_EQ(module->pushBytes, 16u + 64u + 3u * 4u);
}

TEST_F(ShaderCompile, WhatPipelinesDoNotServeIsRefused)
{
    const std::pair<const char*, const char*> cases[] = {
        {"layout(set = 1, binding = 0) buffer B { uint x; };\nvoid main() { x = 1; }", "descriptor set 0"},
        {"layout(binding = 0) buffer A { uint x; };\nlayout(binding = 0) buffer B { uint y; };\nvoid main() { x = y; }",
         "two resources have binding 0"},
        {"layout(binding = 0) uniform sampler2D s[2];\nvoid main() { vec4 c = texture(s[1], vec2(0)); }",
         "array of descriptors"},
        {"layout(push_constant) uniform P { vec4 big[9]; };\nvoid main() { vec4 c = big[8]; }",
         "144 bytes of push constants"},
    };
    for (const auto& [text, reason] : cases) {
        const auto compiled = compile(std::string(kHead) + text);
        ASSERT_TRUE(compiled) << compiled.error().message;
        const auto module = readSpirv(compiled->words);
        ASSERT_FALSE(module) << text;
        EXPECT_NE(module.error().message.find(reason), std::string::npos) << module.error().message;
    }
}

} // namespace
} // namespace helio
