// SPDX-License-Identifier: Apache-2.0
// The whole path, as a user runs it: bake a scene given as polygons, render its table, compare with the reference path
// tracer (tests/data/scenes/README.md). Writes the rows of the README's table.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "city/light/error_metrics.h"
#include "tests/accuracy/csv_table.h"

using namespace helio;
using namespace helio::test;

namespace {

const char* const kChannels[] = {"r", "g", "b"};

struct Case
{
    std::string scene, sun; // sun as AZIMUTH,ELEVATION
    double dni = 800.0, dhi = 120.0;
};

/// Bakes and renders; gives the per-face table.
CsvTable runTools(const Case& c)
{
    const auto folder =
        std::filesystem::temp_directory_path() / ("heliopolis_accuracy_" + c.scene + std::to_string(getpid()));
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const std::string bin = HELIO_BIN_DIR, scene = std::string(HELIO_TEST_DATA) + "/scenes/" + c.scene;
    const std::string pack = (folder / "pack").string(), table = (folder / "table.csv").string();
    const std::string bake = bin + "/heliopolis-bake " + scene + ".obj --surfaces " + scene + ".csv -o " + pack + " >" +
                             (folder / "bake.txt").string();
    EXPECT_EQ(std::system(bake.c_str()), 0) << bake;
    const std::string render = bin + "/heliopolis-render " + pack + " --sun " + c.sun + " --dni " +
                               std::to_string(c.dni) + " --dhi " + std::to_string(c.dhi) + " --table " + table +
                               " --per face >" + (folder / "render.txt").string();
    EXPECT_EQ(std::system(render.c_str()), 0) << render;
    const CsvTable result = readCsvTable(table);
    std::filesystem::remove_all(folder);
    return result;
}

using ColumnOf = std::function<std::vector<double>(const std::string& channel)>;

std::vector<double> sum(const std::vector<double>& a, const std::vector<double>& b)
{
    std::vector<double> out(a);
    for (size_t i = 0; i < out.size() && i < b.size(); ++i) out[i] += b[i];
    return out;
}

std::vector<double> scaled(std::vector<double> values, double factor)
{
    for (double& v : values) v *= factor;
    return values;
}

/// Errors of one quantity, averaged over the three colours, as one row of the table.
ErrorMetrics judge(const std::string& scene, const std::string& quantity, const CsvTable& table,
                   const std::vector<double>& area, const ColumnOf& reference, const std::vector<double>& se,
                   const std::vector<bool>& keep)
{
    ErrorMetrics mean;
    for (const char* channel : kChannels) {
        const ErrorMetrics m = compare(area, table.column(quantity + "_" + channel), reference(channel), se, keep);
        mean.rms += m.rms / 3.0;
        mean.bias += m.bias / 3.0;
        mean.p95 += m.p95 / 3.0;
    }
    std::printf("| %s | %s | %.2f | %+.2f | %.2f |\n", scene.c_str(), quantity.c_str(), 100.0 * mean.rms,
                100.0 * mean.bias, 100.0 * mean.p95);
    return mean;
}

constexpr double kPi = 3.14159265358979323846;
constexpr double kSkyRadiance = 120.0 / kPi; // W/m2/sr, of the scenes' uniform sky

/// Every light on. `emitters`: the reference has columns of emitted light.
void judgeSunAndSky(const Case& c, bool emitters,
                    const std::function<bool(const CsvTable& scene, size_t row)>& measured)
{
    const CsvTable table = runTools(c);
    const std::string base = std::string(HELIO_TEST_DATA) + "/scenes/" + c.scene;
    const CsvTable reference = readCsvTable(base + ".reference.csv"), scene = readCsvTable(base + ".csv");
    ASSERT_EQ(table.rows, reference.rows);
    const std::vector<double>& area = reference.column("area");
    std::vector<bool> keep;
    for (size_t i = 0; i < reference.rows; ++i) keep.push_back(measured(scene, i));
    const ErrorMetrics sun = judge(
        c.scene, "E_sun", table, area, [&](const std::string& ch) { return reference.column("sun_dir_" + ch); },
        reference.column("sun_dir_se_g"), keep);
    const ErrorMetrics sky = judge(
        c.scene, "E_sky", table, area,
        [&](const std::string&) { return scaled(reference.column("svf"), kPi * kSkyRadiance); },
        scaled(reference.column("svf_se"), kPi * kSkyRadiance), keep);
    // Parts of E_indirect in the reference; only the green channel's standard errors are known, and serve all three.
    std::vector<std::string> parts{"sun_ind_", "sky_ind_"};
    if (emitters) parts.insert(parts.end(), {"em_dir_", "em_ind_"});
    std::vector<double> se(reference.rows, 0.0);
    for (const std::string& part : parts) {
        const std::vector<double> own = reference.column(part + "se_g");
        for (size_t i = 0; i < se.size(); ++i) se[i] = std::hypot(se[i], own[i]);
    }
    const ErrorMetrics indirect = judge(
        c.scene, "E_indirect", table, area,
        [&](const std::string& ch) {
            std::vector<double> total(reference.rows, 0.0);
            for (const std::string& part : parts) total = sum(total, reference.column(part + ch));
            return total;
        },
        se, keep);
    EXPECT_LE(sun.rms, 0.01);
    EXPECT_LE(sky.rms, 0.02);
    EXPECT_LE(indirect.rms, 0.015);
    EXPECT_LE(std::abs(indirect.bias), 0.003);
}

} // namespace

TEST(Accuracy, MetricsByHand)
{
    // Two faces of area 1 and 3: errors +1 and -1, mean of the reference (10 + 3 * 20) / 4 = 17.5.
    const ErrorMetrics m = compare({1, 3, 5}, {11, 19, 99}, {10, 20, 0}, {0, 0, 0}, {true, true, false});
    EXPECT_NEAR(m.rms, 1.0 / 17.5, 1e-12);
    EXPECT_NEAR(m.bias, -0.5 / 17.5, 1e-12);
    EXPECT_NEAR(m.p95, 1.0 / 17.5, 1e-12);
    EXPECT_NEAR(compare({1}, {11}, {10}, {1}, {true}).rms, 0.0, 1e-12);
    // What is not a number is never a good result.
    EXPECT_FALSE(compare({1}, {std::nan("")}, {10}, {0}, {true}).rms <= 1.0);
    EXPECT_FALSE(compare({1}, {}, {10}, {0}, {true}).rms <= 1.0);
}

TEST(Accuracy, GridCityOfFourBuildings)
{
    judgeSunAndSky({.scene = "S", .sun = "150,40"}, false, [](const CsvTable&, size_t) { return true; });
}

TEST(Accuracy, StreetCanyon)
{
    // The ends of the canyon see the sky; its middle part is what is judged.
    judgeSunAndSky({.scene = "canyon", .sun = "120,50"}, false,
                   [](const CsvTable& scene, size_t row) { return scene.column("bay")[row] == 1.0; });
}

TEST(Accuracy, TwoFacingBoxesUnderSunAndSky)
{
    judgeSunAndSky({.scene = "twobox", .sun = "150,40"}, true, [](const CsvTable&, size_t) { return true; });
}

TEST(Accuracy, FurnaceAgainstItsClosedForm)
{
    // A closed box of emission 1 W/m2: B = 1 / (1 - rho), and E_indirect = (B - 1) / rho.
    const CsvTable table = runTools({.scene = "furnace", .sun = "150,40"});
    const CsvTable scene = readCsvTable(std::string(HELIO_TEST_DATA) + "/scenes/furnace.csv");
    ASSERT_EQ(table.rows, scene.rows);
    ASSERT_GT(table.rows, 0u);
    double worst = 0.0;
    for (const char* channel : kChannels)
        for (size_t i = 0; i < table.rows; ++i) {
            const double rho = scene.column(std::string("rho_") + channel)[i];
            const double error = std::abs(table.column(std::string("B_") + channel)[i] * (1.0 - rho) - 1.0);
            worst = error <= worst ? worst : error; // keeps a NaN
            EXPECT_EQ(table.column(std::string("E_sun_") + channel)[i], 0.0) << "sun inside the closed box, face " << i;
        }
    std::printf("| furnace | B (largest error) | %.3f | | |\n", 100.0 * worst);
    // The light that arrives is (B - 1) / rho = 1 / (1 - rho).
    const std::vector<double> zero(table.rows, 0.0);
    const ErrorMetrics indirect = judge(
        "furnace", "E_indirect", table, table.column("area"),
        [&](const std::string& channel) {
            std::vector<double> closed;
            for (const double rho : scene.column("rho_" + channel)) closed.push_back(1.0 / (1.0 - rho));
            return closed;
        },
        zero, std::vector<bool>(table.rows, true));
    EXPECT_LE(indirect.rms, 1e-3);
    EXPECT_EQ(table.column("E_sky_solar"), zero);
    EXPECT_LE(worst, 1e-3);
}

TEST(Accuracy, TwoFacingBoxesWithOneEmitter)
{
    const CsvTable table = runTools({.scene = "twobox", .sun = "150,40", .dni = 0.0, .dhi = 0.0});
    const CsvTable reference = readCsvTable(std::string(HELIO_TEST_DATA) + "/scenes/twobox.reference.csv");
    ASSERT_EQ(table.rows, reference.rows);
    std::vector<double> se = reference.column("em_dir_se_g");
    for (size_t i = 0; i < se.size(); ++i) se[i] = std::hypot(se[i], reference.column("em_ind_se_g")[i]);
    const ErrorMetrics m = judge(
        "twobox", "E_indirect", table, reference.column("area"),
        [&](const std::string& ch) { return sum(reference.column("em_dir_" + ch), reference.column("em_ind_" + ch)); },
        se, std::vector<bool>(reference.rows, true));
    EXPECT_LE(std::abs(m.bias), 0.01);
}
