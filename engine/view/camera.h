// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string_view>

#include "city/base/result.h"
#include "city/base/types.h"
#include "city/format/pack.h"

namespace helio {

/// A perspective camera in the tile frame: x east, y north (grid), z up, metres. The picture's up is +z (or +y when
/// looking straight down).
struct Camera
{
    glm::dvec3 eye{0.0, -10.0, 2.0};
    glm::dvec3 target{0.0};
    double fovDegrees = 45.0; ///< vertical, (0, 180)
    double near = 0.1;        ///< m
};

/// Unit vectors of the camera: right, up, forward.
struct CameraAxes
{
    glm::dvec3 right, up, forward;
};
CameraAxes axesOf(const Camera& camera);

/// Clip space with depth 1 at the near plane and 0 at infinity (reversed: float depth keeps its precision far away), y
/// up. aspect = width / height.
glm::dmat4 clipFromWorld(const Camera& camera, double aspect);

/// "x,y,z,tx,ty,tz[,fov]" in metres and degrees, or a preset of the pack: aerial (a low three-quarter view), street
/// (eye height, along the longest free line of sight near the middle), top (straight down). Error: what is wrong with
/// the text.
Result<Camera> parseCamera(std::string_view text, const Pack& pack);

Camera aerialCamera(glm::dvec3 boundsMin, glm::dvec3 boundsMax);
Camera topCamera(glm::dvec3 boundsMin, glm::dvec3 boundsMax);

} // namespace helio
