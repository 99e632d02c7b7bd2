// SPDX-License-Identifier: Apache-2.0
// reference, compare and export of the built heliopolis-bake, run as a user runs them.
#include <gtest/gtest.h>

#include <cstring>

#include "city/base/file.h"
#include "city/pack/writer.h"
#include "tests/unit/cli_runner.h"
#include "tests/unit/pack_sample.h"

namespace helio {
namespace {

using test::RunResult;
using test::TempFolder;

class ReferenceCli : public testing::Test
{
protected:
    void SetUp() override { ASSERT_TRUE(writePack(test::samplePack(), temp_ / "p").ok()); }

    RunResult bake(const std::string& arguments) const { return test::runProgram(HELIO_BAKE, arguments, temp_.path()); }

    std::string text(const std::string& name) const
    {
        const Result<std::string> read = readTextFile(temp_ / name);
        EXPECT_TRUE(read.ok()) << name;
        return read.ok() ? *read : std::string();
    }

    void expectRefusal(const std::string& arguments, const std::string& what) const
    {
        const size_t before = temp_.entryCount();
        const RunResult result = bake(arguments);
        EXPECT_EQ(result.exitCode, 1) << arguments;
        EXPECT_EQ(result.errorLines(), 1u) << arguments << ": " << result.err;
        EXPECT_NE(result.err.find(what), std::string::npos) << arguments << ": " << result.err;
        EXPECT_EQ(temp_.entryCount(), before) << arguments;
    }

    TempFolder temp_;
};

TEST_F(ReferenceCli, TheTableDoesNotDependOnTheThreads)
{
    ASSERT_EQ(bake("reference p --sun 180,30 --spp 64 --jobs 1 -o one.csv").exitCode, 0);
    ASSERT_EQ(bake("reference p --sun 180,30 --spp 64 --jobs 3 -o three.csv").exitCode, 0);
    ASSERT_EQ(bake("reference p --sun 180,30 --spp 64 --seed 2 -o other.csv").exitCode, 0);
    EXPECT_EQ(text("one.csv"), text("three.csv"));
    EXPECT_NE(text("one.csv"), text("other.csv"));
    EXPECT_NE(text("one.csv").find("\npatch,building,area,E_sun_r,E_sun_g,E_sun_b,E_sun_solar,E_sky_r"),
              std::string::npos);
}

TEST_F(ReferenceCli, RefusesBadInput)
{
    expectRefusal("reference p --sun 180 -o r.csv", "--sun 180: expected AZIMUTH,ELEVATION");
    expectRefusal("reference p --sun 180,nan -o r.csv", "--sun 180,nan");
    expectRefusal("reference p --spp 1 -o r.csv", "--spp");
    expectRefusal("reference none -o r.csv", "none");
    expectRefusal("reference p -o missing/r.csv", "there is no folder missing");
    expectRefusal("export p", "--surfaces is required, or --radiance, or --mitsuba");
}

TEST_F(ReferenceCli, ComparesByHand)
{
    // Areas 1 and 3: errors of E_indirect +1 and -1 about a mean of (10 + 3 x 20) / 4 = 17.5; noise 0.5.
    std::string header = "patch,area", values, errors;
    for (const char* quantity : {"E_sun", "E_sky", "E_indirect"})
        for (const char* channel : {"r", "g", "b", "solar"}) header += std::string(",") + quantity + "_" + channel;
    std::string seHeader;
    for (const char* quantity : {"E_sun", "E_sky", "E_indirect", "E_total"})
        for (const char* channel : {"r", "g", "b", "solar"}) seHeader += std::string(",") + quantity + "_se_" + channel;
    const std::string noSun = ",0,0,0,0,0,0,0,0", se = noSun + ",.5,.5,.5,.5,.5,.5,.5,.5";
    const auto row = [&](const char* start, const char* e) {
        return std::string(start) + noSun + "," + e + "," + e + "," + e + "," + e;
    };
    ASSERT_TRUE(
        writeTextAtomically(temp_ / "t.csv", header + "\n" + row("0,1", "11") + "\n" + row("1,3", "19") + "\n"));
    ASSERT_TRUE(writeTextAtomically(temp_ / "r.csv", "# note\n" + header + seHeader + "\n" + row("0,1", "10") + se +
                                                         "\n" + row("1,3", "20") + se + "\n"));
    const RunResult result = bake("compare t.csv r.csv --json");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    // sqrt(1 - 0.25) / 17.5, -0.5 / 17.5, sqrt((0.25 + 9 x 0.25) / 16) / 17.5, 1 / 17.5, 0.5 / 17.5
    EXPECT_NE(result.out.find("\"E_indirect\", \"channels\": \"solar\", \"mean\": 17.5, \"rms\": 0.0494872, "
                              "\"bias\": -0.0285714, \"bias_se\": 0.0225877, \"p95\": 0.0571429, "
                              "\"max\": 0.0571429, \"noise\": 0.0285714"),
              std::string::npos)
        << result.out;
    expectRefusal("compare r.csv t.csv", "t.csv: no column E_sun_se_r");
    ASSERT_TRUE(writeTextAtomically(temp_ / "short.csv", header + "\n" + row("0,1", "11") + "\n"));
    expectRefusal("compare short.csv r.csv", "tables of one pack are needed");
    ASSERT_TRUE(writeTextAtomically(temp_ / "bad.csv", header + "\n" + row("0,1", "nan") + "\n"));
    expectRefusal("compare bad.csv r.csv", "bad.csv:2: column E_indirect_r: a finite number is needed");
}

TEST_F(ReferenceCli, ExportsForRadiance)
{
    ASSERT_EQ(bake("export p --radiance rad --sun 180,90 --dni 700 --points 4").exitCode, 0);
    const std::string scene = text("rad/scene.rad"), light = text("rad/light.rad"), points = text("rad/points.txt");
    // The sample's patches 0 and 2 share a material, patch 1 emits.
    EXPECT_NE(scene.find("void plastic m0_front\n0\n0\n5 0.5 "), std::string::npos) << scene;
    EXPECT_NE(scene.find("void mixfunc m0\n4 m0_front black if(Rdot,1,0) .\n"), std::string::npos);
    EXPECT_NE(scene.find("m0 polygon p0\n0\n0\n12 9.999999717180685e-10 0 0 "), std::string::npos) << scene;
    EXPECT_NE(scene.find("m0 polygon p2\n0\n0\n30 "), std::string::npos) << "four corners, a hole of four, a cut";
    EXPECT_NE(scene.find("m1 polygon p1\n"), std::string::npos);
    EXPECT_NE(scene.find("void glow m1_glow\n"), std::string::npos);
    EXPECT_NE(light.find("sky_glow source sky\n0\n0\n4 0 0 1 180\n"), std::string::npos);
    EXPECT_NE(light.find("sun_light source sun\n"), std::string::npos);
    EXPECT_EQ(std::count(points.begin(), points.end(), '\n'), 3 * 4);
    EXPECT_NE(text("rad/README.txt").find("rtrace -I+"), std::string::npos);
    ASSERT_EQ(bake("export p --radiance night --sun 0,-5").exitCode, 0);
    EXPECT_EQ(text("night/light.rad").find("sun"), text("night/light.rad").find("sun and sky"))
        << "no sun below ground";
}

TEST_F(ReferenceCli, ExportsTheGroundBeyond)
{
    PackContent content = test::samplePack();
    content.skyPatches.push_back({{0, 0, -1}, 6.2831853f, {0.25f, 0.5f, 0.75f, 0.5f}});
    ASSERT_TRUE(writePack(content, temp_ / "p").ok());
    ASSERT_EQ(bake("export p --radiance rad --mitsuba m.xml --meters 0 --sun 180,30 --dni 800 --dhi 0").exitCode, 0);
    // rho / pi x 800 sin 30: a source of Radiance's, and the lower half of Mitsuba's environment map.
    EXPECT_NE(text("rad/light.rad").find("void glow ground_glow\n0\n0\n4 31.83098861"), std::string::npos);
    EXPECT_NE(text("rad/light.rad").find("ground_glow source ground\n0\n0\n4 0 0 -1 180\n"), std::string::npos);
    const std::string map = text("m_sky.pfm");
    float first[3], last[3];
    ASSERT_GT(map.size(), 15u + 12u);
    std::memcpy(first, map.data() + 15, 12);
    std::memcpy(last, map.data() + map.size() - 12, 12);
    EXPECT_NEAR(double(first[2]), 95.49296586, 1e-5);
    EXPECT_EQ(last[2], 0.0f) << "a sky without light";
}

TEST_F(ReferenceCli, ExportsForMitsuba)
{
    ASSERT_EQ(bake("export p --mitsuba m.xml --sun 180,30 --points 2 --meters 1").exitCode, 0);
    const std::string xml = text("m.xml");
    for (const char* piece : {"<emitter type=\"directional\">", "<emitter type=\"envmap\">",
                              "<bsdf type=\"diffuse\" id=\"m0\">", "<ref id=\"m1\"/>", "<emitter type=\"area\">",
                              "<sensor type=\"irradiancemeter\" id=\"meter_0\">", "m_patch_0.ply", "m_m0.ply"})
        EXPECT_NE(xml.find(piece), std::string::npos) << piece << "\n" << xml;
    // Patch 2: a square with a square hole = 8 corners, 8 triangles of 13 bytes.
    const std::string ply = text("m_m0.ply");
    EXPECT_NE(ply.find("element vertex 8\n"), std::string::npos);
    EXPECT_NE(ply.find("element face 8\n"), std::string::npos);
    const size_t end = ply.find("end_header\n");
    ASSERT_NE(end, std::string::npos);
    EXPECT_EQ(ply.size(), end + 11 + 8 * 12 + 8 * 13);
    EXPECT_EQ(text("m_sky.pfm").substr(0, 15), "PF\n8 2048\n-1.0\n");
    const std::string points = text("m_points.txt");
    EXPECT_EQ(std::count(points.begin(), points.end(), '\n'), 3 * 2);
}

} // namespace
} // namespace helio
