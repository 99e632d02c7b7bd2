// SPDX-License-Identifier: Apache-2.0
#include "tests/screens/ray_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "city/base/parallel.h"

namespace helio {
namespace {

constexpr double kShadowOffset = 2e-3; // m along the normal: 30 times the spacing of floats at 500 m
const double kSamePlaneCosine = std::cos(3.0 * 3.14159265358979 / 180.0);
constexpr double kPlaneSlack = 0.01; // m
constexpr double kPlaneSlackByDistance = 1e-3;

RTCRayHit makeRay(glm::dvec3 origin, glm::dvec3 direction)
{
    RTCRayHit ray{};
    ray.ray.org_x = float(origin.x);
    ray.ray.org_y = float(origin.y);
    ray.ray.org_z = float(origin.z);
    ray.ray.dir_x = float(direction.x);
    ray.ray.dir_y = float(direction.y);
    ray.ray.dir_z = float(direction.z);
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

glm::dvec3 toWorld(const gpu::InstanceRecord& instance, glm::vec3 local)
{
    const glm::dvec4 point(glm::dvec3(local), 1.0);
    return {glm::dot(glm::dvec4(instance.worldFromLocal[0]), point),
            glm::dot(glm::dvec4(instance.worldFromLocal[1]), point),
            glm::dot(glm::dvec4(instance.worldFromLocal[2]), point)};
}

bool isIdentity(const gpu::InstanceRecord& instance)
{
    return instance.worldFromLocal[0] == glm::vec4(1, 0, 0, 0) && instance.worldFromLocal[1] == glm::vec4(0, 1, 0, 0) &&
           instance.worldFromLocal[2] == glm::vec4(0, 0, 1, 0);
}

bool sameSurface(const RayHit& a, const RayHit& b, double distance)
{
    return b.patch != kNoIndex && a.lit == b.lit && glm::dot(a.normal, b.normal) > kSamePlaneCosine &&
           std::abs(glm::dot(b.position - a.position, a.normal)) < kPlaneSlack + kPlaneSlackByDistance * distance;
}

/// Does the test hold for one of the pixels of the 3 x 3 block about (x, y)?
template <class Test> bool anyNeighbour(const RayPicture& picture, u32 x, u32 y, Test&& test)
{
    for (u32 v = y == 0 ? 0 : y - 1; v <= std::min(y + 1, picture.height - 1); ++v)
        for (u32 u = x == 0 ? 0 : x - 1; u <= std::min(x + 1, picture.width - 1); ++u)
            if (test(picture.at(u, v))) return true;
    return false;
}

} // namespace

RayScene::RayScene(const TileView& tile) : tile_(tile), device_(rtcNewDevice(nullptr))
{
    HELIO_CHECK(device_ != nullptr, "Embree gave no device");
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    for (const gpu::DrawRecord& draw : tile_.draws) {
        triangleCount_ += u64(draw.indexCount / 3) * draw.instanceCount;
        if (draw.instanceCount == 1 && isIdentity(tile_.instances[draw.firstInstance])) {
            addMesh(scene_.get(), draw);
            parts_.push_back({&draw, draw.firstInstance});
            continue;
        }
        RTCSceneTy* mesh = meshes_.emplace_back(rtcNewScene(device_.get())).get();
        rtcSetSceneFlags(mesh, RTC_SCENE_FLAG_ROBUST);
        addMesh(mesh, draw);
        rtcCommitScene(mesh);
        for (u32 i = 0; i < draw.instanceCount; ++i) {
            RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(geometry, mesh);
            rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR,
                                    tile_.instances[draw.firstInstance + i].worldFromLocal);
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene_.get(), geometry);
            rtcReleaseGeometry(geometry);
            parts_.push_back({&draw, draw.firstInstance + i});
        }
    }
    rtcCommitScene(scene_.get());
    HELIO_CHECK(rtcGetDeviceError(device_.get()) == RTC_ERROR_NONE, "Embree refused the triangles");
}

void RayScene::addMesh(RTCSceneTy* into, const gpu::DrawRecord& draw)
{
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, tile_.vertices.data(),
                               draw.vertexOffset * sizeof(gpu::VertexRecord), sizeof(gpu::VertexRecord),
                               tile_.vertices.size() - draw.vertexOffset);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, tile_.indices.data(),
                               draw.firstIndex * sizeof(u32), 3 * sizeof(u32), draw.indexCount / 3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(into, geometry);
    rtcReleaseGeometry(geometry);
}

RayHit RayScene::look(glm::dvec3 origin, glm::dvec3 direction, glm::dvec3 toSun) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray = makeRay(origin, direction);
    rtcIntersect1(scene_.get(), &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};

    const bool instanced = ray.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
    const Part& part = parts_[instanced ? ray.hit.instID[0] : ray.hit.geomID];
    const gpu::InstanceRecord& instance = tile_.instances[part.instance];
    glm::dvec3 corner[3];
    u32 patch = 0;
    for (u32 i = 0; i < 3; ++i) {
        const u32 index = part.draw->vertexOffset + tile_.indices[part.draw->firstIndex + 3 * ray.hit.primID + i];
        corner[i] = toWorld(instance, tile_.vertices[index].position);
        if (i == 0) patch = tile_.vertices[index].patchId + instance.patchId;
    }
    RayHit hit;
    hit.patch = patch;
    hit.normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    if (glm::dot(hit.normal, direction) > 0) hit.normal = -hit.normal;
    // On the triangle's plane: sharper than the ray's own float distance.
    const double along = glm::dot(hit.normal, direction);
    const double distance =
        std::abs(along) > 1e-3 ? glm::dot(corner[0] - origin, hit.normal) / along : double(ray.ray.tfar);
    hit.position = origin + distance * direction;
    hit.lit = glm::dot(hit.normal, toSun) > 0 && !blocked(hit.position + kShadowOffset * hit.normal, toSun);
    return hit;
}

bool RayScene::blocked(glm::dvec3 origin, glm::dvec3 direction) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = makeRay(origin, direction).ray;
    rtcOccluded1(scene_.get(), &context, &ray);
    return ray.tfar < 0;
}

RayPicture tracePicture(const RayScene& scene, const RayCamera& camera, glm::dvec3 toSun, u32 width, u32 height)
{
    RayPicture picture{width, height, std::vector<RayHit>(size_t(width) * height)};
    parallelFor(height, 8, 0, [&](u32 begin, u32 end) {
        for (u32 y = begin; y < end; ++y) {
            for (u32 x = 0; x < width; ++x) {
                const double across = (2 * (x + 0.5) / width - 1) * camera.tanHalfWidth;
                const double upwards = (1 - 2 * (y + 0.5) / height) * camera.tanHalfHeight;
                const glm::dvec3 direction =
                    glm::normalize(camera.forward + across * camera.right + upwards * camera.up);
                picture.pixels[size_t(y) * width + x] = scene.look(camera.eye, direction, toSun);
            }
        }
    });
    return picture;
}

bool nearEdge(const RayPicture& picture, glm::dvec3 eye, u32 x, u32 y)
{
    const RayHit& here = picture.at(x, y);
    const double distance = glm::length(here.position - eye);
    return anyNeighbour(picture, x, y, [&](const RayHit& other) { return !sameSurface(here, other, distance); });
}

bool nearPatchBorder(const RayPicture& picture, u32 x, u32 y)
{
    const u32 patch = picture.at(x, y).patch;
    return anyNeighbour(picture, x, y, [&](const RayHit& other) { return other.patch != patch; });
}

Agreement compareVisibility(const RayPicture& rays, glm::dvec3 eye, std::span<const float> visibility)
{
    HELIO_CHECK(visibility.size() == rays.pixels.size(), visibility.size(), " of ", rays.pixels.size(), " pixels");
    Agreement result;
    result.map = makeTestImage(rays.width, rays.height, 20);
    u64 lit = 0;
    for (u32 y = 0; y < rays.height; ++y) {
        for (u32 x = 0; x < rays.width; ++x) {
            const RayHit& hit = rays.at(x, y);
            if (hit.patch == kNoIndex) {
                ++result.background;
                continue;
            }
            if (nearEdge(rays, eye, x, y)) {
                ++result.nearEdge;
                continue;
            }
            const bool shown = visibility[size_t(y) * rays.width + x] > 0.5f;
            ++result.compared;
            if (hit.lit) ++lit;
            if (shown == hit.lit) ++result.agreeing;
            float* pixel = result.map.at(x, y);
            const float grey = hit.lit ? 220.0f : 80.0f;
            pixel[0] = shown == hit.lit ? grey : shown ? 255.0f : 0.0f;
            pixel[1] = shown == hit.lit ? grey : 0.0f;
            pixel[2] = shown == hit.lit ? grey : shown ? 0.0f : 255.0f;
        }
    }
    result.lit = result.compared == 0 ? 0.0 : double(lit) / double(result.compared);
    return result;
}

} // namespace helio
