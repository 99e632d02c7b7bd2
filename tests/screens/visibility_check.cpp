// SPDX-License-Identifier: Apache-2.0
#include "tests/screens/visibility_check.h"

#include <cmath>
#include <glm/trigonometric.hpp>

namespace helio {

RayCamera rayCamera(const Camera& camera, double aspect)
{
    const CameraAxes axes = axesOf(camera);
    const double tanHalfHeight = std::tan(glm::radians(camera.fovDegrees) / 2);
    return {camera.eye, axes.right, axes.up, axes.forward, tanHalfHeight * aspect, tanHalfHeight};
}

Agreement checkSunVisibility(Renderer& renderer, const RayScene& rays, const Camera& camera, u32 width, u32 height)
{
    const Picture picture = renderer.render(camera, width, height, {.mode = gpu::kModeSunVisibility, .display = false});
    std::vector<float> visibility;
    visibility.reserve(picture.values.size());
    for (const glm::vec4& value : picture.values) visibility.push_back(value.x);
    const RayPicture reference =
        tracePicture(rays, rayCamera(camera, double(width) / height), renderer.light().towardsSun, width, height);
    return compareVisibility(reference, camera.eye, visibility);
}

double checkPatchIds(Renderer& renderer, const RayScene& rays, const Camera& camera, u32 width, u32 height)
{
    const Picture picture = renderer.render(camera, width, height, {.mode = gpu::kModeId, .display = false});
    const RayPicture reference =
        tracePicture(rays, rayCamera(camera, double(width) / height), renderer.light().towardsSun, width, height);
    u64 compared = 0, equal = 0;
    for (u32 y = 0; y < height; ++y) {
        for (u32 x = 0; x < width; ++x) {
            const RayHit& hit = reference.at(x, y);
            if (hit.patch == kNoIndex || nearEdge(reference, camera.eye, x, y) || nearPatchBorder(reference, x, y))
                continue;
            ++compared;
            if (double(picture.values[size_t(y) * width + x].w) == double(hit.patch)) ++equal;
        }
    }
    return compared == 0 ? 0.0 : double(equal) / double(compared);
}

std::string describe(const Agreement& agreement)
{
    return concat(100 * agreement.share(), " % of ", agreement.compared, " pixels agree; ", 100 * agreement.lit,
                  " % of them lit; left out: ", agreement.nearEdge, " within one pixel of an edge, ",
                  agreement.background, " background");
}

} // namespace helio
