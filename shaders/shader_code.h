// SPDX-License-Identifier: Apache-2.0
// What the build embeds of one shader: its SPIR-V and what the shader compile tool read out of it.
#pragma once
#include <span>

#include "city/base/types.h"

namespace helio {

enum class ShaderStage : u32
{
    Compute,
    Vertex,
    Fragment
};

enum class BindingKind : u32
{
    StorageBuffer,      // buffer { ... }
    UniformBlock,       // uniform { ... }
    StorageTexelBuffer, // imageBuffer, uimageBuffer, iimageBuffer
    UniformTexelBuffer, // samplerBuffer, usamplerBuffer, isamplerBuffer
    SampledImage,       // sampler2D, sampler2DArray, sampler2DShadow, usampler2D, ...
    StorageImage,       // image2D, uimage2D, ...
};

/// One descriptor of set 0, the only set in use.
struct ShaderBinding
{
    u32 binding;
    BindingKind kind;
};

/// An embedded shader; entry point "main". Objects of this type have static storage, so their address is their
/// identity.
struct ShaderCode
{
    const char* name; // source file (and variant), for messages and debug names
    ShaderStage stage;
    std::span<const u32> words;              // SPIR-V 1.6
    std::span<const ShaderBinding> bindings; // ascending
    u32 pushBytes;                           // size of the push constant block, 0 = none
};

} // namespace helio
