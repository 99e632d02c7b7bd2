// SPDX-License-Identifier: Apache-2.0
// Read-only arrays of 16, 8 or 4 bytes an element, in three ways that give the same bits; which is the fastest is measured on
// the device (engine/stages/reads.h). Uniform texel buffers go through the texture units; HELIO_IMAGE_READS: storage texel
// buffers, which software devices read with vector loads and without a call; HELIO_STORAGE_READS: storage buffers, for devices
// whose texel buffers are too small, and which software devices read lane by lane.
#if defined(HELIO_STORAGE_READS)
#define HELIO_READS_VEC4(name, slot) layout(set = 0, binding = slot, scalar) readonly buffer name##Block { vec4 name[]; };
#define HELIO_READS_UVEC4(name, slot) layout(set = 0, binding = slot, scalar) readonly buffer name##Block { uvec4 name[]; };
#define HELIO_READS_UVEC2(name, slot) layout(set = 0, binding = slot, scalar) readonly buffer name##Block { uvec2 name[]; };
#define HELIO_READS_UINT(name, slot) layout(set = 0, binding = slot, scalar) readonly buffer name##Block { uint name[]; };
#define readVec4(name, index) name[index]
#define readUvec4(name, index) name[index]
#define readUvec2(name, index) name[index]
#define readUint(name, index) name[index]
#elif defined(HELIO_IMAGE_READS)
#define HELIO_READS_VEC4(name, slot) layout(set = 0, binding = slot, rgba32f) uniform readonly imageBuffer name;
#define HELIO_READS_UVEC4(name, slot) layout(set = 0, binding = slot, rgba32ui) uniform readonly uimageBuffer name;
#define HELIO_READS_UVEC2(name, slot) layout(set = 0, binding = slot, rg32ui) uniform readonly uimageBuffer name;
#define HELIO_READS_UINT(name, slot) layout(set = 0, binding = slot, r32ui) uniform readonly uimageBuffer name;
#define readVec4(name, index) imageLoad(name, int(index))
#define readUvec4(name, index) imageLoad(name, int(index))
#define readUvec2(name, index) imageLoad(name, int(index)).xy
#define readUint(name, index) imageLoad(name, int(index)).x
#else
#define HELIO_READS_VEC4(name, slot) layout(set = 0, binding = slot) uniform textureBuffer name;
#define HELIO_READS_UVEC4(name, slot) layout(set = 0, binding = slot) uniform utextureBuffer name;
#define HELIO_READS_UVEC2(name, slot) layout(set = 0, binding = slot) uniform utextureBuffer name;
#define HELIO_READS_UINT(name, slot) layout(set = 0, binding = slot) uniform utextureBuffer name;
#define readVec4(name, index) texelFetch(name, int(index))
#define readUvec4(name, index) texelFetch(name, int(index))
#define readUvec2(name, index) texelFetch(name, int(index)).xy
#define readUint(name, index) texelFetch(name, int(index)).x
#endif
