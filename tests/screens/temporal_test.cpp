// SPDX-License-Identifier: Apache-2.0
// Sequences of pictures: what moves slowly must not flicker. Judged by the second difference over three pictures in a
// row, in which steady changes cancel.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <vector>

#include "tests/screens/test_packs.h"

namespace helio {
namespace {

constexpr u32 kWidth = 320, kHeight = 180;
constexpr u32 kFrames = 8;
constexpr const char* kCamera = "-30,-48,30,0,-2,4,45";

/// Least contrast that the eye sees between fields side by side, about 1 % at best (Barten, "Contrast sensitivity of
/// the human eye", 1999); no pixel may step by five times that.
constexpr double kVisibleContrast = 0.01, kMostContrast = 0.05;
/// Where shadow edges pass. A texel of the sun's depth is lit or not, so an edge lies up to half a texel off, uniformly
/// and anew for each texel along it: 0.29 texels rms. A pixel here is w = 4 to 6 texels wide and holds as many along
/// the edge: its visibility is off by 0.29 / w / sqrt(w), at most 0.036; three pictures with weights 1, -2, 1 and
/// errors of their own: sqrt(6) times that.
constexpr double kEdgeNoise = 0.09;
/// Of nearness and albedo from pixel to pixel: rounding.
constexpr double kBend = 1e-5;

struct Frame
{
    std::vector<double> radiance;   ///< luminance, W/m2/sr
    std::vector<double> visibility; ///< of the sun
    std::vector<glm::vec4> albedo;  ///< mixed where a pixel shows more than one surface
    std::vector<double> nearness;   ///< 1 / distance along the view, 1/m: over a plane linear in the picture
};

Frame frameOf(Renderer& renderer, const Camera& camera)
{
    const auto values = [&](u32 mode) {
        return renderer.render(camera, kWidth, kHeight, {.mode = mode, .samples = 2, .display = false}).values;
    };
    Frame frame;
    for (const glm::vec4& v : values(gpu::kModeFinal))
        frame.radiance.push_back(0.2126 * double(v.r) + 0.7152 * double(v.g) + 0.0722 * double(v.b));
    for (const glm::vec4& v : values(gpu::kModeSunVisibility)) frame.visibility.push_back(double(v.r));
    frame.albedo = values(gpu::kModeAlbedo);
    const std::vector<glm::vec4> distance = values(gpu::kModeDepth);
    const double high = std::tan(0.5 * glm::radians(camera.fovDegrees)), wide = high * kWidth / kHeight;
    for (u32 y = 0; y < kHeight; ++y)
        for (u32 x = 0; x < kWidth; ++x) {
            const double across = wide * (2.0 * (x + 0.5) / kWidth - 1.0),
                         up = high * (2.0 * (y + 0.5) / kHeight - 1.0);
            frame.nearness.push_back(std::sqrt(1.0 + across * across + up * up) / double(distance[y * kWidth + x].r));
        }
    return frame;
}

/// Do a pixel and its neighbours show one plane of one colour?
bool isInside(const Frame& frame, size_t pixel)
{
    if (!std::isfinite(frame.nearness[pixel])) return false; // the background
    for (const size_t step : {size_t(1), size_t(kWidth)}) {
        const double bend =
            std::abs(frame.nearness[pixel - step] - 2.0 * frame.nearness[pixel] + frame.nearness[pixel + step]);
        if (bend > kBend * frame.nearness[pixel]) return false;
        for (const size_t k : {pixel - step, pixel + step})
            if (glm::distance(frame.albedo[k], frame.albedo[pixel]) > kBend) return false;
    }
    return true;
}

/// Pixels of three frames in a row, apart from those where an outline or a crease passes.
struct Flicker
{
    std::vector<double> steady; ///< |second difference| / radiance where the sun's visibility stands
    std::vector<double> edges;  ///< |second difference| of the visibility elsewhere
};

Flicker flickerOf(const std::vector<Frame>& frames)
{
    Flicker result;
    const auto second = [](double a, double b, double c) { return std::abs(a - 2.0 * b + c); };
    for (size_t t = 1; t + 1 < frames.size(); ++t) {
        const Frame &a = frames[t - 1], &b = frames[t], &c = frames[t + 1];
        for (size_t y = 1; y + 1 < kHeight; ++y)
            for (size_t x = 1; x + 1 < kWidth; ++x) {
                const size_t k = y * kWidth + x;
                if (!isInside(a, k) || !isInside(b, k) || !isInside(c, k)) continue;
                if (a.visibility[k] == b.visibility[k] && b.visibility[k] == c.visibility[k])
                    result.steady.push_back(second(a.radiance[k], b.radiance[k], c.radiance[k]) / b.radiance[k]);
                else
                    result.edges.push_back(second(a.visibility[k], b.visibility[k], c.visibility[k]));
            }
    }
    std::sort(result.steady.begin(), result.steady.end());
    return result;
}

void expectNoFlicker(const std::vector<Frame>& frames)
{
    const Flicker f = flickerOf(frames);
    ASSERT_GT(f.steady.size(), 100'000u);
    ASSERT_GT(f.edges.size(), 1000u);
    double squares = 0.0;
    for (const double d : f.edges) squares += d * d;
    const double most = f.steady[size_t(0.999 * double(f.steady.size()))],
                 rms = std::sqrt(squares / double(f.edges.size()));
    std::printf("%zu steady: 99.9 %% below %.3g, worst %.3g; %zu with a shadow's edge: rms %.3g\n", f.steady.size(),
                most, f.steady.back(), f.edges.size(), rms);
    EXPECT_LT(most, kVisibleContrast);
    EXPECT_LT(f.steady.back(), kMostContrast);
    EXPECT_LT(rms, kEdgeNoise);
}

TEST(Temporal, AMovingSunDoesNotFlicker)
{
    Renderer& renderer = testRenderer(TestPack::City);
    const Camera camera = parseCamera(kCamera, testPack(TestPack::City)).value();
    renderer.setSky(120.0);
    std::vector<Frame> frames;
    for (u32 t = 0; t < kFrames; ++t) {
        renderer.setSun(115.0 + 0.02 * t, 28.0 + 0.008 * t, 800.0); // five seconds a picture
        frames.push_back(frameOf(renderer, camera));
    }
    expectNoFlicker(frames);
}

TEST(Temporal, AMovingCameraDoesNotFlicker)
{
    Renderer& renderer = testRenderer(TestPack::City);
    renderer.setSun(115.0, 28.0, 800.0);
    renderer.setSky(120.0);
    std::vector<Frame> frames;
    for (u32 t = 0; t < kFrames; ++t) {
        Camera camera = parseCamera(kCamera, testPack(TestPack::City)).value();
        const glm::dvec3 way = double(t) * glm::dvec3(0.03, 0.02, -0.01); // m, about a tenth of a pixel a picture
        camera.eye += way;
        camera.target += way;
        frames.push_back(frameOf(renderer, camera));
        EXPECT_TRUE(renderer.solve().cached) << "a camera needs no new light";
    }
    expectNoFlicker(frames);
}

} // namespace
} // namespace helio
