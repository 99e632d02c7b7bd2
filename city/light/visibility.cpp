// SPDX-License-Identifier: Apache-2.0
#include "city/light/visibility.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "city/base/check.h"
#include "city/model/ring_polygons.h"
#include "city/model/triangulate.h"

namespace helio {

struct Visibility::Scene
{
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    glm::dvec3 origin{0.0};
    double lift = 0.0;              // m, how far rays start off a surface
    std::vector<glm::vec3> corners; // three a triangle, shared with Embree (padded by one)
    std::vector<u32> triangleBegin; // per patch, + 1
    std::vector<u32> patchOfTriangle;
    std::vector<float> areaUpTo; // share of the patch's area up to and with each triangle

    /// What a ray met, from the triangle's normal and the place on it.
    RayHit hitOn(u32 triangle, const glm::vec3& normal, float u, float v, const glm::dvec3& direction) const
    {
        // From the corners: more exact than the ray's own length where it came from far away.
        const glm::dvec3 a(corners[3 * triangle]), b(corners[3 * triangle + 1]), c(corners[3 * triangle + 2]);
        const bool front = glm::dot(glm::dvec3(normal), direction) < 0.0;
        return {patchOfTriangle[triangle], front, origin + a + double(u) * (b - a) + double(v) * (c - a)};
    }
};

namespace {

constexpr const char* kMemoryHint =
    " triangles (about 200 bytes each); bake a smaller area or on a machine with more memory";

RTCRay makeRay(const glm::dvec3& origin, const glm::dvec3& direction, double end)
{
    RTCRay ray{};
    ray.org_x = float(origin.x);
    ray.org_y = float(origin.y);
    ray.org_z = float(origin.z);
    ray.dir_x = float(direction.x);
    ray.dir_y = float(direction.y);
    ray.dir_z = float(direction.z);
    ray.tnear = 0.0f;
    ray.tfar = float(end);
    ray.mask = ~0u;
    return ray;
}

constexpr size_t kWidth = 8; // of a packet

/// Ray k of a packet.
void setRay(RTCRay8& packet, size_t k, const glm::dvec3& origin, const glm::dvec3& direction, float end)
{
    packet.org_x[k] = float(origin.x);
    packet.org_y[k] = float(origin.y);
    packet.org_z[k] = float(origin.z);
    packet.dir_x[k] = float(direction.x);
    packet.dir_y[k] = float(direction.y);
    packet.dir_z[k] = float(direction.z);
    packet.tfar[k] = end;
    packet.mask[k] = ~0u;
}

/// Fills a packet with rays first, first + 1, ... of `total` and marks those that are there in `valid`; places past the
/// last one repeat it. ray(k): start and direction of ray k. Gives their number.
template <class Ray>
size_t fillPacket(RTCRay8& packet, int (&valid)[kWidth], size_t first, size_t total, float end, Ray&& ray)
{
    const size_t count = std::min(kWidth, total - first);
    for (size_t k = 0; k < kWidth; ++k) {
        valid[k] = k < count ? -1 : 0;
        const auto [origin, direction] = ray(first + std::min(k, count - 1));
        setRay(packet, k, origin, direction, end);
    }
    return count;
}

/// Shadow rays eight at a time: faster, since rays side by side go through the structure together. ray(k): start and
/// direction of ray k.
template <class Ray>
void traceShadows(RTCScene scene, float end, bool coherent, std::span<bool> blocked, Ray&& ray)
{
    for (size_t first = 0; first < blocked.size(); first += kWidth) {
        alignas(32) RTCRay8 rays{};
        alignas(32) int valid[kWidth];
        const size_t count = fillPacket(rays, valid, first, blocked.size(), end, ray);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcOccluded8(valid, scene, &context, &rays);
        for (size_t k = 0; k < count; ++k) blocked[first + k] = rays.tfar[k] < 0.0f;
    }
}

} // namespace

Visibility::Visibility(const NodeTree& tree) : scene_(std::make_unique<Scene>())
{
    Scene& s = *scene_;
    glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (const Ring3& ring : tree.rings) {
        for (const glm::dvec3& p : ring) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    s.origin = tree.rings.empty() ? glm::dvec3(0.0) : 0.5 * (low + high);
    // Float coordinates err by half a unit in the last place; the products of a ray intersection by a few more.
    const double extent = tree.rings.empty() ? 1.0 : glm::length(0.5 * (high - low));
    s.lift = 16.0 * extent * double(std::numeric_limits<float>::epsilon());

    s.triangleBegin.push_back(0);
    for (u32 patch = 0; patch < tree.patchCount(); ++patch) {
        double total = 0.0;
        const size_t first = s.areaUpTo.size();
        for (const Polygon3& polygon : ringPolygons(tree, tree.nodes[patch].ringBegin, tree.nodes[patch].ringCount)) {
            std::vector<glm::dvec3> corners(polygon.outer);
            for (const Ring3& hole : polygon.holes) corners.insert(corners.end(), hole.begin(), hole.end());
            for (const auto& t : triangulate(polygon)) {
                total += 0.5 * glm::length(glm::cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]]));
                s.areaUpTo.push_back(float(total));
                s.patchOfTriangle.push_back(patch);
                for (const u32 corner : t) s.corners.emplace_back(corners[corner] - s.origin);
            }
        }
        for (size_t t = first; t < s.areaUpTo.size(); ++t)
            s.areaUpTo[t] = total > 0.0 ? float(double(s.areaUpTo[t]) / total) : 1.0f;
        s.triangleBegin.push_back(u32(s.patchOfTriangle.size()));
    }
    const size_t triangles = s.patchOfTriangle.size();
    constexpr size_t kMostTriangles = std::numeric_limits<u32>::max() / 3;
    HELIO_CHECK(triangles <= kMostTriangles, "the patches make ", triangles, " triangles, the limit of the rays is ",
                kMostTriangles, "; bake a smaller area");
    s.corners.emplace_back(0.0f); // Embree reads 16 bytes a vertex.

    // One thread: the order of triangles inside the structure, hence ties between coincident ones, must not vary.
    s.device = rtcNewDevice("threads=1");
    HELIO_CHECK(s.device != nullptr, "Embree gives no device, error ", int(rtcGetDeviceError(nullptr)));
    s.scene = rtcNewScene(s.device);
    rtcSetSceneFlags(s.scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, s.corners.data(), 0,
                               sizeof(glm::vec3), s.corners.size() - 1);
    auto* indices = static_cast<u32*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                              3 * sizeof(u32), std::max<size_t>(1, triangles)));
    HELIO_CHECK(indices != nullptr, "Embree has no memory for ", triangles, kMemoryHint);
    for (u32 i = 0; i < 3 * triangles; ++i) indices[i] = i;
    if (triangles == 0) indices[0] = indices[1] = indices[2] = 0;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(s.scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(s.scene);
    const RTCError error = rtcGetDeviceError(s.device);
    HELIO_CHECK(error != RTC_ERROR_OUT_OF_MEMORY, "Embree has no memory for ", triangles, kMemoryHint);
    HELIO_CHECK(error == RTC_ERROR_NONE, "Embree error ", int(error), " with ", triangles, " triangles");
}

Visibility::~Visibility()
{
    rtcReleaseScene(scene_->scene);
    rtcReleaseDevice(scene_->device);
}

u32 Visibility::triangleCount() const
{
    return u32(scene_->patchOfTriangle.size());
}

glm::dvec3 Visibility::pointOnPatch(u32 patch, double u, double v) const
{
    const Scene& s = *scene_;
    const u32 begin = s.triangleBegin[patch], end = s.triangleBegin[patch + 1];
    if (begin == end) return s.origin;
    u32 t = begin;
    while (t + 1 < end && double(s.areaUpTo[t]) <= u) ++t;
    const double below = t > begin ? double(s.areaUpTo[t - 1]) : 0.0, share = double(s.areaUpTo[t]) - below;
    const double w = share > 0.0 ? std::clamp((u - below) / share, 0.0, 1.0) : 0.5;
    // Area-preserving map of the unit square to a triangle.
    const double r = std::sqrt(w);
    const glm::dvec3 a(s.corners[3 * t]), b(s.corners[3 * t + 1]), c(s.corners[3 * t + 2]);
    return s.origin + (1.0 - r) * a + r * (1.0 - v) * b + r * v * c;
}

bool Visibility::isBlocked(const glm::dvec3& from, const glm::dvec3& fromNormal, const glm::dvec3& to,
                           const glm::dvec3& toNormal) const
{
    const glm::dvec3 a = from - scene_->origin + scene_->lift * fromNormal;
    const glm::dvec3 b = to - scene_->origin + scene_->lift * toNormal;
    RTCRay ray = makeRay(a, b - a, 1.0);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_->scene, &context, &ray);
    return ray.tfar < 0.0f;
}

bool Visibility::isBlocked(const glm::dvec3& from, const glm::dvec3& normal, const glm::dvec3& direction) const
{
    RTCRay ray = makeRay(from - scene_->origin + scene_->lift * normal, direction,
                         double(std::numeric_limits<float>::infinity()));
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_->scene, &context, &ray);
    return ray.tfar < 0.0f;
}

void Visibility::areBlocked(std::span<const glm::dvec3> from, const glm::dvec3& normal, const glm::dvec3& direction,
                            std::span<bool> blocked) const
{
    HELIO_CHECK(blocked.size() == from.size(), blocked.size(), " places for ", from.size(), " rays");
    const glm::dvec3 lift = scene_->lift * normal - scene_->origin;
    traceShadows(scene_->scene, std::numeric_limits<float>::infinity(), true, blocked,
                 [&](size_t k) { return std::pair(from[k] + lift, direction); });
}

void Visibility::areBlocked(std::span<const glm::dvec3> from, const glm::dvec3& fromNormal,
                            std::span<const glm::dvec3> to, const glm::dvec3& toNormal, std::span<bool> blocked) const
{
    HELIO_CHECK(blocked.size() == from.size() && to.size() == from.size(), from.size(), " and ", to.size(), " ends, ",
                blocked.size(), " places");
    const glm::dvec3 lift = scene_->lift * fromNormal - scene_->origin, turn = scene_->lift * (toNormal - fromNormal);
    traceShadows(scene_->scene, 1.0f, false, blocked,
                 [&](size_t k) { return std::pair(from[k] + lift, to[k] - from[k] + turn); });
}

RayHit Visibility::trace(const glm::dvec3& from, const glm::dvec3& normal, const glm::dvec3& direction) const
{
    RTCRayHit hit{};
    hit.ray = makeRay(from - scene_->origin + scene_->lift * normal, direction,
                      double(std::numeric_limits<float>::infinity()));
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_->scene, &context, &hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return scene_->hitOn(hit.hit.primID, {hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z}, hit.hit.u, hit.hit.v, direction);
}

void Visibility::trace(std::span<const glm::dvec3> from, const glm::dvec3& normal,
                       std::span<const glm::dvec3> direction, std::span<RayHit> hit) const
{
    HELIO_CHECK(direction.size() == from.size() && hit.size() == from.size(), from.size(), " starts, ",
                direction.size(), " directions, ", hit.size(), " places");
    const glm::dvec3 lift = scene_->lift * normal - scene_->origin;
    for (size_t first = 0; first < from.size(); first += kWidth) {
        alignas(32) RTCRayHit8 packet{};
        alignas(32) int valid[kWidth];
        const size_t count =
            fillPacket(packet.ray, valid, first, from.size(), std::numeric_limits<float>::infinity(),
                       [&](size_t k) { return std::pair(from[k] + lift, direction[k]); });
        for (size_t k = 0; k < kWidth; ++k) {
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect8(valid, scene_->scene, &context, &packet);
        for (size_t k = 0; k < count; ++k) {
            hit[first + k] = {};
            if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
            hit[first + k] =
                scene_->hitOn(packet.hit.primID[k], {packet.hit.Ng_x[k], packet.hit.Ng_y[k], packet.hit.Ng_z[k]},
                              packet.hit.u[k], packet.hit.v[k], direction[first + k]);
        }
    }
}

} // namespace helio
