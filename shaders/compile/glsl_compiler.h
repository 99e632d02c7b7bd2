// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "city/base/result.h"
#include "shaders/shader_code.h"

namespace helio {

struct GlslSource
{
    std::string path;
    std::vector<std::string> includeFolders; // searched in order, after the folder of the including file
    std::vector<std::string> defines;        // NAME or NAME=VALUE
};

struct CompiledShader
{
    ShaderStage stage = ShaderStage::Compute;
    std::vector<u32> words;
    std::vector<std::string> includes; // every file that was included, sorted
};

/// Compiles GLSL for Vulkan 1.3 to SPIR-V 1.6 without debug information. The stage follows from the extension: .comp,
/// .vert, .frag. The error holds one line a mistake, "file:line: error: what".
Result<CompiledShader> compileGlsl(const GlslSource& source);

} // namespace helio
