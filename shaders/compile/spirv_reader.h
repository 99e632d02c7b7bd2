// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "city/base/result.h"
#include "shaders/shader_code.h"

namespace helio {

struct SpirvMember
{
    std::string name;
    u32 offset = kNoIndex; // bytes; kNoIndex = not decorated
    u32 bytes = 0;         // 0 for runtime arrays
    u32 arrayStride = 0;   // bytes, arrays only
    u32 matrixStride = 0;  // bytes, matrices (and arrays of them) only
};

/// A structure type of a module. One GLSL struct may appear several times, once per layout.
struct SpirvStruct
{
    std::string name;
    std::vector<SpirvMember> members;
    u32 stride = 0; // of the arrays of it in the module (the largest found); 0 = none
};

struct SpirvModule
{
    std::vector<ShaderBinding> bindings; // ascending
    u32 pushBytes = 0;
    std::vector<SpirvStruct> structs; // in the order of their ids
};

/// Reads what pipelines and tests need out of a SPIR-V module with one entry point. Errors: not SPIR-V, truncated, a
/// descriptor set other than 0, a descriptor that we do not use (uniform blocks, separate images, arrays of
/// descriptors), push constants over 128 bytes.
Result<SpirvModule> readSpirv(std::span<const u32> words);

} // namespace helio
