// SPDX-License-Identifier: Apache-2.0
// Stage 4: one triangle over the picture at infinite distance.
#version 460
layout(location = 0) out vec2 vClip;

void main()
{
    vClip = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
    gl_Position = vec4(vClip, 0.0, 1.0);
}
