// SPDX-License-Identifier: Apache-2.0
#include "engine/view/camera.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <string>
#include <vector>

#include "engine/view/street_camera.h"

namespace helio {

CameraAxes axesOf(const Camera& camera)
{
    const glm::dvec3 forward = glm::normalize(camera.target - camera.eye);
    const glm::dvec3 worldUp = std::abs(forward.z) < 0.9999 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, worldUp));
    return {right, glm::cross(right, forward), forward};
}

glm::dmat4 clipFromWorld(const Camera& camera, double aspect)
{
    HELIO_CHECK(camera.fovDegrees > 0.0 && camera.fovDegrees < 180.0 && camera.near > 0.0 && aspect > 0.0, "fov ",
                camera.fovDegrees, ", near ", camera.near, ", aspect ", aspect);
    const CameraAxes axes = axesOf(camera);
    const double scaleY = 1.0 / std::tan(glm::radians(camera.fovDegrees) / 2.0);
    const double scaleX = scaleY / aspect;
    glm::dmat4 m(0.0); // columns; clip = (x scale, y scale, near, distance along the view)
    for (int k = 0; k < 3; ++k) {
        m[k][0] = axes.right[k] * scaleX;
        m[k][1] = axes.up[k] * scaleY;
        m[k][3] = axes.forward[k];
    }
    m[3] = glm::dvec4(-glm::dot(axes.right, camera.eye) * scaleX, -glm::dot(axes.up, camera.eye) * scaleY, camera.near,
                      -glm::dot(axes.forward, camera.eye));
    return m;
}

Camera aerialCamera(glm::dvec3 boundsMin, glm::dvec3 boundsMax)
{
    const glm::dvec3 size = boundsMax - boundsMin;
    const double reach = std::max({std::hypot(size.x, size.y), size.z, 0.1});
    Camera camera;
    camera.fovDegrees = 34.0;
    camera.target =
        glm::dvec3((boundsMin.x + boundsMax.x) / 2.0, (boundsMin.y + boundsMax.y) / 2.0, boundsMin.z + 0.4 * size.z);
    // From the south-south-west and low, so that facades show their windows and the skyline stands before the sky.
    const double azimuth = glm::radians(205.0), elevation = glm::radians(13.0);
    const glm::dvec3 away(std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
                          std::sin(elevation));
    camera.eye = camera.target + away * (0.5 * reach + size.z);
    camera.near = std::min(0.5, 0.01 * reach);
    return camera;
}

Camera topCamera(glm::dvec3 boundsMin, glm::dvec3 boundsMax)
{
    const glm::dvec3 size = boundsMax - boundsMin;
    Camera camera;
    camera.fovDegrees = 30.0;
    camera.target = glm::dvec3((boundsMin.x + boundsMax.x) / 2.0, (boundsMin.y + boundsMax.y) / 2.0, boundsMin.z);
    const double half = std::max(size.y, size.x / 1.6) / 2.0 * 1.05;
    camera.eye = camera.target + glm::dvec3(0, 0, size.z + half / std::tan(glm::radians(camera.fovDegrees) / 2.0));
    camera.near = std::min(0.5, 0.01 * half);
    return camera;
}

Result<Camera> parseCamera(std::string_view text, const Pack& pack)
{
    const glm::dvec3 lo(pack.index().boundsMin), hi(pack.index().boundsMax);
    if (text == "aerial") return aerialCamera(lo, hi);
    if (text == "top") return topCamera(lo, hi);
    if (text == "street") return streetCamera(pack.tile(), lo, hi);

    std::vector<double> numbers;
    const std::string owned(text);
    for (const char* at = owned.c_str();;) {
        char* end = nullptr;
        numbers.push_back(std::strtod(at, &end));
        if (end == at || !std::isfinite(numbers.back()) || (*end != ',' && *end != '\0'))
            return Error{concat("camera '", owned,
                                "': expected aerial, street, top or x,y,z,tx,ty,tz[,fov] in metres and degrees")};
        if (*end == '\0') break;
        at = end + 1;
    }
    if (numbers.size() != 6 && numbers.size() != 7)
        return Error{
            concat("camera '", owned, "': ", numbers.size(), " numbers; expected x,y,z,tx,ty,tz and perhaps fov")};
    Camera camera;
    camera.eye = {numbers[0], numbers[1], numbers[2]};
    camera.target = {numbers[3], numbers[4], numbers[5]};
    if (numbers.size() == 7) camera.fovDegrees = numbers[6];
    if (glm::length(camera.target - camera.eye) < 1e-6)
        return Error{concat("camera '", owned, "': the eye is where the target is")};
    if (!(camera.fovDegrees >= 1.0 && camera.fovDegrees <= 170.0))
        return Error{
            concat("camera '", owned, "': field of view ", camera.fovDegrees, " is not within 1 to 170 degrees")};
    return camera;
}

} // namespace helio
