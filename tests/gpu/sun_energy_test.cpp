// SPDX-License-Identifier: Apache-2.0
// Counts to E_sun against the twin; and the whole of stages 1 and 2 against closed forms.
#include "engine/stages/sun_energy.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "city/base/hash.h"
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "engine/view/renderer.h"
#include "shaders/shared/sun.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage_twins.h"
#include "tests/support/tile_builder.h"

namespace helio {

namespace {

const glm::vec4 kGrey(0.5f);

class SunEnergyTest : public GpuTest
{
protected:
    std::unique_ptr<Renderer> makeRenderer(const TileView& view, double texel = 0.01)
    {
        RendererOptions options;
        options.sun.texel = texel;
        auto renderer = Renderer::create(context(), view, 0.0, options);
        EXPECT_TRUE(renderer.ok()) << renderer.error().message;
        return std::move(*renderer);
    }
};

TEST_F(SunEnergyTest, AgreesWithTheTwin)
{
    TileBuilder b;
    Random random(1);
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.3, -0.5, 0.7));
    std::vector<u32> counts;
    constexpr u32 kPatches = 500;
    constexpr double kTexelArea = 0.01;
    for (u32 i = 0; i < kPatches; ++i) {
        const auto part = [&] { return float(2.0 * random.uniform() - 1.0); };
        const float x = part(), y = part();
        b.patch(glm::normalize(glm::vec3(x, y, part() + 0.5f)), float(0.02 + random.uniform()), kGrey);
        const double alone =
            b.patches[i].area * std::max(0.0, glm::dot(glm::dvec3(b.patches[i].normal), sun)) / kTexelArea;
        counts.push_back(u32(alone * 1.2 * random.uniform()));
    }
    std::vector<u32> tops;
    for (u32 i = 0; i < kPatches; i += 10) {
        std::vector<u32> ten;
        for (u32 k = 0; k < 10; ++k) ten.push_back(i + k);
        tops.push_back(b.group(ten));
    }
    b.group(tops);
    const TileView view = b.view();
    auto tile = uploadTile(context(), view);
    ASSERT_TRUE(tile.ok());
    const Buffer countBuffer = makeBuffer(context(), "counts", counts);
    const Buffer density = makeBuffer(context(), "density", std::vector<glm::vec4>(tile->nodeCount));
    const Buffer irradiance = makeBuffer(context(), "E_sun", std::vector<glm::vec4>(kPatches));
    const Buffer tally = makeBuffer(context(), "tally", std::vector<gpu::SunTallyRecord>(1));
    FrameGraph graph("sun energy");
    (void)addSunEnergy(graph, *tile, graph.import(countBuffer), graph.import(density),
                       {graph.import(irradiance), graph.import(tally)},
                       {glm::vec3(sun), glm::vec4(800.0f), kTexelArea});
    ASSERT_TRUE(graph.compile(context()).ok());
    Recorder recorder(context());
    recorder.begin();
    graph.execute(recorder);
    recorder.submitAndWait();

    const twin::SunEnergy expected =
        twin::sunEnergy(view, counts, sun, 800.0, kTexelArea, kMinSunSamples, kMinSunCosine);
    const auto result = downloadItems<glm::vec4>(context(), irradiance);
    for (u32 i = 0; i < kPatches; ++i) EXPECT_NEAR(result[i].w, expected.irradiance[i].w, 1e-3) << i;
    const auto seen = downloadItems<gpu::SunTallyRecord>(context(), tally)[0];
    EXPECT_EQ(seen.lit, expected.lit);
    EXPECT_EQ(seen.flagged, expected.flagged);
    EXPECT_EQ(seen.excess, expected.excess);
    EXPECT_GT(expected.flagged, 10u) << "the test must see both ways";
    EXPECT_GT(expected.excess, 10u);
}

TEST_F(SunEnergyTest, ABoxOnTheGroundShadesWhatItMust)
{
    // Ground of 20 x 20 m as 400 patches, a box of 4 x 4 x 3 m in the middle; sun from the west at 45 degrees: the
    // shadow is the strip x in [2, 5], y in [-2, 2].
    TileBuilder b;
    for (int y = -10; y < 10; ++y)
        for (int x = -10; x < 10; ++x) {
            const auto p = [&](int i, int j) { return glm::vec3(float(x + i), float(y + j), 0.0f); };
            b.quad({p(0, 0), p(1, 0), p(1, 1), p(0, 1)}, kGrey);
        }
    const u32 box = b.box({-2, -2, 0}, {2, 2, 3}, kGrey);
    auto renderer = makeRenderer(b.view());
    renderer->setSun(270.0, 45.0, 1000.0);
    renderer->setSky(0.0);
    renderer->solve();
    const LightTables light = renderer->readTables();
    const double lit = 1000.0 * std::sqrt(0.5);
    for (int y = -10; y < 10; ++y)
        for (int x = -10; x < 10; ++x) {
            const bool under = x >= -2 && x < 2 && y >= -2 && y < 2;
            const bool dark = under || (x >= 2 && x < 5 && y >= -2 && y < 2);
            // A texel of 1 cm off along two edges of a square metre is 2 %.
            EXPECT_NEAR(light.sun[size_t((y + 10) * 20 + x + 10)].w, dark ? 0.0 : lit, 0.02 * lit) << x << ", " << y;
        }
    EXPECT_NEAR(light.sun[box].w, lit, 0.01 * lit);     // west side
    EXPECT_EQ(light.sun[box + 1].w, 0.0f);              // east side: the sun is behind it
    EXPECT_NEAR(light.sun[box + 5].w, lit, 0.01 * lit); // roof
}

TEST_F(SunEnergyTest, AzimuthRunsClockwiseFromNorth)
{
    TileBuilder b;
    const u32 box = b.box({-1, -1, 0}, {1, 1, 2}, kGrey); // -x, +x, -y, +y, -z, +z
    auto renderer = makeRenderer(b.view());
    const auto sunOn = [&](double azimuth) {
        renderer->setSun(azimuth, 1.0, 1000.0);
        renderer->solve();
        return renderer->readTables().sun;
    };
    const double full = 1000.0 * std::cos(glm::radians(1.0));
    EXPECT_NEAR(sunOn(0.0)[box + 3].w, full, 0.01 * full);
    EXPECT_NEAR(sunOn(90.0)[box + 1].w, full, 0.01 * full);
    EXPECT_NEAR(sunOn(180.0)[box + 2].w, full, 0.01 * full);
    EXPECT_NEAR(sunOn(270.0)[box].w, full, 0.01 * full);
}

TEST_F(SunEnergyTest, AnAssetCarriesItsPatch)
{
    TileBuilder b;
    const u32 wall = b.patch({0, 0, 1}, 1.0f, kGrey);
    b.quad({{{5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0}}}, kGrey);
    // A unit square, scaled to half a metre and moved.
    b.asset(wall, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
            {{glm::vec4(0.5f, 0, 0, 2), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0.5f)}});
    auto renderer = makeRenderer(b.view());
    renderer->setSun(0.0, 90.0, 1000.0);
    renderer->solve();
    // Half of the patch's area is there to be seen.
    EXPECT_NEAR(renderer->readTables().sun[wall].w, 500.0, 10.0);
}

TEST_F(SunEnergyTest, SmallPatchesTakeTheRatioAround)
{
    // A wall of one square metre in strips of 1 mm, half of it in the shadow of a plate: no strip has 16 texels of 2
    // cm.
    TileBuilder b;
    std::vector<u32> strips;
    for (int i = 0; i < 1000; ++i) {
        const float x = float(i) / 1000.0f;
        strips.push_back(b.quad({{{x, 0, 0}, {x + 0.001f, 0, 0}, {x + 0.001f, 0.2f, 0}, {x, 0.2f, 0}}}, kGrey));
    }
    b.quad({{{-1, -1, 1}, {0.5f, -1, 1}, {0.5f, 1, 1}, {-1, 1, 1}}}, kGrey);
    b.group(strips);
    auto renderer = makeRenderer(b.view(), 0.02);
    renderer->setSun(0.0, 90.0, 1000.0);
    const SolveReport report = renderer->solve();
    EXPECT_EQ(report.flaggedPatches, 1000u);
    const LightTables light = renderer->readTables();
    for (const u32 strip : strips) EXPECT_NEAR(light.sun[strip].w, 500.0, 40.0);
}

TEST_F(SunEnergyTest, AWallOnEdgeToTheSunGetsHalfOfItsDisc)
{
    // Ground in full sun and walls of 3 m by it that face the sun by -0.2, 0 and 0.1 degrees; the disc's radius is
    // 0.267.
    TileBuilder b;
    const u32 ground = b.quad({{{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}}}, kGrey);
    std::vector<u32> all{ground};
    const double turns[] = {-0.2, 0.0, 0.1};
    for (int i = 0; i < 3; ++i) {
        // The sun stands in the south. Facing east, turned towards it.
        const double turn = glm::radians(turns[i] / std::cos(glm::radians(30.0)));
        const glm::vec3 foot(30.0f + 5.0f * float(i), 0, 0), along(3.0 * std::sin(turn), 3.0 * std::cos(turn), 0);
        const glm::vec3 up(0, 0, 3);
        all.push_back(b.quad({foot, foot + along, foot + along + up, foot + up}, kGrey));
    }
    b.group(all);
    auto renderer = makeRenderer(b.view(), 0.05);
    renderer->setSun(180.0, 30.0, 1000.0);
    renderer->solve();
    const std::vector<glm::vec4> sun = renderer->readTables().sun;
    const double radius = glm::radians(0.26667), full = sun[ground].w / 500.0;
    EXPECT_NEAR(full, 1.0, 0.01);
    for (int i = 0; i < 3; ++i) {
        // Mean over the disc of the height above the wall's plane.
        double height = 0.0, count = 0.0;
        for (double x = -0.995; x < 1.0; x += 0.01)
            for (double y = -0.995; y < 1.0; y += 0.01) {
                if (x * x + y * y > 1.0) continue;
                count += 1.0;
                height += std::max(0.0, y * radius + glm::radians(turns[i]));
            }
        EXPECT_NEAR(sun[all[size_t(i) + 1]].w, 1000.0 * height / count, 0.03 * 1000.0 * height / count) << turns[i];
    }
    EXPECT_NEAR(sun[all[2]].w, 1000.0 * 2.0 / 3.0 / 3.14159265 * radius, 0.02) << "on edge: 0.99 W/m2";
}

TEST_F(SunEnergyTest, ShiftedSamplesAddUpToAFinerPicture)
{
    // Small patches under a comb of plates: with texels of 10 cm one raster errs by what falls between them.
    TileBuilder b;
    std::vector<u32> patches;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) {
            const auto p = [&](float i, float j) {
                return glm::vec3(0.5f * (float(x) + i), 0.5f * (float(y) + j), 0.0f);
            };
            patches.push_back(b.quad({{p(0, 0), p(1, 0), p(1, 1), p(0, 1)}}, kGrey));
        }
    for (int k = 0; k < 8; ++k) {
        const float x = 0.77f * float(k) + 0.13f;
        b.quad({{{x, -1, 2}, {x + 0.31f, -1, 2}, {x + 0.31f, 8, 2}, {x, 8, 2}}}, kGrey);
    }
    b.group(patches);
    const auto errorOf = [&](Renderer& coarse, const std::vector<glm::vec4>& exact) {
        const std::vector<glm::vec4> seen = coarse.readTables().sun;
        double square = 0.0;
        for (const u32 i : patches) square += std::pow(double(seen[i].w - exact[i].w), 2.0);
        return std::sqrt(square / double(patches.size()));
    };
    const auto fine = makeRenderer(b.view(), 0.004), coarse = makeRenderer(b.view(), 0.1);
    for (Renderer* renderer : {fine.get(), coarse.get()}) {
        renderer->setSun(200.0, 60.0, 1000.0);
        renderer->solve();
    }
    const std::vector<glm::vec4> exact = fine->readTables().sun;
    const double one = errorOf(*coarse, exact);
    for (int k = 1; k < 16; ++k) coarse->refineSun();
    EXPECT_EQ(coarse->refineSun().sunSamples, 17u);
    // 17 samples of random places would leave a quarter; those of the sequence leave less.
    EXPECT_LT(errorOf(*coarse, exact), 0.2 * one);
    EXPECT_GT(one, 10.0) << "W/m2: the test must see something";
    coarse->setSun(201.0, 60.0, 1000.0);
    EXPECT_EQ(coarse->solve().sunSamples, 1u) << "another sun starts anew";
}

TEST_F(SunEnergyTest, TheHorizonCutsTheDisc)
{
    TileBuilder b;
    const u32 box = b.box({-1, -1, 0}, {1, 1, 2}, kGrey);
    auto renderer = makeRenderer(b.view());
    renderer->setSun(90.0, 0.0, 1000.0);
    renderer->solve();
    EXPECT_NEAR(renderer->readTables().sun[box + 1].w, 500.0, 10.0) << "half of it stands above";
    renderer->setSun(90.0, -0.27, 1000.0);
    renderer->solve();
    EXPECT_EQ(renderer->readTables().sun[box + 1].w, 0.0f);
}

TEST_F(SunEnergyTest, NoSunBelowTheHorizon)
{
    TileBuilder b;
    b.box({0, 0, 0}, {1, 1, 1}, kGrey);
    auto renderer = makeRenderer(b.view());
    renderer->setSun(90.0, -5.0, 1000.0);
    renderer->solve();
    for (const glm::vec4& e : renderer->readTables().sun) EXPECT_EQ(e, glm::vec4(0.0f));
}

} // namespace

} // namespace helio
