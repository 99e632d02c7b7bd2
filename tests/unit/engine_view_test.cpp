// SPDX-License-Identifier: Apache-2.0
// Cameras, sun directions and the fit of the sun's picture: no device.
#include <gtest/gtest.h>
#include <set>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/stages/sun_view.h"
#include "engine/view/camera.h"
#include "engine/view/display.h"
#include "engine/view/light_state.h"
#include "shaders/shared/disc.h"

namespace helio {

namespace {

void expectNear(glm::dvec3 a, glm::dvec3 b, double tolerance = 1e-12)
{
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(SunDirection, RunsClockwiseFromTrueNorth)
{
    expectNear(sunDirection(0, 0, 0), {0, 1, 0});
    expectNear(sunDirection(90, 0, 0), {1, 0, 0});
    expectNear(sunDirection(180, 30, 0), {0, -std::sqrt(0.75), 0.5});
    // +y points 10 degrees east of true north: a sun in true north stands 10 degrees west of +y.
    expectNear(sunDirection(0, 0, 10), {-std::sin(glm::radians(10.0)), std::cos(glm::radians(10.0)), 0});
}

TEST(Camera, ProjectsByHand)
{
    Camera camera;
    camera.eye = {0, -10, 0};
    camera.target = {0, 0, 0};
    camera.fovDegrees = 90.0;
    const glm::dmat4 m = clipFromWorld(camera, 2.0);
    const auto project = [&](glm::dvec3 p) {
        const glm::dvec4 c = m * glm::dvec4(p, 1.0);
        return glm::dvec3(c) / c.w;
    };
    expectNear(project({0, 0, 0}), {0, 0, 0.01});   // near 0.1 over distance 10
    expectNear(project({20, 0, 0}), {1, 0, 0.01});  // right edge: tan 45 x 10 x aspect 2
    expectNear(project({0, 0, 10}), {0, 1, 0.01});  // up
    expectNear(project({0, -9.9, 0}), {0, 0, 1.0}); // the near plane
}

TEST(Camera, PresetsLookAtTheCity)
{
    const glm::dvec3 lo(-200, -100, 0), hi(200, 100, 30);
    for (const Camera& camera : {aerialCamera(lo, hi), topCamera(lo, hi)}) {
        const glm::dvec4 middle = clipFromWorld(camera, 1.6) * glm::dvec4(0, 0, 0, 1);
        EXPECT_GT(middle.w, 0.0);
        EXPECT_LT(std::abs(middle.x / middle.w), 0.2);
        EXPECT_LT(std::abs(middle.y / middle.w), 0.3);
        EXPECT_GT(camera.eye.z, hi.z);
    }
    // From above, everything is in the picture.
    for (const double x : {lo.x, hi.x})
        for (const double y : {lo.y, hi.y}) {
            const glm::dvec4 corner = clipFromWorld(topCamera(lo, hi), 1.6) * glm::dvec4(x, y, 30, 1);
            EXPECT_LE(std::abs(corner.x), corner.w * 1.05);
            EXPECT_LE(std::abs(corner.y), corner.w * 1.05);
        }
}

TEST(Camera, RefusesWhatItCannotRead)
{
    const Pack pack;
    for (const char* text :
         {"", "arial", "1,2,3", "1,2,3,4,5,6,7,8", "1,2,3,1,2,3", "0,0,0,1,0,0,180", "0,0,0,1,0,nan", "0,0,0,1,0,0,"})
        EXPECT_FALSE(parseCamera(text, pack).ok()) << text;
    const auto camera = parseCamera("1,2,3,-4,5.5,6,50", pack);
    ASSERT_TRUE(camera.ok());
    expectNear(camera->target, {-4, 5.5, 6});
    EXPECT_EQ(camera->fovDegrees, 50.0);
}

glm::vec3 gridOf(const SunView& view, glm::vec3 p)
{
    return glm::vec3(view.gridFromWorld * glm::vec4(p, 1.0f));
}

TEST(SunView, HoldsEveryBoxInOneOfItsViews)
{
    const std::vector<Box> boxes{{{-50, -20, 0}, {60, 35, 30}}, {{100, 100, 5}, {120, 101, 90}}};
    for (const double azimuth : {0.0, 33.0, 135.0, 250.0})
        for (const double elevation : {2.0, 45.0, 90.0}) {
            SunViewOptions options;
            options.maxViewSize = 500;
            const SunView view = fitSunView(boxes, sunDirection(azimuth, elevation, 0), options);
            EXPECT_GT(view.viewCount(), 1u);
            for (const Box& box : boxes)
                for (u32 k = 0; k < 8; ++k) {
                    const glm::vec3 p((k & 1) ? box.hi.x : box.lo.x, (k & 2) ? box.hi.y : box.lo.y,
                                      (k & 4) ? box.hi.z : box.lo.z);
                    u32 inside = 0;
                    for (u32 v = 0; v < view.viewCount(); ++v) {
                        const glm::vec4 c = view.clipFromWorld(v) * glm::vec4(p, 1.0f);
                        inside += std::abs(c.x) <= 1.0f && std::abs(c.y) <= 1.0f && c.z >= 0.0f && c.z <= 1.0f;
                    }
                    EXPECT_EQ(inside, 1u) << azimuth << ", " << elevation;
                }
        }
}

TEST(SunView, NearerTheSunIsSmallerDepthAndTexelsKeepTheirArea)
{
    const std::vector<Box> boxes{{{0, 0, 0}, {100, 40, 20}}};
    const glm::dvec3 sun = sunDirection(200, 50, 0);
    const SunView view = fitSunView(boxes, sun, {});
    const glm::vec3 p(10, 10, 10);
    EXPECT_LT(gridOf(view, p + glm::vec3(sun)).z, gridOf(view, p).z);
    // A step towards the sun moves along the line of sight alone.
    EXPECT_NEAR(gridOf(view, p + glm::vec3(sun)).x, gridOf(view, p).x, 1e-4);
    // The determinant over two steps across the sun is one texel area a texel, whatever the shears.
    const glm::dvec3 a = glm::normalize(glm::cross(sun, glm::dvec3(0, 0, 1))), b = glm::cross(sun, a);
    const glm::vec4 o = view.clipFromWorld(0) * glm::vec4(p, 1.0f);
    const glm::vec4 da = view.clipFromWorld(0) * glm::vec4(p + glm::vec3(a), 1.0f) - o;
    const glm::vec4 db = view.clipFromWorld(0) * glm::vec4(p + glm::vec3(b), 1.0f) - o;
    const double texels = std::abs(double(da.x) * db.y - double(da.y) * db.x) / 4.0 * view.width * view.height;
    EXPECT_NEAR(texels * view.texelArea(), 1.0, 1e-3);
}

TEST(SunView, TexelsLieFastOnTheCentreAsTheSunMoves)
{
    // The rectangle grows and shrinks with every step; neither the texel nor the place of the centre in one may follow.
    const std::vector<Box> boxes{{{-150, -90, 0}, {170, 35, 30}}, {{100, 100, 5}, {220, 201, 90}}};
    const glm::vec3 centre(35, 55.5f, 45);
    SunViewOptions options;
    options.maxTexels = 1u << 22;
    const auto place = [&](const SunView& view) { // from where a texel begins, x and y
        const glm::dvec2 texels = glm::dvec2(gridOf(view, centre)) * glm::dvec2(view.width, view.height);
        return texels - glm::round(texels);
    };
    std::set<double> texels, widths;
    for (u32 t = 0; t < 40; ++t) {
        const SunView view = fitSunView(boxes, sunDirection(140 + 0.05 * t, 35, 0), options);
        texels.insert(view.texel);
        widths.insert(view.width * view.gridX + 1e5 * view.height * view.gridY);
        EXPECT_NEAR(place(view).x, 0.0, 0.01) << t;
        EXPECT_NEAR(place(view).y, 0.0, 0.01) << t;
    }
    EXPECT_EQ(texels.size(), 1u);
    EXPECT_GT(widths.size(), 5u) << "the case is too easy";
}

TEST(SunView, AStreetGetsTexelsShapedToIt)
{
    // 4 km by 40 m, askew: a picture of square texels over its axis-parallel bounds would take 4 km x 4 km.
    std::vector<Box> boxes;
    for (int i = 0; i < 1000; ++i) {
        const float x = 2.9f * float(i), y = 2.8f * float(i);
        boxes.push_back({{x, y, 0}, {x + 30.0f, y + 30.0f, 20}});
    }
    SunViewOptions options;
    const SunView view = fitSunView(boxes, sunDirection(120, 60, 0), options);
    const u64 texels = u64(view.viewCount()) * view.width * view.height;
    EXPECT_LE(texels, options.maxTexels);
    EXPECT_LT(double(texels) * view.texelArea(), 4100.0 * 90.0);
    EXPECT_LT(view.texel, 0.08);
    EXPECT_LE(std::max(view.width, view.height), options.maxViewSize);
}

TEST(Display, LinearOutputHasNoTint)
{
    LightState light;
    light.towardsSun = sunDirection(150, 40, 0);
    const gpu::ViewRecord v = viewRecord({}, {1.5, 1.0}, light, {}, {}, {});
    EXPECT_EQ(v.sunLight, glm::vec4(800.0f));
    EXPECT_NEAR(double(v.zenith.r), 120.0 / 3.14159265, 1e-4);
    EXPECT_EQ(glm::vec3(v.horizon), glm::vec3(v.zenith));
    EXPECT_EQ(glm::vec3(v.ground), glm::vec3(0.0f));
    EXPECT_EQ(forwardParams({}, 1.5, {}, false).eye.w, 0.0f);
    // A ground beyond the scene is as bright as the light solve has it: rho / pi (DNI sin(elevation) + DHI).
    const gpu::ViewRecord g = viewRecord({}, {1.5, 1.0}, light, {}, {-1.0, {0.1, 0.2, 0.3}}, {});
    EXPECT_NEAR(double(g.ground.g), 0.2 / 3.14159265 * (800.0 * std::sin(glm::radians(40.0)) + 120.0), 1e-4);
    EXPECT_EQ(g.horizon.w * g.ground.w, 0.0f) << "no haze over it";
}

/// Mean over a disc of uniform radiance of what stands above a line, t radii below its centre: its height and its
/// share.
struct DiscSums
{
    double height = 0.0, share = 0.0;
};
DiscSums integrateDisc(double t)
{
    constexpr int kSteps = 2000;
    DiscSums sums;
    double all = 0.0;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double x = (i + 0.5) * 2.0 / kSteps - 1.0, y = (k + 0.5) * 2.0 / kSteps - 1.0;
            if (x * x + y * y > 1.0) continue;
            all += 1.0;
            if (y + t <= 0.0) continue;
            sums.height += y + t;
            sums.share += 1.0;
        }
    return {sums.height / all, sums.share / all};
}

TEST(SunDisc, ClosedFormsAgainstQuadrature)
{
    for (const double t : {-1.2, -0.9, -0.4, 0.0, 0.3, 0.8, 1.5}) {
        const DiscSums sums = integrateDisc(t);
        EXPECT_NEAR(double(gpu::discShare(float(t))), sums.share, 1e-3) << t;
        EXPECT_NEAR(double(gpu::discHeight(float(t))), sums.height, 1e-3) << t;
        EXPECT_NEAR(double(gpu::discCosine(float(0.01 * t), 0.01f)), 0.01 * sums.height, 1e-5) << t;
    }
    EXPECT_NEAR(double(gpu::discCosine(0.0f, gpu::kSunRadius)), 2.0 / (3.0 * 3.14159265) * 0.0046542, 1e-9);
    EXPECT_EQ(gpu::discCosine(0.3f, gpu::kSunRadius), 0.3f);
    EXPECT_EQ(gpu::discCosine(-0.3f, gpu::kSunRadius), 0.0f);
    EXPECT_EQ(gpu::discCosine(1e-4f, 0.0f), 1e-4f);
    EXPECT_EQ(gpu::discCosine(-1e-4f, 0.0f), 0.0f);
    EXPECT_EQ(gpu::discCosine(0.0f, 0.0f), 0.0f);
}

TEST(SunDisc, TheHorizonCutsIt)
{
    const double radius = double(gpu::kSunRadius);
    LightState light;
    const glm::dvec3 high = sunDirection(100, 0.3, 0);
    setSunDisc(light, high, 700.0);
    EXPECT_EQ(light.towardsSun, high);
    EXPECT_EQ(light.dni, 700.0);
    EXPECT_EQ(light.sunRadius, radius);
    for (const double elevation : {-0.25, -0.1, 0.0, 0.2}) {
        const glm::dvec3 centre = sunDirection(100, elevation, 0);
        setSunDisc(light, centre, 700.0);
        const DiscSums above = integrateDisc(centre.z / radius);
        EXPECT_TRUE(light.sunUp());
        EXPECT_NEAR(light.dni, 700.0 * above.share, 1.0) << elevation;
        EXPECT_NEAR(light.dni * light.towardsSun.z, 700.0 * radius * above.height, 700.0 * radius * 1e-3) << elevation;
        EXPECT_NEAR(glm::length(light.towardsSun), 1.0, 1e-12);
        EXPECT_NEAR(light.towardsSun.y / light.towardsSun.x, centre.y / centre.x, 1e-12);
    }
    for (const double elevation : {-0.27, -5.0, -90.0}) {
        setSunDisc(light, sunDirection(100, elevation, 0), 700.0);
        EXPECT_FALSE(light.sunUp()) << elevation;
    }
}

TEST(OutsideRadiance, TheGroundBeyondIsLitBySunAndSky)
{
    std::vector<gpu::SkyPatchRecord> patches{{{0, 0, 1}, 3.0f, {}}, {{0, 1, 0}, 3.0f, {}}};
    LightState light;
    light.towardsSun = sunDirection(150, 30, 0);
    constexpr double kPi = 3.14159265358979;
    const auto near = [](float value, double expected) { EXPECT_NEAR(double(value), expected, 1e-6 * expected); };
    std::vector<SkyRadiance> radiance = outsideRadiance(patches, light);
    ASSERT_EQ(radiance.size(), 2u);
    near(radiance[1].mean.w, 120.0 / kPi);
    patches.push_back({{0, 0, -1}, 6.2831853f, {0.1f, 0.2f, 0.3f, 0.4f}});
    radiance = outsideRadiance(patches, light);
    ASSERT_EQ(radiance.size(), 3u);
    near(radiance[2].mean.x, 0.1 / kPi * 520.0);
    near(radiance[2].mean.w, 0.4 / kPi * 520.0);
    light.skyRadiance = {{7.0f, {}}, {9.0f, {1.0f, 2.0f}}};
    light.towardsSun.z = -0.1;
    radiance = outsideRadiance(patches, light);
    EXPECT_EQ(radiance[1].mean, glm::vec4(9.0f));
    EXPECT_EQ(radiance[1].slope, glm::vec2(1.0f, 2.0f));
    EXPECT_EQ(radiance[2].slope, glm::vec2(0.0f));
    near(radiance[2].mean.y, 0.2 / kPi * 120.0);
}

double luminanceOf(const glm::dvec3& c)
{
    return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// The irradiance of the picture's sky on an open horizontal plane, by midpoints of height and azimuth.
double irradianceOf(const PictureSky& sky, const glm::dvec3& towardsSun)
{
    double sum = 0.0;
    constexpr int kSteps = 300;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double z = (i + 0.5) / kSteps, turn = 2.0 * 3.14159265358979 * (k + 0.5) / kSteps;
            const double level = std::sqrt(1.0 - z * z), h = std::pow(1.0 - z, 3.0);
            const double c =
                std::max(glm::dot(glm::dvec3(level * std::cos(turn), level * std::sin(turn), z), towardsSun), 0.0);
            sum += z * luminanceOf(sky.zenith * (1.0 - h) + sky.horizon * h +
                                   sky.glow * (0.25 * std::pow(c, 8.0) + 0.5 * std::pow(c, 64.0)));
        }
    return sum * 2.0 * 3.14159265358979 / (kSteps * kSteps);
}

TEST(PictureSky, TintsKeepTheBrightness)
{
    LightState light;
    light.towardsSun = sunDirection(150, 10, 0);
    const PictureSky sky = pictureSky({}, light);
    const gpu::ViewRecord v = viewRecord({}, {1.5, 1.0}, light, {}, {}, sky);
    EXPECT_NEAR(luminanceOf(glm::dvec3(v.sunLight)), 800.0, 0.01);
    EXPECT_NEAR(luminanceOf(sky.tint), 1.0, 1e-12);
    EXPECT_GT(v.sunLight.r, v.sunLight.b);
    EXPECT_GT(sky.tint.b, sky.tint.r);
    EXPECT_NEAR(irradianceOf(sky, light.towardsSun), light.dhi, 0.2);
}

TEST(PictureSky, IsGreyWithoutTheSun)
{
    LightState light;
    light.towardsSun = sunDirection(150, 40, 0);
    light.dni = 0.0;
    const PictureSky sky = pictureSky({}, light);
    EXPECT_LT(sky.tint.b / sky.tint.r, 1.15);
    EXPECT_EQ(luminanceOf(sky.glow), 0.0);
    EXPECT_NEAR(irradianceOf(sky, light.towardsSun), light.dhi, 0.2);
}

/// Cells of equal solid angle: rings of equal height, cut into sectors.
std::vector<gpu::SkyPatchRecord> ringCells()
{
    std::vector<gpu::SkyPatchRecord> cells;
    for (int ring = 0; ring < 8; ++ring)
        for (int sector = 0; sector < 24; ++sector) {
            const double z = (ring + 0.5) / 8, turn = glm::radians(15.0 * sector), level = std::sqrt(1.0 - z * z);
            cells.push_back({glm::vec3(level * std::cos(turn), level * std::sin(turn), z), 6.2831853f / (8 * 24), {}});
        }
    return cells;
}

TEST(PictureSky, FollowsTheSkyModel)
{
    const std::vector<gpu::SkyPatchRecord> cells = ringCells();
    LightState light;
    light.dhi = 100.0;
    light.towardsSun = sunDirection(150, 40, 0);
    const auto fit = [&](const auto& radianceOf) {
        light.skyRadiance.clear();
        for (const gpu::SkyPatchRecord& cell : cells)
            light.skyRadiance.push_back({float(radianceOf(glm::dvec3(cell.direction))), {}});
        return pictureSky(cells, light);
    };
    // The traditional overcast sky, three times as bright above as at the horizon, and dark around it.
    light.dni = 0.0;
    const double zenith = 9.0 / 7.0 * 100.0 / 3.14159265358979;
    const PictureSky overcast = fit([&](const glm::dvec3& d) { return zenith * (1.0 + 2.0 * d.z) / 3.0; });
    EXPECT_NEAR(luminanceOf(overcast.zenith), zenith, 0.25 * zenith);
    EXPECT_NEAR(luminanceOf(overcast.horizon), zenith / 3.0, 0.25 * zenith);
    EXPECT_LT(luminanceOf(overcast.glow), 0.3 * zenith);
    EXPECT_NEAR(irradianceOf(overcast, light.towardsSun), 100.0, 0.2);
    // A sky of the very shapes, whose weights come back; one of them negative in the best fit: it stays out.
    light.dni = 800.0;
    const auto glowing = [&](double weight) {
        return [&, weight](const glm::dvec3& d) {
            const double h = std::pow(1.0 - d.z, 3.0), c = std::max(glm::dot(d, light.towardsSun), 0.0);
            return 20.0 * (1.0 - h) + 60.0 * h + weight * (0.25 * std::pow(c, 8.0) + 0.5 * std::pow(c, 64.0));
        };
    };
    light.dhi = irradianceOf({glm::dvec3(20.0), glm::dvec3(60.0), glm::dvec3(90.0), {}}, light.towardsSun);
    const PictureSky clear = fit(glowing(90.0));
    EXPECT_NEAR(luminanceOf(clear.zenith), 20.0, 0.1);
    EXPECT_NEAR(luminanceOf(clear.horizon), 60.0, 0.1);
    EXPECT_NEAR(luminanceOf(clear.glow), 90.0, 0.1);
    EXPECT_EQ(luminanceOf(fit(glowing(-10.0)).glow), 0.0);
    // A horizon that the best fit has black: what is far away must not fade to it.
    const PictureSky dark = fit([&](const glm::dvec3& d) { return 10.0 + 80.0 * std::pow(d.z, 4.0); });
    EXPECT_NEAR(luminanceOf(dark.horizon), 0.25 * luminanceOf(dark.zenith), 1e-6);
    EXPECT_NEAR(irradianceOf(dark, light.towardsSun), light.dhi, 0.5);
}

TEST(PictureSky, WithoutASunOrWithoutLight)
{
    const std::vector<gpu::SkyPatchRecord> cells = ringCells();
    LightState light;
    light.dni = 0.0;
    light.dhi = 5.0;
    light.towardsSun = sunDirection(150, -3, 0);
    light.skyRadiance.assign(cells.size(), {float(5.0 / 3.14159265358979), {}});
    const PictureSky dusk = pictureSky(cells, light);
    EXPECT_EQ(luminanceOf(dusk.glow), 0.0);
    EXPECT_NEAR(luminanceOf(dusk.zenith), 5.0 / 3.14159265358979, 1e-3) << "uniform, as the cells are";
    EXPECT_NEAR(luminanceOf(dusk.horizon), 5.0 / 3.14159265358979, 1e-3);
    light.skyRadiance.assign(cells.size(), {});
    EXPECT_NEAR(irradianceOf(pictureSky(cells, light), light.towardsSun), 5.0, 0.02) << "cells say nothing";
    light.dhi = 0.0;
    const PictureSky night = pictureSky(cells, light);
    EXPECT_EQ(luminanceOf(night.zenith + night.horizon + night.glow), 0.0);
    EXPECT_NEAR(luminanceOf(night.tint), 1.0, 1e-12);
    // The colours do not jump when the disc sets.
    LightState before, after;
    setSunDisc(before, sunDirection(150, -0.25, 0), 800.0);
    setSunDisc(after, sunDirection(150, -0.28, 0), 800.0);
    EXPECT_NEAR(pictureSky({}, before).tint.b, pictureSky({}, after).tint.b, 0.01);
}

} // namespace

} // namespace helio
