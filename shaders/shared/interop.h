// SPDX-License-Identifier: Apache-2.0
// The only file that knows which compiler reads it. Structs between HELIO_SHARED_BEGIN and HELIO_SHARED_END have the same
// bytes in C++ and in GLSL (scalar block layout): only float, uint, vec2..vec4, mat4, and explicit padding.
#ifndef HELIO_INTEROP_H
#define HELIO_INTEROP_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <type_traits>

#define HELIO_SHARED_BEGIN                                                                                              \
    namespace helio::gpu {                                                                                             \
    using uint = std::uint32_t;                                                                                        \
    using glm::mat4;                                                                                                   \
    using glm::vec2;                                                                                                   \
    using glm::vec3;                                                                                                   \
    using glm::vec4;
#define HELIO_SHARED_END }
#define HELIO_CONSTANT inline constexpr
#define HELIO_SIZE(Type, bytes) static_assert(sizeof(Type) == (bytes) && std::is_trivially_copyable_v<Type>)
static_assert(sizeof(glm::vec3) == 12, "GLM's aligned types must stay off: the shared structs use scalar layout");
#else
#define HELIO_SHARED_BEGIN
#define HELIO_SHARED_END
#define HELIO_CONSTANT const
#define centroid centroid_ // a keyword of GLSL that one record uses as a member's name
#define HELIO_SIZE(Type, bytes)
#endif

#endif
