// SPDX-License-Identifier: Apache-2.0
// Slopes of a sender in half floats, over its mean. Those of light that is nowhere negative are small; others end where half
// floats do.
uvec4 packSlopes(vec4 x, vec4 y)
{
    x = clamp(x, vec4(-65504.0), vec4(65504.0));
    y = clamp(y, vec4(-65504.0), vec4(65504.0));
    return uvec4(packHalf2x16(x.xy), packHalf2x16(x.zw), packHalf2x16(y.xy), packHalf2x16(y.zw));
}

vec4 slopeX(uvec4 slopes) { return vec4(unpackHalf2x16(slopes.x), unpackHalf2x16(slopes.y)); }
vec4 slopeY(uvec4 slopes) { return vec4(unpackHalf2x16(slopes.z), unpackHalf2x16(slopes.w)); }
