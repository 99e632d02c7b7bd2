// SPDX-License-Identifier: Apache-2.0
// Barriers as a pure function of the access lists: no device, no handles.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "engine/gpu/resources.h"
#include "engine/graph/use.h"

namespace helio {

/// One access of one pass. A pass has at most one access per resource here (uses are merged before).
struct Access
{
    u32 resource = 0; // index into the states
    bool image = false;
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 reads = 0;
    VkAccessFlags2 writes = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool keepContents = true; // false: a write that does not need the old contents (the layout may be discarded)
};

/// A dependency that must be recorded before a pass.
struct Barrier
{
    u32 resource = 0;
    bool image = false;
    VkPipelineStageFlags2 srcStages = 0;
    VkAccessFlags2 srcAccess = 0;
    VkPipelineStageFlags2 dstStages = 0;
    VkAccessFlags2 dstAccess = 0;
    VkImageLayout oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageLayout newLayout = VK_IMAGE_LAYOUT_UNDEFINED;

    bool operator==(const Barrier&) const = default;
};

/// The access that a use means.
Access accessOf(u32 resource, bool image, Use use);
/// Adds another use of the same resource by the same pass. False if they need two different layouts.
bool mergeAccess(Access& into, const Access& other);

/// The barrier between a resource's state and its next access, if any, and the state after it.
std::optional<Barrier> advance(AccessState& state, const Access& access);

/// For each pass the barriers to record before it; `states` (one per resource) are advanced past the last pass.
std::vector<std::vector<Barrier>> deriveBarriers(std::span<AccessState> states,
                                                 std::span<const std::vector<Access>> passes);

} // namespace helio
