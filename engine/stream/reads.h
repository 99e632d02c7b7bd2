// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/gpu/context.h"
#include "shaders/shader_code.h"

namespace helio {

/// How shaders read big arrays (shaders/lib/fetch.glsl). All give the same bits.
enum class Reads
{
    Texels,  ///< uniform texel buffers
    Images,  ///< storage texel buffers
    Storage, ///< storage buffers
};

/// The variants of one shader.
struct ReadVariants
{
    const ShaderCode& texels;
    const ShaderCode& images;
    const ShaderCode& storage;

    const ShaderCode& operator[](Reads reads) const
    {
        return reads == Reads::Texels ? texels : reads == Reads::Images ? images : storage;
    }
};

/// Does the device serve a way of reading, for arrays of so many elements?
bool canRead(const Context& context, Reads reads, u64 elements);

/// The fastest way on this device to load 16 bytes from scattered places of an array of `elements`: all that can hold
/// it load from a table of 1 MiB, three times each. Storage where the device has no timestamps.
Reads fastestReads(Context& context, u64 elements);

} // namespace helio
