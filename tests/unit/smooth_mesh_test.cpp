// SPDX-License-Identifier: Apache-2.0
// Interpolated light: keeps means, has no jumps inside a plane, mixes nothing across edges and buildings.
#include "engine/stream/smooth_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <set>

#include "tests/support/smooth_twin.h"
#include "tests/support/wall_builder.h"

namespace helio {

namespace {

SmoothMesh refine(const WallBuilder& b, const std::vector<bool>& dark = {})
{
    return buildSmoothMesh(b.vertices, b.indices, b.patches, dark);
}

struct Triangle
{
    std::array<glm::dvec3, 3> position;
    std::array<u32, 3> value;
    u32 patch, normal;

    glm::dvec3 areaVector() const { return 0.5 * glm::cross(position[1] - position[0], position[2] - position[0]); }
};

std::vector<Triangle> trianglesOf(const SmoothMesh& mesh)
{
    std::vector<Triangle> out;
    for (size_t k = 0; k < mesh.indices.size(); k += 3) {
        Triangle t{};
        for (size_t i = 0; i < 3; ++i) {
            const u32 vertex = mesh.indices[k + i];
            t.position[i] = mesh.vertices[vertex].position;
            t.value[i] = mesh.valueOfVertex[vertex];
            t.patch = mesh.vertices[vertex].patchId;
            t.normal = mesh.vertices[vertex].normal;
        }
        out.push_back(t);
    }
    return out;
}

bool isFlat(const SmoothMesh& mesh, const Triangle& t)
{
    return t.value[0] >= mesh.cornerCount && t.value[1] >= mesh.cornerCount;
}

/// The integral of the piecewise linear light over each patch, over its area.
std::vector<glm::dvec4> integrate(const SmoothMesh& mesh, const std::vector<glm::dvec4>& values, size_t patchCount)
{
    std::vector<glm::dvec4> sums(patchCount, glm::dvec4(0.0));
    std::vector<double> areas(patchCount, 0.0);
    for (const Triangle& t : trianglesOf(mesh)) {
        const double area = glm::length(t.areaVector());
        areas[t.patch] += area;
        for (const u32 value : t.value) sums[t.patch] += area / 3.0 * values[value];
    }
    for (size_t p = 0; p < patchCount; ++p) sums[p] /= areas[p];
    return sums;
}

void expectMeans(const SmoothMesh& mesh, const std::vector<glm::dvec4>& means)
{
    const std::vector<glm::dvec4> values = twin::smoothLight(mesh, means);
    for (const glm::dvec4& value : values)
        for (int c = 0; c < 4; ++c) EXPECT_GE(value[c], -1e-3) << "channel " << c;
    const std::vector<glm::dvec4> integrals = integrate(mesh, values, means.size());
    for (size_t p = 0; p < means.size(); ++p)
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(integrals[p][c], means[p][c], 1e-6 * means[p][c]) << "patch " << p << ", channel " << c;
}

/// The same surface: the area of every patch (borders move by up to a millimetre where corners join), its triangles on
/// the same side.
void expectSurface(const SmoothMesh& mesh, const WallBuilder& b)
{
    std::vector<glm::dvec3> before(b.patches.size(), glm::dvec3(0.0)), after = before;
    std::vector<double> perimeter(b.patches.size(), 0.0);
    glm::dvec3 all(0.0);
    for (size_t k = 0; k < b.indices.size(); k += 3) {
        const gpu::VertexRecord* const v = &b.vertices[b.indices[k]];
        before[v->patchId] +=
            0.5 * glm::dvec3(glm::cross(v[1].position - v[0].position, v[2].position - v[0].position));
        for (int i = 0; i < 3; ++i)
            perimeter[v->patchId] += double(glm::distance(v[i].position, v[(i + 1) % 3].position));
    }
    for (const Triangle& t : trianglesOf(mesh)) {
        after[t.patch] += t.areaVector();
        if (!isFlat(mesh, t)) {
            EXPECT_GT(glm::dot(t.areaVector(), glm::dvec3(b.patches[t.patch].normal)), 0.0);
        }
    }
    for (size_t p = 0; p < before.size(); ++p) {
        EXPECT_LE(glm::length(after[p] - before[p]), 1e-5 + 1e-3 * perimeter[p]) << "patch " << p;
        all += after[p] - before[p];
    }
    EXPECT_LE(glm::length(all), 1e-3) << "what one loses its neighbour gains";
}

/// The light at a point, if it lies in the triangle or on its border.
std::optional<glm::dvec4> lightAt(const Triangle& t, const glm::dvec3& point, const std::vector<glm::dvec4>& values)
{
    constexpr double kNear = 1e-5; // m
    const glm::dvec3 normal = t.areaVector();
    const double area = glm::length(normal);
    if (std::abs(glm::dot(point - t.position[0], normal)) > kNear * area) return {};
    glm::dvec4 light(0.0);
    for (size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &a = t.position[(i + 1) % 3], &b = t.position[(i + 2) % 3];
        const double part = glm::dot(0.5 * glm::cross(a - point, b - point), normal) / area;
        if (part < -0.5 * kNear * glm::length(b - a)) return {};
        light += part / area * values[t.value[i]];
    }
    return light;
}

/// Samples every edge and compares the light of all triangles there; returns how many pairs of patches were compared.
u32 expectContinuity(const SmoothMesh& mesh, const WallBuilder& b, const std::vector<glm::dvec4>& means, Random& random)
{
    const std::vector<glm::dvec4> values = twin::smoothLight(mesh, means);
    std::vector<Triangle> triangles = trianglesOf(mesh);
    std::erase_if(triangles, [&](const Triangle& t) { return isFlat(mesh, t); });
    std::set<std::pair<u32, u32>> met;
    for (const Triangle& t : triangles)
        for (size_t i = 0; i < 3; ++i) {
            const double at = 0.02 + 0.96 * random.uniform();
            const glm::dvec3 point = (1 - at) * t.position[i] + at * t.position[(i + 1) % 3];
            const glm::dvec4 own = *lightAt(t, point, values);
            for (const Triangle& other : triangles) {
                if (other.normal != t.normal || b.patches[other.patch].building != b.patches[t.patch].building)
                    continue;
                const std::optional<glm::dvec4> light = lightAt(other, point, values);
                if (!light) continue;
                if (other.patch != t.patch) met.insert({t.patch, other.patch});
                for (int c = 0; c < 4; ++c)
                    EXPECT_NEAR((*light)[c], own[c], 2e-3 * (own[c] + 1.0))
                        << "patches " << t.patch << " and " << other.patch << ", channel " << c;
            }
        }
    return u32(met.size());
}

/// Patches that share a corner are of one building and one plane.
void expectUnmixed(const SmoothMesh& mesh, const WallBuilder& b)
{
    for (u32 c = 0; c < mesh.cornerCount; ++c)
        for (u32 k = mesh.cornerRows[c] + 1; k < mesh.cornerRows[c + 1]; ++k) {
            const gpu::PatchRecord &one = b.patches[mesh.cornerPatches[k - 1]], &two = b.patches[mesh.cornerPatches[k]];
            EXPECT_EQ(one.building, two.building);
            EXPECT_EQ(one.normal, two.normal);
        }
}

const WallPlane kWall{};

TEST(SmoothMesh, JunctionsBecomeCornersOfBothSides)
{
    WallBuilder b; // 0 and 1 side by side below, 2 over both
    b.rectangle(b.patch(kWall), {0, 0}, {1, 1});
    b.rectangle(b.patch(kWall), {1, 0}, {2, 1});
    b.rectangle(b.patch(kWall), {0, 1}, {2, 2});
    const SmoothMesh mesh = refine(b);
    EXPECT_EQ(mesh.cornerCount, 8u);
    EXPECT_EQ(mesh.indices.size() / 3, 4u + 4u + 5u);
    EXPECT_EQ(mesh.fanWeights.size(), 0u) << "one fan a patch";
    std::multiset<u32> meeting;
    for (u32 c = 0; c < mesh.cornerCount; ++c) meeting.insert(mesh.cornerRows[c + 1] - mesh.cornerRows[c]);
    EXPECT_EQ(meeting, (std::multiset<u32>{1, 1, 1, 1, 2, 2, 2, 3}));
    const std::vector<glm::dvec4> values =
        twin::smoothLight(mesh, std::vector<glm::dvec4>{glm::dvec4(2), glm::dvec4(2), glm::dvec4(2)});
    for (const glm::dvec4& value : values) EXPECT_NEAR(value.r, 2.0, 1e-12);
}

TEST(SmoothMesh, KeepsMeansSurfaceAndContinuity)
{
    for (u64 seed = 0; seed < 4; ++seed) {
        Random random(seed);
        WallBuilder b;
        b.everything(random, 30);
        const SmoothMesh mesh = refine(b);
        EXPECT_GT(mesh.fanWeights.size(), 0u) << "the L";
        const std::vector<glm::dvec4> means = twin::randomMeans(random, b.patches.size());
        expectMeans(mesh, means);
        expectSurface(mesh, b);
        expectUnmixed(mesh, b);
        EXPECT_GT(expectContinuity(mesh, b, means, random), 4 * b.patches.size());
    }
}

TEST(SmoothMesh, ManyPatches)
{
    Random random(7);
    WallBuilder b;
    b.guillotine(random, kWall, {-30, 0}, {30, 20}, 5000);
    const SmoothMesh mesh = refine(b);
    expectMeans(mesh, twin::randomMeans(random, b.patches.size()));
    expectSurface(mesh, b);
}

TEST(SmoothMesh, EvenRiseIsKept)
{
    // 9 x 9 squares, light rising along both: from the third square on nothing is felt of the wall's end.
    WallBuilder b;
    std::vector<glm::dvec4> means;
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 9; ++x) {
            b.rectangle(b.patch(kWall), {x, y}, {x + 1, y + 1});
            means.emplace_back(100 + x + 2 * y);
        }
    const std::vector<glm::dvec4> values = twin::smoothLight(refine(b), means);
    const SmoothMesh mesh = refine(b);
    for (int y = 3; y < 6; ++y)
        for (int x = 3; x < 6; ++x)
            EXPECT_NEAR(values[mesh.cornerCount + u32(9 * y + x)].r, 100 + x + 2 * y, 1e-9) << "no peak in the middle";
    EXPECT_NEAR(values[mesh.cornerCount + 4].r, 104.0, 0.4) << "at the wall's end a peak of less than half a step";
}

TEST(SmoothMesh, FansOfOnePatchFollowItsNeighbours)
{
    // An L in light that rises along x: its arm ends high, its foot low.
    WallBuilder b;
    const u32 ell = b.patch(kWall);
    b.rectangle(ell, {0, 0}, {1, 10});
    b.rectangle(ell, {1, 0}, {10, 1});
    std::vector<glm::dvec4> means{glm::dvec4(105)};
    for (int x = 1; x < 10; ++x) {
        b.rectangle(b.patch(kWall), {x, 1}, {x + 1, 10});
        means.emplace_back(100.5 + x);
    }
    const SmoothMesh mesh = refine(b);
    const std::vector<glm::dvec4> values = twin::smoothLight(mesh, means);
    double low = 1e9, high = 0.0;
    for (u32 f = mesh.fanRows[ell]; f < mesh.fanRows[ell + 1]; ++f) {
        low = std::min(low, values[mesh.cornerCount + means.size() + f].r);
        high = std::max(high, values[mesh.cornerCount + means.size() + f].r);
    }
    EXPECT_GT(high - low, 2.0);
    expectMeans(mesh, means);
}

TEST(SmoothMesh, ColoursOfOnePatchHaveFansOfTheirOwn)
{
    WallBuilder b; // three squares in a row, the one in the middle in two colours
    b.rectangle(b.patch(kWall), {0, 0}, {2, 2});
    const u32 middle = b.patch(kWall);
    b.rectangle(middle, {2, 0}, {3, 2}, 1);
    b.rectangle(middle, {3, 0}, {4, 2}, 2);
    b.rectangle(b.patch(kWall), {4, 0}, {6, 2});
    const SmoothMesh mesh = refine(b);
    const std::vector<glm::dvec4> means{glm::dvec4(10), glm::dvec4(12), glm::dvec4(14)};
    const std::vector<glm::dvec4> values = twin::smoothLight(mesh, means);
    ASSERT_EQ(mesh.fanRows.back(), 2u);
    EXPECT_NEAR(values[mesh.cornerCount + 3].r, 11.5, 0.2);
    EXPECT_NEAR(values[mesh.cornerCount + 4].r, 12.5, 0.2);
    expectMeans(mesh, means);
}

TEST(SmoothMesh, BuildingsAndPlanesStayApart)
{
    WallBuilder b;
    const WallPlane floor{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    b.rectangle(b.patch(kWall, 0), {0, 0}, {1, 1});
    b.rectangle(b.patch(kWall, 1), {1, 0}, {2, 1});
    b.rectangle(b.patch(floor, 0), {0, 0}, {1, 1});
    b.rectangle(b.patch(floor, gpu::kNone), {1, 0}, {2, 1});
    const SmoothMesh mesh = refine(b);
    EXPECT_EQ(mesh.cornerCount, 16u);
    std::vector<glm::dvec4> means;
    for (const double mean : {1.0, 2.0, 4.0, 8.0}) means.emplace_back(mean);
    const std::vector<glm::dvec4> values = twin::smoothLight(mesh, means);
    for (const Triangle& t : trianglesOf(mesh))
        for (const u32 value : t.value) EXPECT_NEAR(values[value].r, means[t.patch].r, 1e-12);
}

TEST(SmoothMesh, WhatIsNotInThePlaneTakesTheMean)
{
    WallBuilder b;
    const u32 wall = b.patch(kWall);
    b.rectangle(wall, {0, 0}, {1, 1});
    b.foreign(wall, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 0}, {1, 0}, {1, 1});    // at right angles
    b.foreign(wall, {{0, 0.1f, 0}, {1, 0, 0}, {0, 0, 1}}, {0, 0}, {1, 0}, {1, 1}); // behind
    b.rectangle(b.patch(kWall), {1, 0}, {2, 1});
    const SmoothMesh mesh = refine(b);
    const std::vector<glm::dvec4> values =
        twin::smoothLight(mesh, std::vector<glm::dvec4>{glm::dvec4(1), glm::dvec4(2)});
    u32 flat = 0;
    for (const Triangle& t : trianglesOf(mesh)) {
        if (!isFlat(mesh, t)) continue;
        ++flat;
        for (const u32 value : t.value) EXPECT_EQ(values[value].r, 1.0);
    }
    EXPECT_EQ(flat, 2u);
    expectMeans(mesh, {glm::dvec4(1), glm::dvec4(2)});
}

TEST(SmoothMesh, WhatNoLightReachesLeavesItsNeighboursAlone)
{
    // A wall of which another building covers the lower part: no dark rim along it, no peaks above.
    WallBuilder b;
    for (int x = 0; x < 3; ++x) b.rectangle(b.patch(kWall), {x, 0}, {x + 1, 1});
    b.rectangle(b.patch(kWall), {0, -1}, {3, 0});
    const std::vector<glm::dvec4> means{glm::dvec4(10), glm::dvec4(10), glm::dvec4(10), glm::dvec4(0)};
    const SmoothMesh mesh = refine(b, {false, false, false, true});
    const std::vector<glm::dvec4> values = twin::smoothLight(mesh, means);
    for (const Triangle& t : trianglesOf(mesh))
        for (const u32 value : t.value) EXPECT_NEAR(values[value].r, means[t.patch].r, 1e-9) << "patch " << t.patch;
    expectMeans(mesh, means);
    expectSurface(mesh, b);
}

TEST(SmoothMesh, DarkIsWhatHasNoLinksAtAnyLevel)
{
    // Patch 0 sees the sky, 1 has a link, 2 has its light from node 5, two levels up, 3 none.
    const std::vector<gpu::PatchRecord> patches(4);
    std::vector<gpu::NodeRecord> nodes(6, {gpu::kNone, 0, 0, 1.0f});
    nodes[2].parent = 4;
    nodes[4].parent = 5;
    const std::vector<u32> skyRows{0, 1, 1, 1, 1}, linkRows{0, 0, 2, 2, 2, 2, 3};
    TileView tile;
    tile.patches = patches;
    tile.nodes = nodes;
    tile.skyRows = skyRows;
    tile.linkRows = linkRows;
    EXPECT_EQ(darkPatches(tile), (std::vector<bool>{false, false, false, true}));
    EXPECT_TRUE(darkPatches({}).empty());
}

TEST(SmoothMesh, SliversAndNearCorners)
{
    WallBuilder b;
    const u32 strip = b.patch(kWall); // corners on its lower edge, closed by triangles without area
    b.triangle(strip, {0, 0}, {4, 0}, {4, 1});
    b.triangle(strip, {0, 0}, {4, 1}, {0, 1});
    b.triangle(strip, {0, 0}, {1, 0}, {4, 0});
    b.rectangle(b.patch(kWall), {0, -1}, {1, 0.0003f}); // 0.3 mm into it
    b.rectangle(b.patch(kWall), {1.0004f, -1}, {2, 0});
    b.rectangle(b.patch(kWall), {2, -1}, {2.0012f, 0}); // 1.2 mm wide
    b.rectangle(b.patch(kWall), {2.0012f, -1}, {4, 0});
    const u32 line = b.patch(kWall); // nothing but a line
    b.triangle(line, {0, 1}, {4, 1}, {2, 1.0005f});
    const SmoothMesh mesh = refine(b);
    for (size_t p = 0; p < b.patches.size(); ++p) {
        double sum = 0.0;
        for (u32 k = mesh.patchRows[p]; k < mesh.patchRows[p + 1]; ++k) sum += double(mesh.patchWeights[k].weight);
        EXPECT_NEAR(sum, p == line ? 0.0 : 2.0, 1e-6) << "patch " << p;
    }
    Random random(3);
    const std::vector<glm::dvec4> means = twin::randomMeans(random, b.patches.size());
    expectMeans(mesh, means);
    expectContinuity(mesh, b, means, random);
}

} // namespace

} // namespace helio
