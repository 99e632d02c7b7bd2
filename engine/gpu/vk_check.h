// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vulkan/vulkan.h>

#include "city/base/check.h"

namespace helio {

/// "VK_ERROR_DEVICE_LOST" and so on; a number for codes that have no name here.
std::string vkResultName(VkResult result);

/// Text that failDevice prints when the device was lost: the dump of the graph that was recorded last. May be null.
void setFailureNote(std::shared_ptr<const std::string> note);

/// Prints what failed and why and ends the process with exit code 2
/// without running destructors: after a lost device they could hang.
[[noreturn]] void failDevice(VkResult result, const std::string& what);

/// Every VkResult passes here, in release builds too. `what` is written one after the other, only on failure.
template <class... Ts> void vkCheck(VkResult result, const Ts&... what)
{
    if (result != VK_SUCCESS) failDevice(result, concat(what...));
}

} // namespace helio
