// SPDX-License-Identifier: Apache-2.0
// to[i] = factor * from[i] + i. Reads through a texel buffer, or through a storage buffer in the variant.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(constant_id = 0) const uint factor = 2;
layout(local_size_x = 64) in;
#ifdef HELIO_STORAGE_READS
layout(scalar, binding = 0) readonly buffer From { uint from[]; };
uint fetch(uint i) { return from[i]; }
#else
layout(binding = 0) uniform utextureBuffer from;
uint fetch(uint i) { return texelFetch(from, int(i)).x; }
#endif
layout(scalar, binding = 1) buffer To { uint to[]; };
layout(push_constant, scalar) uniform Params { uint count; };

void main()
{
    const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    const uint i = group * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (i >= count) return;
    to[i] = factor * fetch(i) + i;
}
