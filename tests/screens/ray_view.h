// SPDX-License-Identifier: Apache-2.0
// What a camera sees and what the sun reaches, by rays through the drawn triangles: the reference of the raster
// pictures.
#pragma once
#include <embree3/rtcore.h>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "city/format/pack.h"
#include "tests/support/image_file.h"

namespace helio {

/// Where a ray met the city.
struct RayHit
{
    u32 patch = kNoIndex;     ///< kNoIndex = it met nothing
    glm::dvec3 position{0.0}; ///< m, tile frame
    glm::dvec3 normal{0.0};   ///< of the triangle, unit, towards the ray's origin
    bool lit = false;         ///< the sun is on the normal's side and nothing is between
};

/// All triangles of a tile's draw lists, asset instances included.
class RayScene
{
public:
    /// The tile's memory must outlive the scene.
    explicit RayScene(const TileView& tile);
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// First triangle along a ray; `direction` is unit. Both sides of a triangle stop rays. `toSun` is unit, towards
    /// the sun.
    RayHit look(glm::dvec3 origin, glm::dvec3 direction, glm::dvec3 toSun) const;
    /// Is anything between a point and infinity?
    bool blocked(glm::dvec3 origin, glm::dvec3 direction) const;
    u64 triangleCount() const { return triangleCount_; }

private:
    struct Release
    {
        void operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
        void operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }
    };
    /// What an Embree geometry of the top scene is made of.
    struct Part
    {
        const gpu::DrawRecord* draw;
        u32 instance;
    };
    void addMesh(RTCSceneTy* into, const gpu::DrawRecord& draw);

    const TileView tile_;
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::vector<std::unique_ptr<RTCSceneTy, Release>> meshes_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
    std::vector<Part> parts_; // by geometry id of the top scene
    u64 triangleCount_ = 0;
};

/// A pinhole camera as rays.
struct RayCamera
{
    glm::dvec3 eye{0.0};           ///< m, tile frame
    glm::dvec3 right, up, forward; ///< unit, orthogonal
    double tanHalfWidth = 1, tanHalfHeight = 1;
};

/// One ray through the centre of each pixel, rows from the top.
struct RayPicture
{
    u32 width = 0;
    u32 height = 0;
    std::vector<RayHit> pixels;
    const RayHit& at(u32 x, u32 y) const { return pixels[size_t(y) * width + x]; }
};
RayPicture tracePicture(const RayScene& scene, const RayCamera& camera, glm::dvec3 toSun, u32 width, u32 height);

/// Is there an edge within one pixel: does one of the eight neighbours see nothing, another plane (normals more than 3
/// degrees apart, or off the pixel's plane by more than 1 cm + 0.1 % of the distance), or the other visibility? Borders
/// between patches of one plane are no edges of what is seen.
bool nearEdge(const RayPicture& picture, glm::dvec3 eye, u32 x, u32 y);

/// Does one of the eight neighbours see another patch?
bool nearPatchBorder(const RayPicture& picture, u32 x, u32 y);

struct Agreement
{
    u64 compared = 0; ///< pixels that see the city and have no edge within one pixel
    u64 agreeing = 0; ///< of them, those whose visibility is on the same side of one half
    u64 nearEdge = 0;
    u64 background = 0;
    double share() const { return compared == 0 ? 0.0 : double(agreeing) / double(compared); }
    double lit = 0; ///< share of the compared pixels that the rays call lit
    TestImage
        map; ///< grey = agree (bright = lit), red = lit by the picture only, blue = by the rays only, dark = skipped
};

/// Compares the sun visibility of a picture (0..1 a pixel, rows from the top) with the rays.
Agreement compareVisibility(const RayPicture& rays, glm::dvec3 eye, std::span<const float> visibility);

} // namespace helio
