// SPDX-License-Identifier: Apache-2.0
// lit[i] = depth comparison of the reference at the middle of texel i of one layer.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2DArrayShadow depth;
layout(scalar, binding = 1) writeonly buffer Lit { float lit[]; };
layout(push_constant, scalar) uniform Params { uint layer; float reference; };

void main()
{
    const ivec2 size = textureSize(depth, 0).xy;
    const uint i = gl_GlobalInvocationID.x;
    if (i >= size.x * size.y) return;
    const vec2 middle = (vec2(i % size.x, i / size.x) + 0.5) / vec2(size);
    lit[i] = texture(depth, vec4(middle, layer, reference));
}
