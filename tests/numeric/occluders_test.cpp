// SPDX-License-Identifier: Apache-2.0
#include "city/light/occluders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "city/base/hash.h"
#include "city/light/filled_nodes.h"
#include "city/light/sky.h"
#include "tests/numeric/fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);
constexpr double kPi = std::numbers::pi;

/// A patch and the planar nodes above it, the root last.
std::vector<u32> upwards(const NodeTree& tree, u32 patch)
{
    std::vector<u32> path{patch};
    while (!tree.isPlanarRoot(path.back())) path.push_back(tree.nodes[path.back()].parent);
    return path;
}

/// Outline and kind as a patch has them that was an L before it was cut into the patches of a group.
void makeL(NodeTree& tree, u32 root, const Ring3& outline)
{
    Node& node = tree.nodes[root];
    ASSERT_EQ(node.kind, NodeKind::PlanarPartial) << "the hull of an L is larger";
    tree.rings[node.ringBegin] = outline;
    node.kind = NodeKind::Tiling;
    node.coverage = 1.0;
}

/// Turned boxes of several heights on a ground; screens between them of one patch each: an L, a tenfold polygon, one
/// with an edge that floats cannot tell, two that share a plane but for a quarter of a degree; and last an L cut in
/// three.
NodeTree town(const glm::dvec3& offset)
{
    std::vector<Face> faces = grid({-30, -30, 0}, 60.0 * kX, 60.0 * kY, 4, 4, {{}, 0});
    u32 group = 1;
    for (u32 box = 0; box < 9; ++box) {
        const double turn = 0.3 * box, height = 6.0 + 3.0 * (box % 4);
        const glm::dvec3 u = 8.0 * (std::cos(turn) * kX + std::sin(turn) * kY),
                         v = 5.0 * (std::cos(turn) * kY - std::sin(turn) * kX),
                         o = glm::dvec3(18.0 * (box % 3) - 20.0, 18.0 * (box / 3) - 20.0, 0.0), h = height * kZ;
        append(faces, grid(o, u, h, 3, 2, {{}, group++}));
        append(faces, grid(o + u, v, h, 2, 4, {{}, group++}));
        append(faces, grid(o + u + v, -u, h, 1, 1, {{}, group++}));
        append(faces, grid(o + v, -v, h, 2, 2, {{}, group++}));
        append(faces, grid(o + h, u, v, 2, 1, {{}, group++}));
    }
    const auto screenAt = [&](const glm::dvec3& at, const std::vector<glm::dvec2>& outline) {
        Face face{{}, group++};
        for (const glm::dvec2& x : outline) face.ring.push_back(at + x.x * kX + x.y * kZ);
        faces.push_back(face);
    };
    screenAt({-10, -3, 1}, {{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 5}, {0, 5}});
    std::vector<glm::dvec2> ten;
    for (u32 k = 0; k < 10; ++k) ten.push_back(3.0 * glm::dvec2(std::cos(0.2 * k * kPi), std::sin(0.2 * k * kPi)));
    screenAt({8, -3, 4}, ten);
    screenAt({-10, 12, 1}, {{0, 0}, {4, 0}, {4, 3}, {4 - 1e-7, 3}, {0, 3}});
    append(faces, grid({6, 12, 0.5}, 5.0 * kX, 4.0 * kZ, 1, 1, {{}, group}));
    append(faces,
           grid({11, 12, 0.5}, 5.0 * (std::cos(0.0044) * kX + std::sin(0.0044) * kY), 4.0 * kZ, 1, 1, {{}, group++}));
    const glm::dvec3 o(-8, -12, 0);
    for (u32 k = 0; k < 4; ++k) // posts before the L
        append(faces, grid(o + (0.5 + 2.0 * k) * kX - kY, kX, 6.0 * kZ, 1, 1, {{}, group++}));
    const u32 screen = u32(faces.size());
    for (const glm::dvec2& at : {glm::dvec2(0, 0), glm::dvec2(4, 0), glm::dvec2(0, 3)})
        append(faces, grid(o + at.x * kX + at.y * kZ, 4.0 * kX, 3.0 * kZ, 1, 1, {{}, group}));
    NodeTree tree = makeTree(moved(faces, offset));
    const auto corner = [&](double x, double z) { return offset + o + x * kX + z * kZ; };
    makeL(tree, upwards(tree, screen).back(),
          {corner(0, 0), corner(8, 0), corner(8, 3), corner(4, 3), corner(4, 6), corner(0, 6)});
    return tree;
}

/// Whether the segment fares otherwise when an end moves by some millimetres on its surface.
bool grazes(const Visibility& visibility, const glm::dvec3& from, const glm::dvec3& na, const glm::dvec3& to,
            const glm::dvec3& nb)
{
    const PlaneFrame a = planeFrame(na), b = planeFrame(nb);
    const bool blocked = visibility.isBlocked(from, na, to, nb);
    for (const double step : {-3e-3, 3e-3})
        for (const auto& [atFrom, atTo] : {std::pair(a.u, glm::dvec3(0.0)), std::pair(a.v, glm::dvec3(0.0)),
                                           std::pair(glm::dvec3(0.0), b.u), std::pair(glm::dvec3(0.0), b.v)})
            if (visibility.isBlocked(from + step * atFrom, na, to + step * atTo, nb) != blocked) return true;
    return false;
}

u32 pick(Random& random, u32 count)
{
    return std::min(u32(random.uniform() * count), count - 1);
}

} // namespace

TEST(FilledNodes, AreConvexFlatWholeAndOfOneKind)
{
    std::vector<Face> faces = grid({0, 0, 0}, 4.0 * kX, 4.0 * kY, 2, 2, {{}, 0}); // a whole square
    append(faces, grid({9, 0, 0}, 2.0 * kX, 2.0 * kY, 1, 1, {{}, 1}));            // two with a gap
    append(faces, grid({13, 0, 0}, 2.0 * kX, 2.0 * kY, 1, 1, {{}, 1}));
    append(faces, grid({0, 9, 0}, 4.0 * kX, 2.0 * kY, 2, 1, {{}, 2})); // two, one of them covered
    append(faces, {Face{{{0, 20, 0}, {3, 20, 0}, {3, 21, 0}, {1, 21, 0}, {1, 23, 0}, {0, 23, 0}}, 3}}); // an L
    append(faces, grid({20, 0, 1}, 4.0 * kX, 2.0 * kY, 2, 1, {{}, 4})); // two, one of them to be raised
    NodeTree tree = makeTree(faces);
    tree.patches[7].covered = tree.nodes[7].covered = true;
    for (glm::dvec3& p : tree.rings[tree.nodes[10].ringBegin]) p.z += 0.01;
    const auto root = [&](u32 patch) { return upwards(tree, patch).back(); };
    const std::vector<u8> filled = filledNodes(tree, 1e-3), loose = filledNodes(tree, 0.02);
    EXPECT_EQ(filled[root(0)], 1);
    EXPECT_EQ(filled[root(4)], 0);
    EXPECT_EQ(filled[root(6)], 0);
    EXPECT_EQ(filled[root(8)], 0);
    EXPECT_EQ(filled[root(9)], 0);
    EXPECT_EQ(loose[root(9)], 1);
    for (const u32 patch : {0u, 4u, 6u, 7u, 9u}) EXPECT_EQ(filled[patch], 1) << patch;
}

TEST(FilledNodes, HaveAtMostEightCornersThatAreNotStraight)
{
    const auto polygon = [](u32 corners, u32 between) {
        Face face;
        const auto at = [&](u32 k) {
            return glm::dvec3(std::cos(2 * kPi * k / corners), std::sin(2 * kPi * k / corners), 0.0);
        };
        for (u32 k = 0; k < corners; ++k)
            for (u32 j = 0; j < between; ++j) face.ring.push_back(glm::mix(at(k), at(k + 1), double(j) / between));
        return face;
    };
    EXPECT_EQ(filledNodes(makeTree({polygon(8, 1)}), 1e-3)[0], 1);
    EXPECT_EQ(filledNodes(makeTree({polygon(9, 1)}), 1e-3)[0], 0);
    EXPECT_EQ(filledNodes(makeTree({polygon(4, 5)}), 1e-3)[0], 1);
    EXPECT_EQ(withoutStraightCorners(polygon(4, 5).ring).size(), 4u);
    EXPECT_EQ(withoutStraightCorners({{0, 0, 0}, {1, 0, 0}, {1, 1e-8, 0}, {1, 1, 0}, {0, 1, 0}}).size(), 4u);
}

class OccluderLists : public testing::TestWithParam<glm::dvec3>
{
};

TEST_P(OccluderLists, LeaveOutNothingThatBlocks)
{
    const NodeTree tree = town(GetParam());
    const Visibility visibility(tree);
    const Occluders occluders(tree, visibility);
    Random random(5);
    constexpr size_t kSegments = 8;
    constexpr u32 kScreens = 12;
    u32 clear = 0, blockedSegments = 0, differing = 0, hierarchies = 0;
    while (hierarchies < 12000) {
        // Every other pair begins at a screen or a post; they are the last.
        const u32 patchA = hierarchies % 2 == 0 ? tree.patchCount() - 1 - pick(random, kScreens)
                                                : pick(random, tree.patchCount()),
                  patchB = pick(random, tree.patchCount());
        const std::vector<u32> a = upwards(tree, patchA), b = upwards(tree, patchB);
        if (a.back() == b.back()) continue;
        const glm::dvec3 &na = tree.nodes[patchA].normal, &nb = tree.nodes[patchB].normal;
        std::vector<glm::dvec3> from, to;
        for (size_t k = 0; k < kSegments; ++k) {
            const glm::dvec3 p = visibility.pointOnPatch(patchA, random.uniform(), random.uniform()),
                             q = visibility.pointOnPatch(patchB, random.uniform(), random.uniform());
            if (glm::dot(na, q - p) <= 1e-3 || glm::dot(nb, p - q) <= 1e-3) continue;
            from.push_back(p);
            to.push_back(q);
        }
        if (from.empty()) continue;
        ++hierarchies;
        const auto expected = std::make_unique<bool[]>(kSegments), told = std::make_unique<bool[]>(kSegments);
        visibility.areBlocked(from, na, to, nb, std::span(expected.get(), from.size()));
        // From the roots down, one side or the other, as links are refined.
        size_t atA = a.size() - 1, atB = b.size() - 1, begin = 0;
        std::vector<u32> found;
        ASSERT_TRUE(occluders.find(a[atA], b[atB], 10000, found));
        for (;;) {
            const std::span<const u32> between = std::span(found).subspan(begin);
            occluders.block(between, from, to, std::span(told.get(), from.size()));
            for (size_t k = 0; k < from.size(); ++k) {
                if (told[k] != expected[k] && !grazes(visibility, from[k], na, to[k], nb)) ++differing;
                blockedSegments += expected[k] ? 1 : 0;
            }
            if (between.empty()) ++clear;
            if (atA + atB == 0) break;
            (atB == 0 || (atA > 0 && random.uniform() < 0.5) ? atA : atB) -= 1;
            const size_t end = found.size();
            occluders.narrow(a[atA], b[atB], begin, end, found);
            begin = end;
        }
    }
    std::printf("%u lists empty, %u blocked segments, %u told otherwise\n", clear, blockedSegments, differing);
    EXPECT_EQ(differing, 0u);
    EXPECT_GT(clear, 2000u);
    EXPECT_GT(blockedSegments, 2000u);
}

INSTANTIATE_TEST_SUITE_P(Places, OccluderLists, testing::Values(glm::dvec3(0.0), glm::dvec3(5e5, 4.5e6, 300.0)));

TEST(Occluders, SaysWhenThereAreMoreThanAskedFor)
{
    std::vector<Face> faces = grid({0, 0, 0}, 4.0 * kX, 4.0 * kY, 1, 1, {{}, 0});
    append(faces, grid({0, 0, 9}, 4.0 * kY, 4.0 * kX, 1, 1, {{}, 1}));
    for (u32 k = 0; k < 5; ++k) append(faces, grid({1, 1, 2.0 + k}, kX, kY, 1, 1, {{}, 2 + k}));
    append(faces, grid({6, 6, 4}, kX, kY, 1, 1, {{}, 7}));
    const NodeTree tree = makeTree(faces);
    const Occluders occluders(tree, Visibility(tree));
    std::vector<u32> found{77};
    EXPECT_TRUE(occluders.find(0, 1, 5, found));
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, (std::vector<u32>{2, 3, 4, 5, 6, 77}));
    found.clear();
    EXPECT_FALSE(occluders.find(0, 1, 4, found));
    EXPECT_EQ(found.size(), 4u);
}
