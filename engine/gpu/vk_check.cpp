// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/vk_check.h"

#include <cstdio>
#include <cstdlib>
#include <mutex>

namespace helio {
namespace {

std::mutex noteMutex;

std::shared_ptr<const std::string>& failureNote()
{
    static std::shared_ptr<const std::string> note;
    return note;
}

} // namespace

std::string vkResultName(VkResult result)
{
    switch (result) {
    case VK_SUCCESS:
        return "VK_SUCCESS";
    case VK_NOT_READY:
        return "VK_NOT_READY";
    case VK_TIMEOUT:
        return "VK_TIMEOUT";
    case VK_INCOMPLETE:
        return "VK_INCOMPLETE";
    case VK_SUBOPTIMAL_KHR:
        return "VK_SUBOPTIMAL_KHR";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
        return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED:
        return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
        return "VK_ERROR_FORMAT_NOT_SUPPORTED";
    case VK_ERROR_SURFACE_LOST_KHR:
        return "VK_ERROR_SURFACE_LOST_KHR";
    case VK_ERROR_OUT_OF_DATE_KHR:
        return "VK_ERROR_OUT_OF_DATE_KHR";
    default:
        return concat("VkResult ", int(result));
    }
}

void setFailureNote(std::shared_ptr<const std::string> note)
{
    const std::lock_guard lock(noteMutex);
    failureNote() = std::move(note);
}

void failDevice(VkResult result, const std::string& what)
{
    std::fprintf(stderr, "device error: %s: %s\n", what.c_str(), vkResultName(result).c_str());
    if (result == VK_ERROR_DEVICE_LOST) {
        const std::lock_guard lock(noteMutex);
        if (failureNote()) std::fprintf(stderr, "%s\n", failureNote()->c_str());
    }
    std::fflush(stderr);
    std::_Exit(2);
}

} // namespace helio
