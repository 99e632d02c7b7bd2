// SPDX-License-Identifier: Apache-2.0
// The four stages together.
#include "engine/view/renderer.h"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/stages/shade.h"
#include "engine/view/picture_sky.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tile_builder.h"

namespace helio {

namespace {

constexpr double kPi = std::numbers::pi;

class RendererTest : public GpuTest
{
protected:
    std::unique_ptr<Renderer> make(const TileView& view, RendererOptions options = {})
    {
        auto renderer = Renderer::create(context(), view, 0.0, options);
        EXPECT_TRUE(renderer.ok()) << renderer.error().message;
        return std::move(*renderer);
    }
};

/// A closed unit box seen from inside with equal emission: B = emission / (1 - rho).
TileBuilder makeFurnace(float rho)
{
    TileBuilder b;
    const u32 first = b.box({0, 0, 0}, {1, 1, 1}, glm::vec4(rho, 0.5f * rho, 0.25f, rho), glm::vec4(1, 2, 3, 4), true);
    for (u32 i = 0; i < 6; ++i)
        for (u32 j = 0; j < 6; ++j)
            if (i != j) b.link(first + i, first + j, 0.2f);
    return b;
}

/// Ground of one patch with a lamp patch that is not drawn, a wall that throws a shadow, and full sky.
struct Yard
{
    TileBuilder b;
    u32 ground, lamp;
    Yard()
    {
        ground = b.quad({{{-10, -10, 0}, {10, -10, 0}, {10, 10, 0}, {-10, 10, 0}}}, glm::vec4(0.2f, 0.4f, 0.6f, 0.5f));
        b.quad({{{-10, 5, 0}, {-10, 5, 4}, {10, 5, 4}, {10, 5, 0}}}, glm::vec4(0.0f));
        lamp = b.patch({0, 0, -1}, 1.0f, glm::vec4(0.0f), glm::vec4(50, 100, 200, 400));
        b.link(ground, lamp, 0.25f);
        b.sky(ground, 0.75f);
    }
};

TEST_F(RendererTest, FurnaceReachesItsClosedForm)
{
    TileBuilder b = makeFurnace(0.8f);
    RendererOptions options;
    options.solve.residual = 1e-6;
    auto renderer = make(b.view(), options);
    renderer->setSky(0.0);
    renderer->setSun(0.0, -90.0, 0.0);
    const SolveReport report = renderer->solve();
    EXPECT_LE(report.residual, 1e-6);
    const LightTables light = renderer->readTables();
    for (const glm::vec4& radiosity : light.radiosity) {
        EXPECT_NEAR(radiosity.r, 1.0 / (1.0 - 0.8), 5e-5);
        EXPECT_NEAR(radiosity.g, 2.0 / (1.0 - 0.4), 5e-5);
        EXPECT_NEAR(radiosity.b, 3.0 / (1.0 - 0.25), 5e-5);
        EXPECT_NEAR(radiosity.a, 4.0 / (1.0 - 0.8), 2e-4);
    }
    // Equal everywhere, so irradiance is radiosity.
    for (const glm::vec4& e : light.indirect) EXPECT_NEAR(e.r, 5.0, 5e-5);
    EXPECT_NEAR(report.meanRadiosity.r, 5.0, 5e-5);
}

TEST_F(RendererTest, ToleranceHoldsForTheLightNotForTheLastStepAlone)
{
    // Nine tenths come back each time: a step of 1e-3 still has nine like it to come.
    TileBuilder b = makeFurnace(0.9f);
    auto renderer = make(b.view());
    renderer->setSky(0.0);
    renderer->setSun(0.0, -90.0, 0.0);
    renderer->solve();
    for (const glm::vec4& radiosity : renderer->readTables().radiosity) EXPECT_NEAR(radiosity.r, 10.0, 0.01);
}

TEST_F(RendererTest, WhiteFurnaceConvergesInFewSweeps)
{
    // Plain sweeps would need ln(5e-4) / ln(0.99) = 756 for what is asked.
    TileBuilder b = makeFurnace(0.99f);
    auto renderer = make(b.view());
    EXPECT_EQ(renderer->note(), "");
    renderer->setSky(0.0);
    renderer->setSun(0.0, -90.0, 0.0);
    const SolveReport report = renderer->solve();
    EXPECT_TRUE(report.accelerated);
    EXPECT_LT(report.sweeps, 75u);
    EXPECT_NEAR(report.contraction.r, 0.99, 1e-6);
    const LightTables light = renderer->readTables();
    for (size_t i = 0; i < light.radiosity.size(); ++i) {
        const double exact = 1.0 / (1.0 - double(0.99f));
        EXPECT_NEAR(light.radiosity[i].r, exact, 1e-3 * exact);
        EXPECT_LE(std::abs(light.radiosity[i].r - exact), report.bound.r + 1e-4);
        EXPECT_NEAR(light.radiosity[i].g, 2.0 / (1.0 - 0.5 * double(0.99f)), 4e-3); // a channel without acceleration
        // What is shown fits together: B = emission + rho E, in every channel.
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(light.radiosity[i][c],
                        double(b.patches[i].emission[c]) + double(b.patches[i].rho[c]) * double(light.indirect[i][c]),
                        1e-6 * light.radiosity[i][c]);
    }
}

TEST_F(RendererTest, WarmStartOfAWhiteFurnace)
{
    TileBuilder b = makeFurnace(0.95f);
    RendererOptions options;
    options.solve.warmStart = true;
    auto renderer = make(b.view(), options);
    renderer->setSky(0.0);
    renderer->setSun(0.0, -90.0, 0.0);
    const u32 cold = renderer->solve().sweeps;
    renderer->setSky(1.0); // no patch sees it
    EXPECT_LT(renderer->solve().sweeps, cold / 4);
    for (const glm::vec4& radiosity : renderer->readTables().radiosity) EXPECT_NEAR(radiosity.r, 20.0, 0.02);
    renderer->setSky(0.0);
    renderer->setEmission(false);
    EXPECT_EQ(renderer->solve().sweeps, 1u);
    for (const glm::vec4& radiosity : renderer->readTables().radiosity) EXPECT_EQ(radiosity, glm::vec4(0.0f));
}

TEST_F(RendererTest, BoundHoldsAndIsSharpInAFurnace)
{
    // Uniform light: after n sweeps B is off by e rho^(n+1) / (1 - rho), the radiosity before by 1 / rho times that.
    TileBuilder b = makeFurnace(0.8f);
    RendererOptions options;
    options.solve.exactSweeps = 3;
    auto renderer = make(b.view(), options);
    renderer->setSky(0.0);
    renderer->setSun(0.0, -90.0, 0.0);
    const SolveReport report = renderer->solve();
    EXPECT_FALSE(report.accelerated) << "so many sweeps are so many reflections";
    const double step = std::pow(0.8, 3.0);
    EXPECT_NEAR(report.bound.r, step / 0.2, 1e-4);
    EXPECT_NEAR(report.bound.g, 2.0 * std::pow(0.4, 3.0) / 0.6, 1e-4);
    EXPECT_NEAR(5.0 - double(renderer->readTables().radiosity[0].r), 0.8 * report.bound.r, 1e-4);
}

TEST_F(RendererTest, SaysWhereLinksDoNotContract)
{
    // Links that add up to 1.25: too much for a reflectance of 0.9 in all patches, not in one alone.
    for (const bool everywhere : {true, false}) {
        TileBuilder b = makeFurnace(0.9f);
        for (u32 i = 0; i < 6; ++i)
            for (u32 j = 0; j < 6; ++j)
                if (i != j) b.link(i, j, 0.05f);
        if (!everywhere)
            for (u32 i = 1; i < 6; ++i) b.patches[i].rho = glm::vec4(0.3f);
        RendererOptions options;
        options.solve.maxSweeps = 30;
        auto renderer = make(b.view(), options);
        renderer->setSky(0.0);
        renderer->setSun(0.0, -90.0, 0.0);
        const SolveReport report = renderer->solve();
        EXPECT_NEAR(report.contraction.r, 1.125, 1e-5);
        EXPECT_TRUE(std::isinf(report.bound.r));
        EXPECT_NE(renderer->note().find(everywhere ? "may never converge" : "converge all the same"), std::string::npos)
            << renderer->note();
        EXPECT_EQ(report.residual <= 1e-3, !everywhere);
    }
}

TEST_F(RendererTest, TakesFirstLightThatIsGiven)
{
    Yard yard;
    auto renderer = make(yard.b.view());
    renderer->setSun(20.0, 50.0, 1000.0);
    const SolveReport usual = renderer->solve();
    const LightTables before = renderer->readTables();
    EXPECT_GT(usual.sunViews, 0u);
    const auto given = std::make_shared<const FirstLight>(
        FirstLight{std::vector<glm::vec4>(3, glm::vec4(1, 2, 3, 4)), std::vector<glm::vec4>(3, glm::vec4(10.0f))});
    renderer->setFirstLight(given);
    const SolveReport report = renderer->solve();
    EXPECT_EQ(report.sunViews, 0u);
    LightTables light = renderer->readTables();
    EXPECT_EQ(light.sun, given->sun);
    EXPECT_EQ(light.sky, given->sky);
    EXPECT_EQ(light.indirect[yard.ground], 0.25f * glm::vec4(50, 100, 200, 400)) << "the lamp still shines";
    EXPECT_NEAR(light.radiosity[yard.ground].g, 0.4 * (2.0 + 10.0 + 25.0), 1e-4);
    renderer->setSun(90.0, 10.0, 500.0); // does not matter now
    renderer->solve();
    EXPECT_EQ(renderer->readTables().sun, given->sun);
    renderer->setFirstLight(nullptr);
    renderer->setSun(20.0, 50.0, 1000.0);
    renderer->solve();
    EXPECT_EQ(renderer->readTables().sun, before.sun);
    EXPECT_EQ(renderer->readTables().sky, before.sky);
}

TEST_F(RendererTest, ResidualFallsByRhoASweep)
{
    TileBuilder b = makeFurnace(0.5f);
    std::vector<double> residuals;
    for (const u32 sweeps : {4u, 5u, 6u}) {
        RendererOptions options;
        options.solve.exactSweeps = sweeps;
        auto renderer = make(b.view(), options);
        renderer->setSky(0.0);
        renderer->setSun(0.0, -90.0, 0.0);
        const SolveReport report = renderer->solve();
        EXPECT_EQ(report.sweeps, sweeps);
        residuals.push_back(report.residual);
    }
    // Uniform light: after n sweeps the step is e rho^n and the sum is e (rho - rho^(n+1)) / (1 - rho).
    for (size_t k = 0; k < residuals.size(); ++k) {
        const double n = double(k) + 4.0;
        EXPECT_NEAR(residuals[k], std::pow(0.5, n) * 0.5 / (0.5 - std::pow(0.5, n + 1.0)), 1e-5);
    }
}

TEST_F(RendererTest, RunsAgainOnlyWhenTheLightChanged)
{
    Yard yard;
    auto renderer = make(yard.b.view());
    EXPECT_FALSE(renderer->solve().cached);
    EXPECT_TRUE(renderer->solve().cached);
    renderer->setSky(100.0);
    EXPECT_FALSE(renderer->solve().cached);
    for (const PassTime& stage : renderer->solve().stages) EXPECT_EQ(stage.name.find("sun raster"), std::string::npos);
    renderer->setSky(100.0);
    EXPECT_TRUE(renderer->solve().cached);
    renderer->setEmission(false);
    EXPECT_FALSE(renderer->solve().cached);
    EXPECT_EQ(renderer->readTables().indirect[yard.ground], glm::vec4(0.0f));
    renderer->solveOptions().exactSweeps = 2;
    EXPECT_FALSE(renderer->solve().cached);
}

TEST_F(RendererTest, PixelIsAlbedoOverPiTimesWhatArrives)
{
    Yard yard;
    auto renderer = make(yard.b.view());
    renderer->setSun(0.0, 60.0, 800.0); // from the north, over the wall
    renderer->setSky(120.0);
    Camera camera;
    camera.eye = {0, 0, 10};
    camera.target = {0, 0, 0};
    camera.fovDegrees = 40.0;
    ViewOptions view;
    view.display = false;
    view.smoothLight = false;
    const Picture picture = renderer->render(camera, 33, 33, view);
    const glm::dvec3 albedo(0.2, 0.4, 0.6);
    const glm::dvec3 shade = 120.0 * 0.75 + 0.25 * glm::dvec3(50, 100, 200);
    const auto expectPixel = [&](u32 x, u32 y, double sun) {
        for (int c = 0; c < 3; ++c) {
            const double expected = albedo[c] / kPi * (sun + shade[c]);
            EXPECT_NEAR(picture.values[y * 33 + x][c], expected, 1e-3 * expected) << x << ", " << y << " channel " << c;
        }
    };
    // The shadow of 4 m at 60 degrees ends 2.3 m south of the wall: y = 2.7 m. The picture spans 3.64 m each way.
    expectPixel(16, 16, 800.0 * std::sin(kPi / 3.0));
    expectPixel(16, 1, 0.0);
    expectPixel(16, 31, 800.0 * std::sin(kPi / 3.0));

    view.mode = gpu::kModeSunVisibility;
    const Picture visibility = renderer->render(camera, 33, 33, view);
    EXPECT_EQ(visibility.values[16 * 33 + 16].x, 1.0f);
    EXPECT_EQ(visibility.values[1 * 33 + 16].x, 0.0f);
    view.mode = gpu::kModeDepth;
    EXPECT_NEAR(renderer->render(camera, 33, 33, view).values[16 * 33 + 16].x, 10.0, 1e-4);
    view.mode = gpu::kModeId;
    EXPECT_EQ(renderer->render(camera, 33, 33, view).values[16 * 33 + 16].a, float(yard.ground));
    view.mode = gpu::kModeIndirect;
    EXPECT_EQ(renderer->render(camera, 33, 33, view).values[16 * 33 + 16], glm::vec4(12.5f, 25.0f, 50.0f, 100.0f));
}

TEST_F(RendererTest, PanesReflectTheSkyInDisplayAlone)
{
    TileBuilder b;
    b.quad({{{-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}}}, glm::vec4(0.2f));
    b.sky(0, 1.0f);
    TileView matt = b.view(), glass = matt;
    std::vector<gpu::VertexRecord> vertices(matt.vertices.begin(), matt.vertices.end());
    for (gpu::VertexRecord& v : vertices) v.albedo &= 0xFFFFFFu;
    glass.vertices = vertices;
    Camera camera;
    camera.eye = {0, 0, 40};
    camera.target = {0, 0, 0};
    camera.fovDegrees = 5.0;
    const auto middle = [&](const TileView& tile, bool display) {
        auto renderer = make(tile);
        renderer->setSun(0.0, -90.0, 0.0);
        return glm::dvec3(renderer->render(camera, 9, 9, {.display = display}).values[40]);
    };
    EXPECT_EQ(middle(glass, false), middle(matt, false));
    // At right angles each face reflects (0.5 / 2.5)^2, the corners are seen within 16 degrees of it; no haze to speak
    // of.
    LightState night;
    night.towardsSun = {0, 0, -1};
    night.dni = 0.0;
    const glm::dvec3 zenith = pictureSky({}, night).zenith, more = middle(glass, true) - middle(matt, true);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(more[c], 2.0 * 0.04 / 1.04 * zenith[c], 0.01 * zenith[c]);
}

TEST_F(RendererTest, BackgroundIsTheUniformSkyAndBlackBelow)
{
    Yard yard;
    auto renderer = make(yard.b.view());
    renderer->setSky(100.0);
    ViewOptions view;
    view.display = false;
    Camera camera;
    camera.eye = {0, -30, 2};
    camera.target = {0, -60, 2};
    const Picture picture = renderer->render(camera, 20, 20, view);
    EXPECT_NEAR(picture.values[5 * 20 + 10].r, 100.0 / kPi, 1e-3);
    EXPECT_EQ(glm::vec3(picture.values[15 * 20 + 10]), glm::vec3(0.0f));
    view.mode = gpu::kModeId;
    EXPECT_EQ(renderer->render(camera, 20, 20, view).values[0].a, -1.0f);
}

TEST_F(RendererTest, TheGroundBeyondFollowsSunAndSky)
{
    // A wall that faces north sees half of the sky and half of the plain.
    TileBuilder b;
    const u32 wall = b.quad({{{0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}}}, glm::vec4(0.5f));
    const glm::vec4 rho(0.1f, 0.2f, 0.3f, 0.4f);
    b.sky(wall, 0.5f);
    b.farGround(wall, 0.5f, rho);
    auto renderer = make(b.view());
    renderer->setSky(120.0);
    for (const double elevation : {30.0, 50.0, -20.0}) {
        renderer->setSun(180.0, elevation, 800.0);
        renderer->solve();
        const glm::vec4 sky = renderer->readTables().sky[wall];
        const double onGround = 120.0 + 800.0 * std::max(0.0, std::sin(elevation * kPi / 180.0));
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(sky[c], 60.0 + 0.5 * rho[c] * onGround, 1e-3) << elevation;
    }
    renderer->setSky(10.0, {{3.0f, {}}});
    renderer->solve();
    EXPECT_NEAR(renderer->readTables().sky[wall].x, 0.5 * 3.0 * kPi + 0.5 * 0.1 * 10.0, 1e-4)
        << "a sky of its own radiance";
    renderer->setSun(180.0, 30.0, 800.0);
    ViewOptions view;
    view.display = false;
    Camera camera;
    camera.eye = {2, 30, 2};
    camera.target = {2, 60, 2};
    const Picture picture = renderer->render(camera, 20, 20, view);
    EXPECT_NEAR(picture.values[15 * 20 + 10].g, 0.2 / kPi * 410.0, 1e-3) << "the picture shows it below the horizon";
}

TEST_F(RendererTest, SameBytesTwice)
{
    Yard yard;
    const TileView tile = yard.b.view();
    const auto run = [&] {
        auto renderer = make(tile);
        renderer->setSun(30.0, 40.0, 700.0);
        Camera camera;
        camera.eye = {-15, -15, 9};
        ViewOptions view;
        view.samples = 2;
        return std::pair(renderer->render(camera, 160, 90, view), renderer->readTables());
    };
    const auto [a, tablesA] = run();
    const auto [b, tablesB] = run();
    EXPECT_EQ(a.display, b.display);
    EXPECT_EQ(std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(glm::vec4)), 0);
    EXPECT_EQ(std::memcmp(tablesA.radiosity.data(), tablesB.radiosity.data(), tablesA.radiosity.size() * 16), 0);
    EXPECT_EQ(std::memcmp(tablesA.sun.data(), tablesB.sun.data(), tablesA.sun.size() * 16), 0);
}

TEST_F(RendererTest, ADeviceTooSmallForInterpolatedLightDrawsByThePatchAndSaysSo)
{
    Yard yard;
    RendererOptions options;
    options.mostSmoothBytes = 64;
    auto small = make(yard.b.view(), options);
    auto large = make(yard.b.view());
    Camera camera;
    camera.eye = {0, 0, 12};
    camera.target = {0, 0, 0};
    const Picture flat = small->render(camera, 32, 32, {});
    EXPECT_EQ(small->pictureNote().rfind("light is drawn by the patch: interpolated it takes ", 0), 0u)
        << small->pictureNote();
    EXPECT_EQ(flat.display, large->render(camera, 32, 32, {.smoothLight = false}).display);
    (void)large->render(camera, 32, 32, {});
    EXPECT_EQ(large->pictureNote(), "");
}

TEST_F(RendererTest, InterpolatedLightHasNoStepsAndFollowsTheSky)
{
    TileBuilder b; // two halves of a plane, one sees twice as much sky
    b.quad({{{-8, -8, 0}, {0, -8, 0}, {0, 8, 0}, {-8, 8, 0}}}, glm::vec4(0.5f));
    b.quad({{{0, -8, 0}, {8, -8, 0}, {8, 8, 0}, {0, 8, 0}}}, glm::vec4(0.5f));
    b.sky(0, 0.4f);
    b.sky(1, 0.8f);
    auto renderer = make(b.view());
    renderer->setSun(0.0, -90.0, 0.0);
    Camera camera;
    camera.eye = {0, 0, 10};
    camera.target = {0, 0, 0};
    camera.fovDegrees = 60.0;
    ViewOptions view;
    view.display = false;
    const auto row = [&] { // the middle row of pixels
        const Picture picture = renderer->render(camera, 64, 64, view);
        std::vector<float> out;
        for (u32 x = 0; x < 64; ++x) out.push_back(picture.values[32 * 64 + x].r);
        return out;
    };
    renderer->setSky(100.0);
    const std::vector<float> first = row();
    EXPECT_EQ(row(), first);
    float largest = 0.0f;
    for (u32 x = 0; x + 1 < 64; ++x) largest = std::max(largest, std::abs(first[x + 1] - first[x]));
    const float step = float(40.0 * 0.5 / kPi);
    EXPECT_LT(largest, 0.1f * step);
    renderer->setSky(200.0);
    (void)renderer->solve(); // before the picture
    const std::vector<float> second = row();
    for (u32 x = 0; x < 64; ++x) EXPECT_NEAR(second[x], 2.0f * first[x], 1e-4f * second[x]) << x;
    // A picture for display, whose sky has another colour, leaves nothing behind.
    for (const bool smooth : {true, false}) {
        view.smoothLight = smooth;
        const std::vector<float> linear = row();
        renderer->setSky(smooth ? 200.0 + 1e-9 : 200.0); // solves again
        view.display = true;
        (void)row();
        view.display = false;
        EXPECT_EQ(row(), linear) << smooth;
    }
    const std::vector<float> flat = row();
    EXPECT_NEAR(flat[40] - flat[20], 2.0f * step, 0.01f * step);
}

TEST_F(RendererTest, WhatNoLightReachesDarkensNoNeighbour)
{
    TileBuilder b; // two halves of a plane, one of which is covered: it has neither sky nor links
    b.quad({{{-8, -8, 0}, {0, -8, 0}, {0, 8, 0}, {-8, 8, 0}}}, glm::vec4(0.5f));
    b.quad({{{0, -8, 0}, {8, -8, 0}, {8, 8, 0}, {0, 8, 0}}}, glm::vec4(0.5f));
    b.sky(0, 0.8f);
    auto renderer = make(b.view());
    renderer->setSun(0.0, -90.0, 0.0);
    renderer->setSky(100.0);
    Camera camera;
    camera.eye = {0, 0, 10};
    camera.target = {0, 0, 0};
    camera.fovDegrees = 60.0;
    const Picture smooth = renderer->render(camera, 64, 64, {.display = false});
    const Picture flat = renderer->render(camera, 64, 64, {.smoothLight = false, .display = false});
    EXPECT_NEAR(flat.values[32 * 64 + 16].r, 40.0 / kPi, 0.1);
    for (u32 x = 1; x < 63; ++x) EXPECT_NEAR(smooth.values[32 * 64 + x].r, flat.values[32 * 64 + x].r, 1e-4) << x;
}

TEST_F(RendererTest, WarmStartTakesFewerSweepsToTheSameLight)
{
    TileBuilder b = makeFurnace(0.8f);
    RendererOptions options;
    options.solve.residual = 1e-4;
    options.solve.warmStart = true;
    auto renderer = make(b.view(), options);
    renderer->setSun(0.0, -90.0, 0.0);
    renderer->setSky(0.0);
    const u32 cold = renderer->solve().sweeps;
    const LightTables before = renderer->readTables();
    renderer->setSky(1.0); // no patch sees it: the solution stays
    const SolveReport warm = renderer->solve();
    EXPECT_FALSE(warm.cached);
    EXPECT_LT(warm.sweeps, cold / 2);
    EXPECT_LE(warm.residual, 1e-4);
    const LightTables after = renderer->readTables();
    for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(after.radiosity[i].r, before.radiosity[i].r, 5e-3);
}

TEST_F(RendererTest, NoSunInsideAClosedBox)
{
    // Sixteen patches a side, seen from inside, so that many edges meet; from every side not a texel of light.
    TileBuilder b;
    for (int side = 0; side < 6; ++side)
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const auto corner = [&](int u, int v) {
                    const float x = 2.5f * float(i + u) - 5.0f, y = 2.5f * float(j + v) - 5.0f;
                    const float z = side % 2 ? 5.0f : -5.0f;
                    return side / 2 == 0 ? glm::vec3(z, x, y) : side / 2 == 1 ? glm::vec3(y, z, x) : glm::vec3(x, y, z);
                };
                std::array<glm::vec3, 4> quad{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                if (side % 2) std::swap(quad[1], quad[3]);
                b.quad(quad, glm::vec4(0.5f));
            }
    auto renderer = make(b.view());
    for (const double azimuth : {0.0, 37.0, 100.0, 150.0, 200.0, 290.0})
        for (const double elevation : {5.0, 25.0, 40.0, 60.0, 85.0}) {
            renderer->setSun(azimuth, elevation, 1000.0);
            renderer->solve();
            for (const glm::vec4& e : renderer->readTables().sun)
                EXPECT_EQ(e, glm::vec4(0.0f)) << azimuth << ", " << elevation;
        }
}

TEST_F(RendererTest, ShadowsAtGrazingLightAreSharp)
{
    // A wall that the sun strikes at 4 degrees, with a ledge 0.3 m deep on top: its shadow reaches 0.3 tan(elevation) /
    // sin(4 degrees) = 3.6 m down. An offset of two texels along the normal would lose 1.2 m of it.
    TileBuilder b;
    const u32 wall = b.quad({{{-20, 0, 0}, {20, 0, 0}, {20, 0, 10}, {-20, 0, 10}}}, glm::vec4(0.5f)); // faces south
    b.quad({{{-25, -0.3f, 10}, {25, -0.3f, 10}, {25, 0, 10}, {-25, 0, 10}}}, glm::vec4(0.5f));
    RendererOptions options;
    options.sun.texel = 0.05;
    auto renderer = make(b.view(), options);
    renderer->setSun(94.0, 40.0, 1000.0);
    Camera camera;
    camera.eye = {0, -12, 5};
    camera.target = {0, 0, 5};
    camera.fovDegrees = 45.0;
    ViewOptions view;
    view.mode = gpu::kModeSunVisibility;
    const Picture picture = renderer->render(camera, 200, 200, view);
    const double reach = 0.3 * std::tan(40.0 * kPi / 180.0) / std::sin(4.0 * kPi / 180.0);
    const double metresAPixel = 2.0 * 12.0 * std::tan(22.5 * kPi / 180.0) / 200.0;
    for (u32 y = 3; y < 197; ++y) {
        const double height = 5.0 + (100.0 - y - 0.5) * metresAPixel;
        // A texel is lit or not: the edge may be off by half of one, 0.025 m across the plane through the ledge and the
        // sun, which is 0.3 m along the wall.
        if (height > 9.8 || std::abs(height - (10.0 - reach)) < 0.3) continue;
        EXPECT_EQ(picture.values[y * 200 + 100].x > 0.5f, height < 10.0 - reach) << "at " << height << " m";
    }
    EXPECT_GT(renderer->readTables().sun[wall].w, 0.0f);
}

TEST_F(RendererTest, ViewsAreOneWhole)
{
    // The same light whether the sun's picture is one view or many.
    constexpr u32 kSize = 500;
    Yard yard;
    const TileView tile = yard.b.view();
    RendererOptions one, many;
    one.sun.texel = many.sun.texel = 0.02;
    many.sun.maxViewSize = 256;
    const auto sunOf = [&](const RendererOptions& options) {
        auto renderer = make(tile, options);
        renderer->setSun(20.0, 50.0, 1000.0);
        const u32 views = renderer->solve().sunViews;
        EXPECT_EQ(views > 1, options.sun.maxViewSize == 256);
        Camera camera;
        camera.eye = {0, 0, 25};
        camera.target = {0, 0, 0};
        ViewOptions view;
        view.mode = gpu::kModeSunVisibility;
        return std::pair(renderer->readTables().sun[yard.ground].w,
                         renderer->render(camera, kSize, kSize, view).values);
    };
    const auto [a, pictureA] = sunOf(one);
    const auto [b, pictureB] = sunOf(many);
    EXPECT_NEAR(a, b, 1.0);
    // No seams: away from the shadow's edge both pictures are the same.
    u32 dark = 0;
    for (u32 y = 2; y + 2 < kSize; ++y)
        for (u32 x = 2; x + 2 < kSize; ++x) {
            const float here = pictureA[y * kSize + x].x;
            bool inside = here == 0.0f || here == 1.0f;
            for (const u32 other : {(y - 2) * kSize + x, (y + 2) * kSize + x, y * kSize + x - 2, y * kSize + x + 2})
                inside = inside && pictureA[other].x == here;
            if (!inside) continue;
            dark += here == 0.0f;
            EXPECT_EQ(pictureB[y * kSize + x].x, here) << x << ", " << y;
        }
    EXPECT_GT(dark, 5000u) << "the shadow is large enough to show a seam";
}

TEST_F(RendererTest, RefusesWhatItCannotLight)
{
    TileView nothing;
    EXPECT_FALSE(Renderer::create(context(), nothing, 0.0).ok());
}

} // namespace

} // namespace helio
