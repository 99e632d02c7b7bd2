// SPDX-License-Identifier: Apache-2.0
// Patches as polygons: rings with holes become one ring, paths in the hierarchy become columns.
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "city/model/triangulate.h"
#include "city/pack/export.h"
#include "city/pack/single_ring.h"
#include "city/pack/writer.h"
#include "tests/unit/pack_sample.h"
#include "tests/unit/pack_temp_folder.h"

namespace helio {
namespace {

const glm::dvec3 kUp(0, 0, 1);

Ring3 square(double x, double y, double side)
{
    return {{x, y, 0}, {x + side, y, 0}, {x + side, y + side, 0}, {x, y + side, 0}};
}

Ring3 hole(double x, double y, double side)
{
    Ring3 ring = square(x, y, side);
    return {ring[0], ring[3], ring[2], ring[1]};
}

double triangulatedArea(const Ring3& ring)
{
    double sum = 0.0;
    for (const auto& t : triangulate(Polygon3{ring, {}}))
        sum += 0.5 * glm::length(glm::cross(ring[t[1]] - ring[t[0]], ring[t[2]] - ring[t[0]]));
    return sum;
}

TEST(JoinRings, ASingleRingStaysAsItIs)
{
    const std::vector<Ring3> rings = {square(0, 0, 3)};
    EXPECT_EQ(joinRings(rings, kUp), rings[0]);
}

TEST(JoinRings, HolesAreCutIn)
{
    // Three holes in a row, two of them hidden from the right border behind the third.
    const std::vector<Ring3> rings = {square(0, 0, 10), hole(1, 4, 2), hole(4, 4, 2), hole(7, 4, 2)};
    const Ring3 joined = joinRings(rings, kUp);
    EXPECT_EQ(joined.size(), 4u + 3u * (4u + 2u));
    EXPECT_NEAR(vectorArea(joined).z, 100.0 - 12.0, 1e-12);
    EXPECT_NEAR(triangulatedArea(joined), 88.0, 1e-9) << "a cut that crossed an edge would not triangulate";
}

TEST(JoinRings, CutsStayInside)
{
    // A U with a slit of 0.2 m. The nearest corner to the hole in the left arm is the one at (5.2, 6), across the slit.
    const Ring3 u = {{0, 0, 0},   {10, 0, 0}, {10, 10, 0}, {5.2, 10, 0}, {5.2, 6, 0},
                     {5.2, 1, 0}, {5, 1, 0},  {5, 10, 0},  {0, 10, 0}};
    const Ring3 joined = joinRings(std::vector<Ring3>{u, hole(3.5, 5.5, 1)}, kUp);
    for (size_t i = 0; i < joined.size(); ++i) {
        const glm::dvec3 a = joined[i], b = joined[(i + 1) % joined.size()];
        const bool crossesSlit = std::min(a.x, b.x) < 5.0 && std::max(a.x, b.x) > 5.2 && std::max(a.y, b.y) > 1.0;
        EXPECT_FALSE(crossesSlit) << "edge " << i << " leaves the polygon";
    }
    EXPECT_NEAR(triangulatedArea(joined), 100.0 - 0.2 * 9.0 - 1.0, 1e-9);
}

TEST(JoinRings, SeparatePartsAreJoined)
{
    const std::vector<Ring3> rings = {square(0, 0, 1), square(5, 0, 2), hole(5.5, 0.5, 1)};
    EXPECT_NEAR(vectorArea(joinRings(rings, kUp)).z, 1.0 + 4.0 - 1.0, 1e-12);
}

TEST(JoinRings, KeepsThePlane)
{
    // The same square with a hole, standing: x, z and facing -y.
    const auto stand = [](Ring3 ring) {
        for (glm::dvec3& q : ring) q = {q.x, 7.0, q.y};
        return ring;
    };
    const glm::dvec3 south(0, -1, 0);
    const Ring3 joined = joinRings(std::vector<Ring3>{stand(square(0, 0, 4)), stand(hole(1, 1, 1))}, south);
    EXPECT_NEAR(glm::dot(vectorArea(joined), south), 15.0, 1e-12);
}

class ExportedSample : public testing::Test
{
protected:
    void SetUp() override
    {
        PackContent content = test::samplePack();
        content.outlineRests.assign(content.outlineRests.size(), glm::vec3(0));
        content.outlineRests[0].x = 1e-9f;
        content.surfaceNames = "a,\"b\"\nstreet\n";
        ASSERT_TRUE(writePack(content, temp_ / "p").ok());
        Result<Pack> pack = Pack::open(temp_ / "p");
        ASSERT_TRUE(pack.ok());
        text_ = exportSurfaces(*pack);
    }
    test::TempFolder temp_;
    SurfaceText text_;
};

TEST_F(ExportedSample, RowsNameThePathOfEachPatch)
{
    // Patches 0 and 1 are the two children of planar root 0 of building 0; the ground patch is a planar root itself.
    EXPECT_EQ(text_.csv, "kind,building,facade,floor,bay,rho_r,rho_g,rho_b,rho_solar,emit_r,emit_g,emit_b,emit_solar\n"
                         "a__b_,0,0,0,0,0.5,0.4,0.3,0.45,0,0,0,0\n"
                         "surface,0,0,1,0,0.5,0.4,0.3,0.45,0,1,2,0\n"
                         "street,-1,0,0,0,0.5,0.4,0.3,0.45,0,0,0,0\n");
}

TEST_F(ExportedSample, FacesAreTheOutlines)
{
    EXPECT_EQ(text_.obj.find("v 9.999999717180685e-10 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf -4 -3 -2 -1\n"),
              text_.obj.find('\n') + 1)
        << "the first corner keeps the nanometre of its rest\n"
        << text_.obj;
    EXPECT_NE(text_.obj.find("f -10 -9 -8 -7 -6 -5 -4 -3 -2 -1\n"), std::string::npos)
        << "four corners, a hole of four, a cut";
    size_t faces = 0;
    for (size_t at = text_.obj.find("\nf "); at != std::string::npos; at = text_.obj.find("\nf ", at + 1)) ++faces;
    EXPECT_EQ(faces, 3u);
}

} // namespace
} // namespace helio
