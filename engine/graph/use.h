// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vulkan/vulkan.h>

#include "city/base/types.h"

namespace helio {

/// Every way in which a pass may touch a resource. Closed: barriers.cpp maps each to stage, access and layout.
enum class Use : u32
{
    ComputeRead,           // storage or texel buffer; storage image (imageLoad)
    ComputeWrite,          // storage buffer or storage image, old contents replaced or left alone
    ComputeReadWrite,      // storage buffer or storage image, old contents read or added to (atomics)
    ComputeSample,         // image through a sampler, in compute
    VertexRead,            // storage or texel buffer, in the vertex shader
    FragmentRead,          // storage or texel buffer; in the fragment shader
    VertexAndFragmentRead, // storage or texel buffer, in both
    FragmentSample,        // image through a sampler, in the fragment shader
    VertexAttribute,       // vertex buffer
    Index,                 // index buffer
    Indirect,              // draw or dispatch arguments
    ColorTarget,           // colour attachment, cleared or not
    ColorTargetLoad,       // colour attachment that keeps and adds to its old contents
    DepthTarget,           // depth attachment, tested and written
    DepthTargetLoad,       // depth attachment, tested and written, that keeps its old contents
    DepthTest,             // depth attachment, tested only
    CopyFrom,              // source of a copy
    CopyTo,                // destination of a copy or a fill
    HostRead,              // read by the host after the fence
    Present,               // handed to the presentation engine
};
inline constexpr u32 kUseCount = u32(Use::Present) + 1;

/// What one use means to Vulkan.
struct UseInfo
{
    const char* name;
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 reads;
    VkAccessFlags2 writes;
    VkImageLayout layout;         // UNDEFINED = not a use of images
    VkImageUsageFlags imageUsage; // what an image must be created with
    bool buffers;                 // is it a use of buffers?
    bool needsContents;           // does it read what was there before?

    bool isWrite() const { return writes != VK_ACCESS_2_NONE; }
};

/// The table's row for a use.
const UseInfo& useInfo(Use use);

} // namespace helio
