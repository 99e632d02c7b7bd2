// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/device_features.h"

#include <vector>

#include "city/base/check.h"

namespace helio {
namespace {

constexpr RequiredFeature kRequired[] = {
    {"Vulkan 1.3", "the core version that carries the features below",
     [](const DeviceFacts& f) { return f.apiVersion >= VK_API_VERSION_1_3; }},
    {"dynamicRendering", "raster passes name their targets while recording; there are no render pass objects",
     [](const DeviceFacts& f) { return f.dynamicRendering; }},
    {"synchronization2", "the frame graph derives its barriers as 64-bit stages and accesses",
     [](const DeviceFacts& f) { return f.synchronization2; }},
    {"maintenance4", "SPIR-V 1.6 gives work group sizes by LocalSizeId",
     [](const DeviceFacts& f) { return f.maintenance4; }},
    {"scalarBlockLayout", "the records of the pack have the same bytes in C++ and in shaders",
     [](const DeviceFacts& f) { return f.scalarBlockLayout; }},
    {"subgroup ballot in compute", "the histogram joins equal patch ids before its atomics",
     [](const DeviceFacts& f) { return f.subgroupBallot; }},
    {"subgroup arithmetic in compute", "the histogram adds within a subgroup",
     [](const DeviceFacts& f) { return f.subgroupArithmetic; }},
    {"twelve storage buffers in one shader", "the gather reads and writes eleven",
     [](const DeviceFacts& f) { return f.maxStageStorageBuffers >= 12; }},
    {"a queue with graphics and compute", "all stages share one queue",
     [](const DeviceFacts& f) { return f.graphicsAndComputeQueue; }},
};

} // namespace

std::span<const RequiredFeature> requiredFeatures()
{
    return kRequired;
}

std::string whyRefused(const DeviceFacts& facts)
{
    for (const RequiredFeature& feature : kRequired) {
        if (!feature.present(facts)) {
            return concat("device '", facts.name, "' lacks ", feature.name, ": ", feature.reason);
        }
    }
    return {};
}

DeviceFacts queryFacts(VkPhysicalDevice device)
{
    DeviceFacts facts;
    VkPhysicalDeviceProperties basic{};
    vkGetPhysicalDeviceProperties(device, &basic);
    facts.name = basic.deviceName;
    facts.apiVersion = basic.apiVersion;
    facts.type = basic.deviceType;
    facts.maxPushConstantBytes = basic.limits.maxPushConstantsSize;
    facts.maxImageDimension2D = basic.limits.maxImageDimension2D;
    facts.maxImageArrayLayers = basic.limits.maxImageArrayLayers;
    facts.maxStageStorageImages = basic.limits.maxPerStageDescriptorStorageImages;
    facts.maxStageStorageBuffers = basic.limits.maxPerStageDescriptorStorageBuffers;
    facts.maxTexelBufferElements = basic.limits.maxTexelBufferElements;
    facts.maxStorageBufferBytes = basic.limits.maxStorageBufferRange;
    facts.maxDispatchGroups = basic.limits.maxComputeWorkGroupCount[0];

    u32 familyCount = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &familyCount, nullptr);
    std::vector<VkQueueFamilyProperties> families(familyCount);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &familyCount, families.data());
    constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (const VkQueueFamilyProperties& family : families) {
        if ((family.queueFlags & kBoth) != kBoth || facts.graphicsAndComputeQueue) continue;
        facts.graphicsAndComputeQueue = true;
        if (family.timestampValidBits > 0) facts.timestampPeriodNs = basic.limits.timestampPeriod;
    }
    // The structures below are unknown to older devices.
    if (basic.apiVersion < VK_API_VERSION_1_3) return facts;

    VkPhysicalDeviceVulkan12Properties properties12{};
    properties12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES;
    VkPhysicalDeviceVulkan11Properties properties11{};
    properties11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES;
    properties11.pNext = &properties12;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &properties11;
    vkGetPhysicalDeviceProperties2(device, &properties);
    facts.driver = concat(properties12.driverName, ", ", properties12.driverInfo);
    facts.subgroupSize = properties11.subgroupSize;
    if (properties11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) {
        facts.subgroupBallot = properties11.subgroupSupportedOperations & VK_SUBGROUP_FEATURE_BALLOT_BIT;
        facts.subgroupArithmetic = properties11.subgroupSupportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;
    }

    VkPhysicalDeviceVulkan13Features features13{};
    features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    VkPhysicalDeviceVulkan12Features features12{};
    features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features12.pNext = &features13;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &features12;
    vkGetPhysicalDeviceFeatures2(device, &features);
    facts.dynamicRendering = features13.dynamicRendering;
    facts.synchronization2 = features13.synchronization2;
    facts.maintenance4 = features13.maintenance4;
    facts.scalarBlockLayout = features12.scalarBlockLayout;
    facts.multiDrawIndirect = features.features.multiDrawIndirect;
    facts.drawIndirectFirstInstance = features.features.drawIndirectFirstInstance;
    facts.fragmentStoresAndAtomics = features.features.fragmentStoresAndAtomics;
    facts.depthClamp = features.features.depthClamp;
    facts.storageImageExtendedFormats = features.features.shaderStorageImageExtendedFormats;
    return facts;
}

} // namespace helio
