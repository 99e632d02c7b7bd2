// SPDX-License-Identifier: Apache-2.0
// Corners in clip space with an id; pulled from a storage buffer, or given as vertex attributes in the variant.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) flat out uint id;
#ifdef HELIO_ATTRIBUTES
layout(location = 0) in vec3 position;
layout(location = 1) in uint corner;
layout(location = 2) in uint instance;
void main()
{
    id = corner + instance;
    gl_Position = vec4(position, 1.0);
}
#else
struct Corner {
    vec3 position;
    uint id;
};
layout(scalar, binding = 0) readonly buffer Corners { Corner corners[]; };
void main()
{
    id = corners[gl_VertexIndex].id;
    gl_Position = vec4(corners[gl_VertexIndex].position, 1.0);
}
#endif
