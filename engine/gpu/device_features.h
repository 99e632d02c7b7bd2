// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vulkan/vulkan.h>

#include "city/base/types.h"

namespace helio {

/// What was asked of one physical device; a plain value, so that the rules below are tested without a device.
struct DeviceFacts
{
    std::string name;
    std::string driver; // name and version as the driver writes them
    u32 apiVersion = 0;
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    bool dynamicRendering = false;
    bool synchronization2 = false;
    bool maintenance4 = false;
    bool scalarBlockLayout = false;
    bool subgroupBallot = false;     // in compute
    bool subgroupArithmetic = false; // in compute
    bool graphicsAndComputeQueue = false;
    // Optional, each with a fallback.
    bool multiDrawIndirect = false;
    bool drawIndirectFirstInstance = false;
    bool fragmentStoresAndAtomics = false;
    bool depthClamp = false;
    bool storageImageExtendedFormats = false; ///< two-component storage texel buffers
    // Limits that decide layouts and shader variants.
    u32 subgroupSize = 0;
    u32 maxPushConstantBytes = 0;
    u32 maxImageDimension2D = 0;
    u32 maxImageArrayLayers = 0;
    u32 maxTexelBufferElements = 0;
    u32 maxStageStorageImages = 0;  ///< descriptors of one shader
    u32 maxStageStorageBuffers = 0; ///< likewise
    u64 maxStorageBufferBytes = 0;
    u32 maxDispatchGroups = 0;   // along x
    float timestampPeriodNs = 0; // ns per tick; 0 = the queue has no timestamps
};

/// One thing that a device must have: how to test it, its name, and why we need it.
struct RequiredFeature
{
    const char* name;
    const char* reason;
    bool (*present)(const DeviceFacts&);
};

/// The table of required features.
std::span<const RequiredFeature> requiredFeatures();

/// Empty if the device serves; else one sentence that names the device, the first missing feature and its reason.
std::string whyRefused(const DeviceFacts& facts);

/// Asks a physical device.
DeviceFacts queryFacts(VkPhysicalDevice device);

} // namespace helio
