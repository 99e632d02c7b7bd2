// SPDX-License-Identifier: Apache-2.0
// Stage 1: the patch that the sun sees at this texel.
#version 460
layout(location = 0) flat in uint vPatch;
layout(location = 0) out uint oPatch;

void main() { oPatch = vPatch; }
