// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/cleanup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <set>

#include "city/grammar/program.h"

namespace helio::cga {

namespace {

using Key = std::array<double, 3>;
using EdgeKey = std::pair<Key, Key>;

Key keyOf(const glm::dvec3& p)
{
    return {p.x, p.y, p.z};
}

template <class Visit> void forEachRing(Geometry& geometry, const Visit& visit)
{
    for (Face& face : geometry.faces) {
        visit(face, face.polygon.outer);
        for (Ring3& hole : face.polygon.holes) visit(face, hole);
    }
}

/// Drops rings and faces that have no corners left to be one.
void dropEmpty(Geometry& geometry)
{
    for (Face& face : geometry.faces)
        std::erase_if(face.polygon.holes, [](const Ring3& hole) { return hole.size() < 3; });
    std::erase_if(geometry.faces, [](const Face& face) { return face.polygon.outer.size() < 3; });
}

void mergeCorners(Geometry& geometry, double distance)
{
    std::vector<glm::dvec3> kept;
    std::map<Key, glm::dvec3> known;
    forEachRing(geometry, [&](Face&, Ring3& ring) {
        Ring3 merged;
        for (const glm::dvec3& p : ring) {
            auto [it, added] = known.emplace(keyOf(p), p);
            if (added) {
                const auto near = std::find_if(kept.begin(), kept.end(),
                                               [&](const glm::dvec3& q) { return glm::distance(p, q) <= distance; });
                if (near == kept.end())
                    kept.push_back(p);
                else
                    it->second = *near;
            }
            if (merged.empty() || merged.back() != it->second) merged.push_back(it->second);
        }
        while (merged.size() > 1 && merged.back() == merged.front()) merged.pop_back();
        ring = std::move(merged);
    });
    dropEmpty(geometry);
}

/// Removes corners at which no ring turns: where one does, its neighbours need the corner too.
void dropStraightCorners(Geometry& geometry, double angle)
{
    std::set<Key> turning;
    const auto turns = [&](const Ring3& ring, size_t k) {
        const glm::dvec3 before = ring[k] - ring[(k + ring.size() - 1) % ring.size()],
                         after = ring[(k + 1) % ring.size()] - ring[k];
        return std::atan2(glm::length(glm::cross(before, after)), glm::dot(before, after)) > angle;
    };
    forEachRing(geometry, [&](Face&, Ring3& ring) {
        for (size_t k = 0; k < ring.size(); ++k)
            if (turns(ring, k)) turning.insert(keyOf(ring[k]));
    });
    forEachRing(geometry, [&](Face&, Ring3& ring) {
        std::erase_if(ring, [&](const glm::dvec3& p) { return turning.count(keyOf(p)) == 0; });
    });
    dropEmpty(geometry);
}

/// Joins a group of coplanar faces to one along their common edges; false if they do not make one outline with holes.
bool joined(const Geometry& geometry, const std::vector<size_t>& group, Face& result)
{
    std::set<EdgeKey> edges;
    for (const size_t k : group) {
        const auto add = [&](const Ring3& ring) {
            for (size_t i = 0; i < ring.size(); ++i) {
                const Key a = keyOf(ring[i]), b = keyOf(ring[(i + 1) % ring.size()]);
                if (edges.erase({b, a}) == 0) edges.insert({a, b});
            }
        };
        add(geometry.faces[k].polygon.outer);
        for (const Ring3& hole : geometry.faces[k].polygon.holes) add(hole);
    }
    std::map<Key, Key> next;
    for (const EdgeKey& edge : edges)
        if (!next.emplace(edge.first, edge.second).second) return false; // rings that touch in a corner
    const glm::dvec3 normal = unitNormal(geometry.faces[group[0]].polygon);
    result = geometry.faces[group[0]];
    result.polygon = {};
    result.edges.clear();
    while (!next.empty()) {
        Ring3 ring;
        for (auto at = next.begin(); at != next.end();) {
            ring.emplace_back(at->first[0], at->first[1], at->first[2]);
            const Key to = at->second;
            next.erase(at);
            at = next.find(to);
        }
        const bool outer = glm::dot(vectorArea(ring), normal) > 0.0;
        if (outer && !result.polygon.outer.empty()) return false;
        if (outer)
            result.polygon.outer = std::move(ring);
        else
            result.polygon.holes.push_back(std::move(ring));
    }
    return !result.polygon.outer.empty();
}

void joinFaces(Geometry& geometry, double angle)
{
    std::vector<size_t> parent(geometry.faces.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](size_t k) {
        while (parent[k] != k) k = parent[k] = parent[parent[k]];
        return k;
    };
    std::vector<glm::dvec3> normals;
    std::map<EdgeKey, size_t> owner;
    for (size_t k = 0; k < geometry.faces.size(); ++k) {
        const Polygon3& polygon = geometry.faces[k].polygon;
        normals.push_back(unitNormal(polygon));
        const auto visit = [&](const Ring3& ring) {
            for (size_t i = 0; i < ring.size(); ++i) {
                const Key a = keyOf(ring[i]), b = keyOf(ring[(i + 1) % ring.size()]);
                owner.emplace(EdgeKey(a, b), k);
                const auto other = owner.find({b, a});
                if (other == owner.end()) continue;
                const glm::dvec3 &m = normals[k], &n = normals[other->second];
                if (std::atan2(glm::length(glm::cross(m, n)), glm::dot(m, n)) <= angle)
                    parent[root(k)] = root(other->second);
            }
        };
        visit(polygon.outer);
        for (const Ring3& hole : polygon.holes) visit(hole);
    }
    std::map<size_t, std::vector<size_t>> groups;
    for (size_t k = 0; k < parent.size(); ++k) groups[root(k)].push_back(k);
    std::vector<bool> gone(parent.size(), false);
    for (const auto& [first, group] : groups) {
        Face face;
        if (group.size() < 2 || !joined(geometry, group, face)) continue;
        for (const size_t k : group) gone[k] = true;
        gone[group[0]] = false;
        geometry.faces[group[0]] = std::move(face);
    }
    size_t kept = 0;
    for (size_t k = 0; k < gone.size(); ++k) {
        if (gone[k]) continue;
        if (kept != k) geometry.faces[kept] = std::move(geometry.faces[k]);
        ++kept;
    }
    geometry.faces.resize(kept);
}

void dropFaces(Geometry& geometry, double smallest)
{
    std::set<std::vector<Key>> seen;
    std::erase_if(geometry.faces, [&](const Face& face) {
        if (area(face.polygon) <= smallest) return true;
        if (geometry.closed) return false;
        std::vector<Key> corners;
        for (const glm::dvec3& p : face.polygon.outer) corners.push_back(keyOf(p));
        std::sort(corners.begin(), corners.end());
        return !seen.insert(std::move(corners)).second;
    });
}

} // namespace

Geometry cleaned(const Geometry& geometry, u32 what, double tolerance)
{
    // Below a nanometre, a microradian and 1e-9 m2 there is only rounding.
    const double angle = std::max(1e-6, tolerance * 10.0 * M_PI / 180.0);
    Geometry result = geometry;
    if (what & kCleanVertices) mergeCorners(result, std::max(1e-9, tolerance));
    if (what & kCleanEdges) joinFaces(result, angle);
    if (what & kCleanVertices) dropStraightCorners(result, angle);
    if (what & kCleanFaces) dropFaces(result, std::max(1e-9, result.closed ? 0.0 : tolerance));
    for (Face& face : result.faces) face.edges.clear();
    return result;
}

} // namespace helio::cga
