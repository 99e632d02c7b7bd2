// SPDX-License-Identifier: Apache-2.0
// The raster pictures against rays through the same triangles.
#include <gtest/gtest.h>

#include "tests/screens/test_packs.h"
#include "tests/screens/visibility_check.h"

namespace helio {
namespace {

constexpr u32 kWidth = 640, kHeight = 360;

struct View
{
    const char* name;
    const char* camera;
    double sunAzimuth, sunElevation;
};
void PrintTo(const View& view, std::ostream* out)
{
    *out << view.name;
}

constexpr View kViews[] = {
    {"aerial", "-34,-40,30,0,0,4,45", 110, 35},
    {"street", "-5,-34,1.7,-5,20,6,60", 200, 50},
    {"low_sun", "30,-45,14,0,0,5,50", 245, 15},
};

const RayScene& cityRays()
{
    static const RayScene rays(testPack(TestPack::City).tile());
    return rays;
}

class Rays : public testing::TestWithParam<View>
{
};

TEST_P(Rays, SunVisibilityAgrees)
{
    const View& view = GetParam();
    Renderer& renderer = testRenderer(TestPack::City);
    renderer.setSun(view.sunAzimuth, view.sunElevation, 800.0);
    const Camera camera = parseCamera(view.camera, testPack(TestPack::City)).value();
    const Agreement agreement = checkSunVisibility(renderer, cityRays(), camera, kWidth, kHeight);
    std::cout << describe(agreement) << std::endl;
    RecordProperty("agreement", describe(agreement));
    std::filesystem::create_directories(HELIO_SCREENS_OUT);
    EXPECT_TRUE(writeTestImage(concat(HELIO_SCREENS_OUT, "/sun_visibility_", view.name, ".png"), agreement.map).ok());
    EXPECT_GE(agreement.share(), 0.995);
    // The figure means something only where there is much to compare, both lit and dark.
    EXPECT_GT(agreement.compared, kWidth * kHeight / 5);
    EXPECT_GT(agreement.lit, 0.1);
    EXPECT_LT(agreement.lit, 0.9);
}

TEST_P(Rays, PatchIdsAgree)
{
    const Camera camera = parseCamera(GetParam().camera, testPack(TestPack::City)).value();
    EXPECT_GE(checkPatchIds(testRenderer(TestPack::City), cityRays(), camera, kWidth, kHeight), 0.9999);
}

INSTANTIATE_TEST_SUITE_P(City, Rays, testing::ValuesIn(kViews), [](const auto& view) { return view.param.name; });

TEST(Rays, AnotherSunDisagrees)
{
    // The same check must see a sun that is five degrees off.
    Renderer& renderer = testRenderer(TestPack::City);
    renderer.setSun(110, 35, 800.0);
    const Camera camera = parseCamera(kViews[0].camera, testPack(TestPack::City)).value();
    const Picture picture =
        renderer.render(camera, kWidth, kHeight, {.mode = gpu::kModeSunVisibility, .display = false});
    std::vector<float> visibility;
    for (const glm::vec4& value : picture.values) visibility.push_back(value.x);
    const RayPicture wrong =
        tracePicture(cityRays(), rayCamera(camera, double(kWidth) / kHeight),
                     sunDirection(115, 35, testPack(TestPack::City).index().northDeg), kWidth, kHeight);
    EXPECT_LT(compareVisibility(wrong, camera.eye, visibility).share(), 0.995);
}

} // namespace
} // namespace helio
