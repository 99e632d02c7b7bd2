// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/context.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vk_mem_alloc.h>

#include "engine/gpu/pipeline.h"
#include "engine/gpu/vk_check.h"

namespace helio {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT type,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user)
{
    // The loader reports broken drivers of other vendors as general warnings; they say nothing about our calls.
    const bool ours =
        type & (VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT);
    if (ours && severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT)
        static_cast<MessageLog*>(user)->add(data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(MessageLog* log)
{
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = log;
    return info;
}

bool hasLayer(const char* name)
{
    u32 count = 0;
    vkCheck(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
    std::vector<VkLayerProperties> layers(count);
    vkCheck(vkEnumerateInstanceLayerProperties(&count, layers.data()), "vkEnumerateInstanceLayerProperties");
    return std::any_of(layers.begin(), layers.end(),
                       [&](const auto& l) { return std::strcmp(l.layerName, name) == 0; });
}

bool hasInstanceExtension(const char* name)
{
    u32 count = 0;
    vkCheck(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr), "vkEnumerateInstanceExtensionProperties");
    std::vector<VkExtensionProperties> extensions(count);
    vkCheck(vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data()),
            "vkEnumerateInstanceExtensionProperties");
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

int rank(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    default:
        return 3;
    }
}

/// The first family with graphics and compute; the one whose timestamps queryFacts reports.
u32 findQueueFamily(VkPhysicalDevice device)
{
    u32 count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (u32 i = 0; i < count; ++i) {
        if ((families[i].queueFlags & kBoth) == kBoth) return i;
    }
    return kNoIndex;
}

} // namespace

Result<std::unique_ptr<Context>> Context::create(const ContextOptions& options)
{
    std::unique_ptr<Context> context(new Context());
    if (Status status = context->createInstance(options); !status) return status.error();
    if (options.makeSurface) {
        const VkResult result = options.makeSurface(context->instance_, &context->surface_);
        if (result != VK_SUCCESS) return Error{concat("cannot make a window surface: ", vkResultName(result))};
    }
    if (Status status = context->pickDevice(options); !status) return status.error();
    if (Status status = context->createDevice(options); !status) return status.error();
    context->createSamplers();
    context->pipelines_ = std::make_unique<PipelineCache>(*context);
    return context;
}

Context::~Context()
{
    if (device_) {
        vkDeviceWaitIdle(device_);
        pipelines_.reset();
        for (const VkSampler sampler : samplers_) vkDestroySampler(device_, sampler, nullptr);
        vmaDestroyAllocator(allocator_);
        vkDestroyDevice(device_, nullptr);
    }
    if (surface_) vkDestroySurfaceKHR(instance_, surface_, nullptr);
    if (messenger_) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance_, messenger_, nullptr);
    }
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

Status Context::createInstance(const ContextOptions& options)
{
    u32 version = 0;
    if (vkEnumerateInstanceVersion(&version) != VK_SUCCESS || version < VK_API_VERSION_1_3) {
        return Error{"the Vulkan loader is older than 1.3; install the package libvulkan1 of Debian 12 or newer"};
    }
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "heliopolis";
    application.apiVersion = VK_API_VERSION_1_3;

    std::vector<const char*> extensions = options.instanceExtensions;
    const bool debug = hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (debug) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(messages_.get());
    if (options.validation) {
        if (!hasLayer(kValidationLayer) || !debug) {
            return Error{concat("validation was asked for but ", kValidationLayer,
                                " is not there; install the package vulkan-validationlayers")};
        }
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
        features.enabledValidationFeatureCount = 1;
        features.pEnabledValidationFeatures = &synchronization;
        features.pNext = &messenger; // for messages while the instance is made and destroyed
        info.pNext = &features;
    }
    info.enabledExtensionCount = u32(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        return Error{"no Vulkan driver; install the package mesa-vulkan-drivers, which has a software one"};
    }
    if (result != VK_SUCCESS) return Error{concat("cannot make a Vulkan instance: ", vkResultName(result))};

    if (debug) {
        setName_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
            vkGetInstanceProcAddr(instance_, "vkSetDebugUtilsObjectNameEXT"));
    }
    if (options.validation) {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
        vkCheck(create(instance_, &messenger, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
    }
    return Nothing{};
}

Status Context::pickDevice(const ContextOptions& options)
{
    u32 count = 0;
    vkCheck(vkEnumeratePhysicalDevices(instance_, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    vkCheck(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "vkEnumeratePhysicalDevices");
    devices.resize(count);
    if (devices.empty()) {
        return Error{"no Vulkan device; install the package mesa-vulkan-drivers, which has a software one"};
    }
    std::string wanted = options.device;
    if (const char* environment = std::getenv("HELIO_DEVICE"); wanted.empty() && environment) wanted = environment;

    std::string refusals;
    std::string names;
    int best = 4;
    for (const VkPhysicalDevice device : devices) {
        const DeviceFacts facts = queryFacts(device);
        names += (names.empty() ? "'" : ", '") + facts.name + "'";
        if (!wanted.empty() && facts.name.find(wanted) == std::string::npos) continue;
        std::string refusal = whyRefused(facts);
        if (refusal.empty() && surface_) {
            VkBool32 presents = VK_FALSE;
            vkCheck(vkGetPhysicalDeviceSurfaceSupportKHR(device, findQueueFamily(device), surface_, &presents),
                    "vkGetPhysicalDeviceSurfaceSupportKHR");
            if (!presents) refusal = concat("device '", facts.name, "' cannot present to this window");
        }
        if (!refusal.empty()) {
            refusals += (refusals.empty() ? "" : "; ") + refusal;
            continue;
        }
        if (rank(facts.type) >= best) continue;
        best = rank(facts.type);
        physical_ = device;
        facts_ = facts;
    }
    if (physical_) {
        queueFamily_ = findQueueFamily(physical_);
        if (options.texelElementLimit) {
            facts_.maxTexelBufferElements = std::min(facts_.maxTexelBufferElements, options.texelElementLimit);
        }
        return Nothing{};
    }
    if (!refusals.empty()) return Error{refusals};
    return Error{concat("no Vulkan device has '", wanted, "' in its name; there are: ", names)};
}

Status Context::createDevice(const ContextOptions& options)
{
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = queueFamily_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;

    VkPhysicalDeviceVulkan13Features features13{};
    features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    features13.dynamicRendering = VK_TRUE;
    features13.synchronization2 = VK_TRUE;
    features13.maintenance4 = VK_TRUE;
    VkPhysicalDeviceVulkan12Features features12{};
    features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features12.pNext = &features13;
    features12.scalarBlockLayout = VK_TRUE;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &features12;
    features.features.multiDrawIndirect = facts_.multiDrawIndirect;
    features.features.drawIndirectFirstInstance = facts_.drawIndirectFirstInstance;
    features.features.fragmentStoresAndAtomics = facts_.fragmentStoresAndAtomics;
    features.features.depthClamp = facts_.depthClamp;
    features.features.shaderStorageImageExtendedFormats = facts_.storageImageExtendedFormats;

    const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = options.makeSurface ? 1 : 0;
    info.ppEnabledExtensionNames = &swapchain;
    const VkResult result = vkCreateDevice(physical_, &info, nullptr, &device_);
    if (result != VK_SUCCESS) return Error{concat("cannot open device '", facts_.name, "': ", vkResultName(result))};
    vkGetDeviceQueue(device_, queueFamily_, 0, &queue_);

    VmaAllocatorCreateInfo allocator{};
    allocator.instance = instance_;
    allocator.physicalDevice = physical_;
    allocator.device = device_;
    allocator.vulkanApiVersion = VK_API_VERSION_1_3;
    vkCheck(vmaCreateAllocator(&allocator, &allocator_), "vmaCreateAllocator");
    return Nothing{};
}

void Context::createSamplers()
{
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    vkCheck(vkCreateSampler(device_, &info, nullptr, &samplers_[u32(Sampler::Nearest)]), "vkCreateSampler nearest");
    info.magFilter = VK_FILTER_LINEAR;
    info.minFilter = VK_FILTER_LINEAR;
    vkCheck(vkCreateSampler(device_, &info, nullptr, &samplers_[u32(Sampler::Linear)]), "vkCreateSampler linear");
    info.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    info.compareEnable = VK_TRUE;
    info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    vkCheck(vkCreateSampler(device_, &info, nullptr, &samplers_[u32(Sampler::Shadow)]), "vkCreateSampler shadow");
}

std::string Context::describe() const
{
    return concat(facts_.name, " (", facts_.driver, ")");
}

void Context::nameObject(VkObjectType type, u64 handle, const std::string& name) const
{
    if (!setName_) return;
    VkDebugUtilsObjectNameInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    vkCheck(setName_(device_, &info), "naming ", name);
}

void Context::waitIdle() const
{
    vkCheck(vkDeviceWaitIdle(device_), "vkDeviceWaitIdle");
}

} // namespace helio
