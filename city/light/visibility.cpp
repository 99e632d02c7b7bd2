// SPDX-License-Identifier: Apache-2.0
#include "city/light/visibility.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>

#include "city/base/check.h"
#include "city/light/filled_nodes.h"
#include "city/model/ring_polygons.h"
#include "city/model/triangulate.h"

namespace helio {

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

constexpr size_t kWidth = 8;       // of a packet
constexpr double kOffPlane = 0.25; // of the lift: how far patches may lie off the plane of what blocks in their place

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

/// Shadow rays eight at a time: faster, since rays side by side go through the structure together. Those that are
/// blocked get a negative end.
void occlude(RTCScene scene, bool coherent, int (&valid)[kWidth], RTCRay8& rays)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &context, &rays);
}

/// Embree's structure over triangles of their own corners.
class RayStructure
{
public:
    /// `corners`: three a triangle, kept by the caller, with one more behind them: Embree reads 16 bytes a corner.
    explicit RayStructure(const std::vector<glm::vec3>& corners)
    {
        const size_t triangles = corners.size() / 3;
        constexpr size_t kMostTriangles = std::numeric_limits<u32>::max() / 3;
        HELIO_CHECK(triangles <= kMostTriangles, "the patches make ", triangles,
                    " triangles, the limit of the rays is ", kMostTriangles, "; bake a smaller area");
        // One thread: the order of triangles inside the structure, hence ties between coincident ones, must not vary.
        device_ = rtcNewDevice("threads=1");
        HELIO_CHECK(device_ != nullptr, "Embree gives no device, error ", int(rtcGetDeviceError(nullptr)));
        scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, corners.data(), 0,
                                   sizeof(glm::vec3), corners.size() - 1);
        auto* indices = static_cast<u32*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                  3 * sizeof(u32), std::max<size_t>(1, triangles)));
        HELIO_CHECK(indices != nullptr, "Embree has no memory for ", triangles, kMemoryHint);
        for (u32 i = 0; i < 3 * triangles; ++i) indices[i] = i;
        if (triangles == 0) indices[0] = indices[1] = indices[2] = 0;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        const RTCError error = rtcGetDeviceError(device_);
        HELIO_CHECK(error != RTC_ERROR_OUT_OF_MEMORY, "Embree has no memory for ", triangles, kMemoryHint);
        HELIO_CHECK(error == RTC_ERROR_NONE, "Embree error ", int(error), " with ", triangles, " triangles");
    }

    ~RayStructure()
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    RayStructure(const RayStructure&) = delete;
    RayStructure& operator=(const RayStructure&) = delete;

    RTCScene scene() const { return scene_; }

private:
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

} // namespace

struct Visibility::Scene
{
    glm::dvec3 origin{0.0};
    double lift = 0.0; // m, how far rays start off a surface

    std::vector<glm::vec3> corners; // of the patches' triangles, three each
    std::vector<u32> triangleBegin; // per patch, + 1
    std::vector<u32> patchOfTriangle;
    std::vector<float> areaUpTo; // share of the patch's area up to and with each triangle

    std::vector<u8> filled;                // per node, see filledNodes()
    std::vector<glm::vec3> blockerCorners; // of the triangles that stand for them, three each
    std::vector<u32> nodeOfBlocker;
    std::unique_ptr<RayStructure> blockers;

    std::once_flag needsPatches;
    std::unique_ptr<RayStructure> patches; // see patchStructure()

    void addPatches(const NodeTree& tree)
    {
        triangleBegin.push_back(0);
        for (u32 patch = 0; patch < tree.patchCount(); ++patch) {
            double total = 0.0;
            const size_t first = areaUpTo.size();
            const Node& node = tree.nodes[patch];
            for (const Polygon3& polygon : ringPolygons(tree, node.ringBegin, node.ringCount)) {
                std::vector<glm::dvec3> outline(polygon.outer);
                for (const Ring3& hole : polygon.holes) outline.insert(outline.end(), hole.begin(), hole.end());
                for (const auto& t : triangulate(polygon)) {
                    const glm::dvec3 &a = outline[t[0]], &b = outline[t[1]], &c = outline[t[2]];
                    total += 0.5 * glm::length(glm::cross(b - a, c - a));
                    areaUpTo.push_back(float(total));
                    patchOfTriangle.push_back(patch);
                    for (const u32 corner : t) corners.emplace_back(outline[corner] - origin);
                }
            }
            for (size_t t = first; t < areaUpTo.size(); ++t)
                areaUpTo[t] = total > 0.0 ? float(double(areaUpTo[t]) / total) : 1.0f;
            triangleBegin.push_back(u32(patchOfTriangle.size()));
        }
    }

    /// A filled node as a fan, another one by what is below it.
    void addBlockers(const NodeTree& tree, u32 node)
    {
        const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
            for (const glm::vec3& corner : {a, b, c}) blockerCorners.push_back(corner);
            nodeOfBlocker.push_back(node);
        };
        if (filled[node] != 0) {
            const Ring3 ring = withoutStraightCorners(tree.outlineOf(node)[0]);
            const auto corner = [&](size_t k) { return glm::vec3(ring[k] - origin); };
            for (size_t k = 1; k + 1 < ring.size(); ++k) add(corner(0), corner(k), corner(k + 1));
        } else if (tree.isLeaf(node)) {
            for (size_t t = triangleBegin[node]; t < triangleBegin[node + 1]; ++t)
                add(corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]);
        } else {
            for (const u32 child : tree.childrenOf(node)) addBlockers(tree, child);
        }
    }

    /// The structure over the patches themselves: few need to know which patch a ray met, and it is built when one
    /// does.
    RTCScene patchStructure()
    {
        std::call_once(needsPatches, [this] { patches = std::make_unique<RayStructure>(corners); });
        return patches->scene();
    }
};

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
    s.addPatches(tree);
    s.filled = filledNodes(tree, kOffPlane * s.lift);
    for (u32 i = 0; i < tree.nodeCount(); ++i)
        if (tree.isPlanarRoot(i)) s.addBlockers(tree, i);
    for (std::vector<glm::vec3>* all : {&s.corners, &s.blockerCorners}) all->emplace_back(0.0f);
    s.blockers = std::make_unique<RayStructure>(s.blockerCorners);
}

Visibility::~Visibility() = default;

glm::dvec3 Visibility::origin() const
{
    return scene_->origin;
}

std::span<const glm::vec3> Visibility::trianglesOf(u32 patch) const
{
    const size_t begin = scene_->triangleBegin[patch], end = scene_->triangleBegin[patch + 1];
    return std::span(scene_->corners).subspan(3 * begin, 3 * (end - begin));
}

bool Visibility::isFilled(u32 node) const
{
    return scene_->filled[node] != 0;
}

double Visibility::lift() const
{
    return scene_->lift;
}

u32 Visibility::triangleCount() const
{
    return u32(scene_->nodeOfBlocker.size());
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
    rtcOccluded1(scene_->blockers->scene(), &context, &ray);
    return ray.tfar < 0.0f;
}

bool Visibility::isBlocked(const glm::dvec3& from, const glm::dvec3& normal, const glm::dvec3& direction) const
{
    RTCRay ray = makeRay(from - scene_->origin + scene_->lift * normal, direction,
                         double(std::numeric_limits<float>::infinity()));
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_->blockers->scene(), &context, &ray);
    return ray.tfar < 0.0f;
}

void Visibility::areBlocked(std::span<const glm::dvec3> from, const glm::dvec3& normal,
                            std::span<const glm::dvec3> directions, std::span<bool> blocked) const
{
    const size_t total = from.size();
    HELIO_CHECK(blocked.size() == total * directions.size(), blocked.size(), " places for ", total, " points and ",
                directions.size(), " directions");
    const glm::dvec3 lift = scene_->lift * normal - scene_->origin;
    constexpr float kEndless = std::numeric_limits<float>::infinity();
    for (size_t first = 0; first < total; first += kWidth) {
        alignas(32) RTCRay8 rays{};
        alignas(32) int valid[kWidth];
        const size_t count = fillPacket(rays, valid, first, total, kEndless,
                                        [&](size_t k) { return std::pair(from[k] + lift, glm::dvec3(0.0)); });
        for (size_t d = 0; d < directions.size(); ++d) {
            const glm::vec3 direction(directions[d]);
            for (size_t k = 0; k < kWidth; ++k) {
                rays.dir_x[k] = direction.x;
                rays.dir_y[k] = direction.y;
                rays.dir_z[k] = direction.z;
                rays.tfar[k] = kEndless;
            }
            occlude(scene_->blockers->scene(), true, valid, rays);
            for (size_t k = 0; k < count; ++k) blocked[d * total + first + k] = rays.tfar[k] < 0.0f;
        }
    }
}

void Visibility::areBlocked(std::span<const glm::dvec3> from, const glm::dvec3& fromNormal,
                            std::span<const glm::dvec3> to, const glm::dvec3& toNormal, std::span<bool> blocked) const
{
    HELIO_CHECK(blocked.size() == from.size() && to.size() == from.size(), from.size(), " and ", to.size(), " ends, ",
                blocked.size(), " places");
    const glm::dvec3 lift = scene_->lift * fromNormal - scene_->origin, turn = scene_->lift * (toNormal - fromNormal);
    for (size_t first = 0; first < from.size(); first += kWidth) {
        alignas(32) RTCRay8 rays{};
        alignas(32) int valid[kWidth];
        const size_t count = fillPacket(rays, valid, first, from.size(), 1.0f,
                                        [&](size_t k) { return std::pair(from[k] + lift, to[k] - from[k] + turn); });
        occlude(scene_->blockers->scene(), false, valid, rays);
        for (size_t k = 0; k < count; ++k) blocked[first + k] = rays.tfar[k] < 0.0f;
    }
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
    rtcIntersect1(scene_->patchStructure(), &context, &hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const u32 triangle = hit.hit.primID;
    // From the corners: more exact than the ray's own length where it came from far away.
    const glm::vec3* corner = scene_->corners.data() + 3 * size_t(triangle);
    const glm::dvec3 a(corner[0]), b(corner[1]), c(corner[2]);
    const bool front = glm::dot(glm::dvec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z), direction) < 0.0;
    return {scene_->patchOfTriangle[triangle], front,
            scene_->origin + a + double(hit.hit.u) * (b - a) + double(hit.hit.v) * (c - a)};
}

void Visibility::trace(std::span<const glm::dvec3> from, const glm::dvec3& normal,
                       std::span<const glm::dvec3> direction, std::span<RayEnd> end) const
{
    HELIO_CHECK(direction.size() == from.size() && end.size() == from.size(), from.size(), " starts, ",
                direction.size(), " directions, ", end.size(), " places");
    const glm::dvec3 lift = scene_->lift * normal - scene_->origin;
    for (size_t first = 0; first < from.size(); first += kWidth) {
        alignas(32) RTCRayHit8 packet{};
        alignas(32) int valid[kWidth];
        const size_t count = fillPacket(packet.ray, valid, first, from.size(), std::numeric_limits<float>::infinity(),
                                        [&](size_t k) { return std::pair(from[k] + lift, direction[k]); });
        for (size_t k = 0; k < kWidth; ++k) {
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect8(valid, scene_->blockers->scene(), &context, &packet);
        for (size_t k = 0; k < count; ++k) {
            end[first + k] = {};
            if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
            const glm::dvec3 met(packet.hit.Ng_x[k], packet.hit.Ng_y[k], packet.hit.Ng_z[k]);
            end[first + k] = {scene_->nodeOfBlocker[packet.hit.primID[k]], glm::dot(met, direction[first + k]) < 0.0,
                              packet.ray.tfar[k]};
        }
    }
}

} // namespace helio
