// SPDX-License-Identifier: Apache-2.0
#include "engine/view/display.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

namespace helio {

namespace {

constexpr double kHazeLength = 12000.0;      // m over which 63 % of a view turns to haze
constexpr double kGroundHazeLength = 3500.0; // the same for the plain beyond the scene: it shall not end in a line
constexpr double kGroundAlbedo = 0.16;       // of that plain where the scene has none
const glm::dvec3 kGroundTint = tintOf({0.86, 1.0, 0.56}); // fields, for display alone
constexpr double kMiddleGrey = 0.50; // of the exposed mean; the curve brings it to a display value above one half
constexpr double kSunWeight = 0.04;  // of a white surface in the sun, so that it does not burn out in a dark scene

} // namespace

gpu::ForwardParams forwardParams(const Camera& camera, double aspect, const SunView& sun, bool display)
{
    gpu::ForwardParams p{};
    p.clipFromWorld = glm::mat4(clipFromWorld(camera, aspect));
    const glm::dmat4 rows = glm::transpose(glm::dmat4(sun.gridFromWorld));
    const glm::dvec4 eye(camera.eye, 1.0);
    const auto seenFromEye = [&](const glm::dvec4& row) { return glm::vec4(glm::dvec3(row), glm::dot(row, eye)); };
    p.sunRow0 = seenFromEye(double(sun.width) * rows[0]);
    p.sunRow1 = seenFromEye(-double(sun.height) * (rows[1] + double(sun.shear) * rows[0]));
    p.sunRow2 = seenFromEye(rows[2]);
    p.eye = glm::vec4(glm::vec3(camera.eye), display ? float(1.0 / kHazeLength) : 0.0f);
    return p;
}

gpu::ViewRecord viewRecord(const Camera& camera, glm::dvec2 size, const LightState& light, const SunView& sun,
                           const FarGround& ground, const std::optional<PictureSky>& sky)
{
    gpu::ViewRecord v{};
    v.worldFromClip = glm::mat4(glm::inverse(clipFromWorld(camera, size.x / size.y)));
    v.rayCentre = glm::vec2(0.5 * size);
    v.rayStep = float(2.0 * std::tan(glm::radians(camera.fovDegrees) / 2.0) / size.y);
    v.eye = glm::vec4(glm::vec3(camera.eye), 0.0f);
    v.sunDirection = glm::vec4(glm::vec3(light.towardsSun), light.sunUp() ? 1.0f : 0.0f);
    v.gridSize = glm::vec2(sun.gridX, sun.gridY);
    v.shadowStep = 1.0f / glm::vec2(sun.width, sun.height);
    v.shadowTexel = float(sun.texel);
    v.sunShear = sun.shear;
    v.depthRange = float(sun.depthRange);
    v.emissionScale = light.emission ? 1.0f : 0.0f;

    const float uniform = float(light.dhi / std::numbers::pi);
    const double dni = light.sunUp() ? light.dni : 0.0;
    v.sunLight = glm::vec4(float(dni));
    v.zenith = glm::vec4(glm::vec3(uniform), 0.0f);
    v.horizon = glm::vec4(glm::vec3(uniform), 0.0f);
    const double height = std::max(light.towardsSun.z, 0.0);
    v.ground = glm::vec4(ground.rho / std::numbers::pi * (dni * height + light.dhi), 0.0);
    if (!sky) return v;

    v.sunLight = glm::vec4(dni * sky->sunTint, 1.0);
    v.zenith = glm::vec4(sky->zenith, 0.0);
    v.horizon = glm::vec4(sky->horizon, 1.0 / kGroundHazeLength);
    v.glow = glm::vec4(sky->glow, 1.0);
    const glm::dvec3 onGround = glm::dvec3(v.sunLight) * height + light.dhi * sky->tint;
    const double known = luminance(ground.rho);
    const glm::dvec3 albedo = (known > 0.0 ? known : kGroundAlbedo) * kGroundTint;
    v.ground = glm::vec4(albedo / std::numbers::pi * onGround, std::max(camera.eye.z - ground.z, 0.1));
    return v;
}

double autoExposure(const glm::dvec4& meanRadiosity, const LightState& light)
{
    // A scene that reflects nothing still shows its sky.
    const double mean = std::max(luminance(glm::dvec3(meanRadiosity)), 0.02 * light.dhi);
    const double radiance = (mean + kSunWeight * (light.sunUp() ? light.dni : 0.0)) / std::numbers::pi;
    return radiance > 0.0 ? kMiddleGrey / radiance : 1.0;
}

double falseColourScale(u32 mode, const glm::dvec4& meanRadiosity, const LightState& light)
{
    const double mean = std::max(luminance(glm::dvec3(meanRadiosity)), 1e-3);
    switch (mode) {
    case gpu::kModeDepth:
        return 100.0;
    case gpu::kModeSun:
        return std::max(light.dni, 1e-3);
    case gpu::kModeSky:
        return std::max(light.dhi, 1e-3);
    case gpu::kModeIndirect:
        return 1.5 * mean;
    case gpu::kModeRadiosity:
        return 4.0 * mean;
    default:
        return 1.0;
    }
}

} // namespace helio
