// SPDX-License-Identifier: Apache-2.0
// Pictures of every stage's output and final pictures against goldens of the software driver.
#include <algorithm>
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>
#include <set>

#include "tests/screens/golden_check.h"
#include "tests/screens/test_packs.h"

namespace helio {
namespace {

constexpr u32 kWidth = 320, kHeight = 180;

// Tolerances, each with its reason. The driver, its version and its compiler are pinned by the folder of the goldens;
// what is left to differ is the machine's vector width and fused multiply-adds.
//
// Ids are integers behind a fixed-point rasteriser: no pixel may differ.
// Display pictures: 5 steps of 255 on one pixel in a thousand. A pixel centre that falls on an edge may change sides
// when a vertex moves by one rounding (the share), everything else is smooth arithmetic, rounded once (below one step
// in the mean).
constexpr Tolerance kDisplayTolerance{5, 0.001, 0.2};
// Visibility: the same, but a shadow edge moves with the sun raster's own roundings, so pixels are judged by half a
// step of its four-texel filter (32 of 255) and not by a twentieth of it.
constexpr Tolerance kVisibilityTolerance{32, 0.001, 0.2};
// Radiosity, W/m2: values reach about 300, half floats there are 0.25 apart; two of those steps.
constexpr Tolerance kRadiosityTolerance{0.5, 0.001, 0.05};

struct Screen
{
    std::string file; ///< of the golden
    TestPack pack;
    const char* camera;
    double sunAzimuth, sunElevation;
    ViewOptions view;
    Tolerance tolerance;
    double dni = 800.0, dhi = 120.0; ///< W/m2
};

void PrintTo(const Screen& screen, std::ostream* out)
{
    *out << screen.file;
}

constexpr const char* kCityCamera = "-30,-48,30,0,-2,4,45";
constexpr const char* kStreetCamera = "-5,-34,1.7,-5,20,6,60";
// Four plans of each rule file from the air, and one front from the street.
constexpr const char* kMidriseCamera = "0,-92,52,0,0,4,48";
constexpr const char* kMidriseStreet = "-52,-20,1.7,-35,-10,7,60";
constexpr const char* kRowhouseCamera = "0,-60,30,0,0,1,48";
constexpr const char* kRowhouseStreet = "-20,-20,1.7,-17,-6,4,60";
constexpr const char* kTowerCamera = "20,-190,110,0,0,24,45";
constexpr const char* kTowerStreet = "-50,-75,1.7,-42,-20,24,65";
// Down into the court, and up from between the towers: where light goes round more than one corner.
constexpr const char* kCourtCamera = "30,-14,26,12,8,2,50";
constexpr const char* kTowerFoot = "-30,-60,9,0,10,20,65";
constexpr const char* kSceneCamera = "12,-27,54,48,51,4,38";

/// Light by the patch and interpolated, of two cities under three suns and under an overcast sky.
std::vector<Screen> shadingScreens()
{
    struct City
    {
        const char* name;
        TestPack pack;
        const char* camera;
    };
    struct Sky
    {
        const char* name;
        double azimuth, elevation, dni, dhi;
    };
    std::vector<Screen> screens;
    for (const City& city : {City{"court", TestPack::City, kCourtCamera}, City{"tower", TestPack::Tower, kTowerFoot}})
        for (const Sky& sky : {Sky{"morning", 95, 14, 500, 60}, Sky{"noon", 180, 60, 850, 100},
                               Sky{"evening", 250, 25, 650, 80}, Sky{"overcast", 180, 40, 0, 200}})
            for (const bool smooth : {false, true}) {
                Screen s{concat("shading_", city.name, "_", sky.name, smooth ? "_smooth.png" : "_flat.png"),
                         city.pack,
                         city.camera,
                         sky.azimuth,
                         sky.elevation,
                         {.samples = 2, .smoothLight = smooth},
                         kDisplayTolerance};
                s.dni = sky.dni;
                s.dhi = sky.dhi;
                screens.push_back(s);
            }
    return screens;
}

const Screen kStageScreens[] = {
    {"city_ids.png", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeId}, kIdentical},
    {"city_depth.png", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeDepth}, kDisplayTolerance},
    {"city_sun_visibility.png",
     TestPack::City,
     kCityCamera,
     215,
     35,
     {.mode = gpu::kModeSunVisibility},
     kVisibilityTolerance},
    {"city_sun.png", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeSun}, kDisplayTolerance},
    {"city_sky.png", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeSky}, kDisplayTolerance},
    {"city_indirect.png", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeIndirect}, kDisplayTolerance},
    {"city_albedo.png", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeAlbedo}, kDisplayTolerance},
    {"city_level.png", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeLevel}, kDisplayTolerance},
    {"city_links.png",
     TestPack::City,
     kCityCamera,
     215,
     35,
     {.mode = gpu::kModeLinks, .picked = 700},
     kDisplayTolerance},
    {"city_residual.png", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeResidual}, kDisplayTolerance},
    {"city_error.png", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeError}, kDisplayTolerance},
    {"city_radiosity.exr", TestPack::City, kCityCamera, 215, 35, {.mode = gpu::kModeRadiosity}, kRadiosityTolerance},
    {"city_final.png", TestPack::City, kCityCamera, 215, 35, {.samples = 2}, kDisplayTolerance},
    {"city_final_plain.png",
     TestPack::City,
     kCityCamera,
     215,
     35,
     {.smoothLight = false, .display = false},
     kDisplayTolerance},
    {"city_final_low_sun.png", TestPack::City, kCityCamera, 265, 9, {.samples = 2}, kDisplayTolerance},
    {"city_final_street.png", TestPack::City, kStreetCamera, 150, 55, {.samples = 2}, kDisplayTolerance},
    {"midrise_plans.png", TestPack::Midrise, kMidriseCamera, 215, 38, {.samples = 2}, kDisplayTolerance},
    {"midrise_street.png", TestPack::Midrise, kMidriseStreet, 215, 38, {.samples = 2}, kDisplayTolerance},
    {"rowhouse_plans.png", TestPack::Rowhouse, kRowhouseCamera, 215, 38, {.samples = 2}, kDisplayTolerance},
    {"rowhouse_street.png", TestPack::Rowhouse, kRowhouseStreet, 215, 38, {.samples = 2}, kDisplayTolerance},
    {"tower_plans.png", TestPack::Tower, kTowerCamera, 215, 38, {.samples = 2}, kDisplayTolerance},
    {"tower_street.png", TestPack::Tower, kTowerStreet, 215, 38, {.samples = 2}, kDisplayTolerance},
    {"scene_s_final.png", TestPack::SceneS, kSceneCamera, 110, 35, {.samples = 2}, kDisplayTolerance},
    {"scene_s_ids.png", TestPack::SceneS, kSceneCamera, 200, 40, {.mode = gpu::kModeId}, kIdentical},
};

const std::vector<Screen> kScreens = [] {
    std::vector<Screen> screens = shadingScreens();
    screens.insert(screens.end(), std::begin(kStageScreens), std::end(kStageScreens));
    return screens;
}();

GoldenFolders goldenFolders()
{
    const std::string driver = driverFolder(testContext().facts().driver);
    return {std::filesystem::path(HELIO_SOURCE_FOLDER) / "tests/screens/goldens" / driver,
            std::filesystem::path(HELIO_SCREENS_OUT) / driver};
}

/// The traditional overcast sky, three times as bright above as at the horizon: 7 pi / 9 of its zenith on the ground.
std::vector<CellRadiance> overcast(const TileView& tile, double dhi)
{
    std::vector<CellRadiance> radiance;
    for (const gpu::SkyPatchRecord& cell : tile.skyPatches.first(skyCellCount(tile.skyPatches)))
        radiance.push_back({float(3.0 * dhi / (7.0 * 3.14159265358979) * (1.0 + 2.0 * double(cell.direction.z))), {}});
    return radiance;
}

TestImage renderScreen(const Screen& screen)
{
    Renderer& renderer = testRenderer(screen.pack);
    renderer.setSun(screen.sunAzimuth, screen.sunElevation, screen.dni);
    renderer.setSky(screen.dhi, screen.dni > 0.0 ? std::vector<CellRadiance>{}
                                                 : overcast(testPack(screen.pack).tile(), screen.dhi));
    const Camera camera = parseCamera(screen.camera, testPack(screen.pack)).value();
    const Picture picture = renderer.render(camera, kWidth, kHeight, screen.view);
    TestImage image = makeTestImage(kWidth, kHeight, 0);
    const bool linear = std::filesystem::path(screen.file).extension() == ".exr";
    for (size_t pixel = 0; pixel < picture.values.size(); ++pixel)
        for (int channel = 0; channel < 3; ++channel)
            image.rgb[3 * pixel + size_t(channel)] =
                linear ? picture.values[pixel][channel] : float(picture.display[4 * pixel + size_t(channel)]);
    return image;
}

std::string testName(const testing::TestParamInfo<Screen>& info)
{
    return std::filesystem::path(info.param.file).stem().string();
}

class Golden : public testing::TestWithParam<Screen>
{
};

TEST_P(Golden, Matches)
{
    const Screen& screen = GetParam();
    EXPECT_TRUE(matchesGolden(goldenFolders(), screen.file, renderScreen(screen), screen.tolerance));
}
INSTANTIATE_TEST_SUITE_P(Screens, Golden, testing::ValuesIn(kScreens), testName);

TEST(Goldens, EveryGoldenHasAScreen)
{
    std::set<std::string> rendered, stored;
    for (const Screen& screen : kScreens) EXPECT_TRUE(rendered.insert(screen.file).second) << screen.file << " twice";
    std::error_code failure; // a missing folder has no golden
    for (const auto& entry : std::filesystem::directory_iterator(goldenFolders().goldens, failure))
        stored.insert(entry.path().filename().string());
    EXPECT_EQ(stored, rendered) << "a golden without a screen is deleted, a screen without a golden gets one";
}

/// What a test would do that renders `image` for the golden of city_final.png; its outputs go to a folder of their own.
void checkAgainstFinal(const TestImage& image)
{
    GoldenFolders folders = goldenFolders();
    folders.out = std::filesystem::path(testing::TempDir()) / "expect_fail";
    EXPECT_TRUE(matchesGolden(folders, "city_final.png", image, kDisplayTolerance));
}

TEST(Goldens, CheckerFailsOnAWrongPicture)
{
    const TestImage golden = readTestImage(goldenFolders().goldens / "city_final.png").value();
    checkAgainstFinal(golden); // itself it accepts

    // One pixel in a thousand of 57 600 is 57: a patch of 58 pixels that are 6 steps off is one too many.
    static TestImage wrong;
    wrong = golden;
    for (u32 pixel = 0; pixel < 58; ++pixel) {
        float* rgb = wrong.at(pixel + 100, 90);
        rgb[1] += rgb[1] > 128 ? -6.0f : 6.0f;
    }
    EXPECT_NONFATAL_FAILURE(checkAgainstFinal(wrong), "city_final.png differs from its golden");

    // Everything one step brighter: no pixel is over the limit, but the mean is.
    for (float& value : wrong.rgb) value = value < 255 ? value + 1 : value;
    EXPECT_NONFATAL_FAILURE(checkAgainstFinal(wrong), "mean difference");
}

TEST(Goldens, CheckerFailsOnTheShadowsOfAnotherSun)
{
    const auto final =
        std::find_if(kScreens.begin(), kScreens.end(), [](const Screen& s) { return s.file == "city_final.png"; });
    ASSERT_NE(final, kScreens.end());
    Screen screen = *final;
    screen.sunAzimuth += 2; // the shadows move by some decimetres
    static TestImage wrong;
    wrong = renderScreen(screen);
    EXPECT_NONFATAL_FAILURE(checkAgainstFinal(wrong), "city_final.png differs from its golden");
}

TEST(Goldens, CheckerFailsWithoutAGolden)
{
    const auto check = [] {
        GoldenFolders folders{"no such folder", std::filesystem::path(testing::TempDir()) / "expect_fail"};
        EXPECT_TRUE(matchesGolden(folders, "nothing.png", makeTestImage(4, 4, 0), kDisplayTolerance));
    };
    EXPECT_NONFATAL_FAILURE(check(), "there is no golden for this picture");
}

} // namespace
} // namespace helio
