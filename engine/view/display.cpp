// SPDX-License-Identifier: Apache-2.0
#include "engine/view/display.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace helio {

namespace {

constexpr double kHazeLength = 6000.0; // m over which 63 % of a view turns to haze
constexpr double kMiddleGrey = 0.22;

double luminance(const glm::dvec4& v) { return 0.2126 * v.r + 0.7152 * v.g + 0.0722 * v.b; }

/// Scales a colour to luminance 1, so that a tint changes no brightness.
glm::dvec3 tint(glm::dvec3 colour) { return colour / luminance(glm::dvec4(colour, 0.0)); }

} // namespace

gpu::ViewRecord viewRecord(const Camera& camera, double aspect, const LightState& light, const SunView& sun, bool display)
{
    gpu::ViewRecord v{};
    const glm::dmat4 clip = clipFromWorld(camera, aspect);
    v.clipFromWorld = glm::mat4(clip);
    v.worldFromClip = glm::mat4(glm::inverse(clip));
    v.sunFromWorld = sun.gridFromWorld;
    v.eye = glm::vec4(glm::vec3(camera.eye), display ? float(1.0 / kHazeLength) : 0.0f);
    v.sunDirection = glm::vec4(glm::vec3(light.towardsSun), light.sunUp() ? 1.0f : 0.0f);
    v.dni = glm::vec4(light.sunUp() ? float(light.dni) : 0.0f);
    v.gridSize = glm::vec2(sun.gridX, sun.gridY);
    v.shadowTexel = glm::vec2(sun.texelX, sun.texelY);
    v.shadowSize = glm::vec2(sun.width, sun.height);
    v.depthRange = float(sun.depthRange);
    v.emissionScale = light.emission ? 1.0f : 0.0f;

    const double sky = light.dhi / std::numbers::pi; // radiance of the uniform sky
    v.sunTint = v.skyTint = glm::vec4(1.0f);
    v.zenith = glm::vec4(glm::vec3(float(sky)), 1.0f);
    v.horizon = glm::vec4(glm::vec3(float(sky)), 0.0f);
    if (!display) return v;

    // Warm and weak near the horizon, nearly white above 30 degrees; the sky keeps what the sun lost.
    const double high = glm::smoothstep(0.0, 0.5, std::max(light.towardsSun.z, 0.0));
    const double lit = light.sunUp() ? 1.0 : 0.0;
    v.sunTint = glm::vec4(tint(glm::mix(glm::dvec3(1.0, 0.62, 0.30), glm::dvec3(1.0, 0.93, 0.82), high)), 1.0);
    v.skyTint = glm::vec4(tint(glm::mix(glm::dvec3(0.82, 0.88, 1.0), glm::dvec3(0.74, 0.87, 1.0), high)), 1.0);
    const glm::dvec3 zenith = sky * glm::mix(glm::dvec3(0.42, 0.62, 1.02), glm::dvec3(0.36, 0.66, 1.18), high);
    const glm::dvec3 horizon = sky * glm::mix(glm::dvec3(1.35, 1.16, 1.02), glm::dvec3(1.18, 1.32, 1.46), high);
    v.zenith = glm::vec4(zenith, 3.0);
    v.horizon = glm::vec4(horizon, 0.55);
    v.glow = glm::vec4(lit * sky * glm::mix(glm::dvec3(2.4, 1.3, 0.6), glm::dvec3(1.2, 1.1, 0.9), high), 0.0);
    return v;
}

double autoExposure(const glm::dvec4& meanRadiosity, const LightState& light)
{
    // A scene that reflects nothing still shows its sky.
    const double radiance = std::max(luminance(meanRadiosity), 0.02 * light.dhi) / std::numbers::pi;
    return radiance > 0.0 ? kMiddleGrey / radiance : 1.0;
}

double falseColourScale(u32 mode, const glm::dvec4& meanRadiosity, const LightState& light)
{
    const double mean = std::max(luminance(meanRadiosity), 1e-3);
    switch (mode) {
    case gpu::kModeDepth: return 100.0;
    case gpu::kModeSun: return std::max(light.dni, 1e-3);
    case gpu::kModeSky: return std::max(light.dhi, 1e-3);
    case gpu::kModeIndirect: return 1.5 * mean;
    case gpu::kModeRadiosity: return 4.0 * mean;
    default: return 1.0;
    }
}

} // namespace helio
