// SPDX-License-Identifier: Apache-2.0
// values[i] = 2 values[i] + values of the neighbour to the right, from one half of a buffer to the other.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;
layout(scalar, binding = 0) buffer Values { uint values[]; };
layout(push_constant, scalar) uniform Params { uint count; uint from; uint to; };

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i < count) values[to + i] = 2 * values[from + i] + values[from + (i + 1) % count];
}
