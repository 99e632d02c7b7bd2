// SPDX-License-Identifier: Apache-2.0
// The one unit that compiles the Vulkan Memory Allocator.
#define VMA_IMPLEMENTATION
#include <vk_mem_alloc.h>
