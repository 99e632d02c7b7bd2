// SPDX-License-Identifier: Apache-2.0
// The built heliopolis-render and heliopolis-bench, run as a user runs them: bad input gets one line and exit code 1
// and leaves nothing behind; good input gives the pictures and tables that were asked for, twice the same bytes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

#include "city/base/file.h"
#include "city/format/pack.h"
#include "tests/support/image_file.h"
#include "tests/unit/cli_runner.h"

namespace helio {
namespace {

using test::RunResult;
using test::TempFolder;

/// Small picture, coarse sun raster: what is tested here does not depend on either.
const std::string kQuick = "p --size 64x36 --samples 1 --sun-texel 0.25 ";

std::vector<std::string> split(const std::string& text, char separator)
{
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
    return parts;
}

class RenderCli : public testing::Test
{
protected:
    void SetUp() override
    {
        const std::string scene = HELIO_SCENES "/twobox";
        const RunResult baked =
            test::runProgram(HELIO_BAKE, concat(scene, ".obj --surfaces ", scene, ".csv --rays 16 -o p"), temp_.path());
        ASSERT_EQ(baked.exitCode, 0) << baked.err;
    }

    RunResult render(const std::string& arguments) const
    {
        return test::runProgram(HELIO_RENDER, arguments, temp_.path());
    }

    std::string bytesOf(const std::string& name) const
    {
        Result<std::string> text = readTextFile(temp_ / name);
        EXPECT_TRUE(text.ok()) << name;
        return text ? *text : "";
    }

    void put(const std::string& name, const std::string& text) const
    {
        ASSERT_TRUE(writeTextAtomically(temp_ / name, text).ok());
    }

    /// One line that holds `what`, exit code 1, and no file more than before.
    void expectRefusal(const std::string& arguments, const std::string& what,
                       const std::string& program = HELIO_RENDER) const
    {
        const size_t before = temp_.entryCount();
        const RunResult result = test::runProgram(program, arguments, temp_.path());
        EXPECT_EQ(result.exitCode, 1) << arguments;
        EXPECT_EQ(result.errorLines(), 1u) << arguments << ": " << result.err;
        EXPECT_EQ(result.err.rfind("heliopolis-", 0), 0u) << result.err;
        EXPECT_NE(result.err.find(what), std::string::npos) << arguments << ": " << result.err;
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_EQ(temp_.entryCount(), before) << arguments << " left something behind";
    }

    TempFolder temp_;
};

TEST_F(RenderCli, HelpSaysUnitsAndExitsWithZero)
{
    const RunResult result = render("--help");
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err, "");
    for (const char* word :
         {"--sun", "degrees", "--dni", "W/m2", "--residual", "--camera", "--table", "--view", "pixels"})
        EXPECT_NE(result.out.find(word), std::string::npos) << word;
}

TEST_F(RenderCli, WallsAtTheBorderSeeTheGroundBeyond)
{
    // One block on its own: half of what its walls see below the horizon is not modelled, but is not black.
    put("city.geojson", R"({"type":"Polygon","coordinates":[[[0,0],[20,0],[20,20],[0,20],[0,0]]]})");
    put("block.cga",
        "Lot --> extrude(30) comp(f) { side : Wall | top : Roof }\nWall --> split(y) { ~5 : Storey }*\n"
        "Storey --> split(x) { ~5 : Bay }*\nBay --> color(0.5, 0.5, 0.5)\nRoof --> color(0.5, 0.5, 0.5)\n");
    const RunResult baked =
        test::runProgram(HELIO_BAKE, "city.geojson --rules block.cga --sky-patches 1 -o c", temp_.path());
    ASSERT_EQ(baked.exitCode, 0) << baked.err;
    const std::string light = " --sun 150,40 --dni 800 --dhi 120 ";
    ASSERT_EQ(render("c --sun-texel 0.1 --table t.csv" + light).exitCode, 0);
    ASSERT_EQ(test::runProgram(HELIO_BAKE, "reference c --spp 1024 -o r.csv" + light, temp_.path()).exitCode, 0);
    const RunResult compared = test::runProgram(HELIO_BAKE, "compare t.csv r.csv --json", temp_.path());
    ASSERT_EQ(compared.exitCode, 0) << compared.err;
    bool found = false;
    for (const auto& row : nlohmann::json::parse(compared.out)) {
        if (row["quantity"] != "E_sky" || row["channels"] != "solar") continue;
        found = true;
        EXPECT_LT(row["rms"].get<double>(), 0.01);
        EXPECT_LT(std::abs(row["bias"].get<double>()), 3e-3);
    }
    EXPECT_TRUE(found) << compared.out;
    // Half of the sky, and what lies beyond 30 m of street in the sun and under the sky: more the higher the wall.
    double highest = 0.0;
    for (const std::string& line : split(bytesOf("t.csv"), '\n')) {
        const std::vector<std::string> cells = split(line, ',');
        if (cells.size() > 10 && cells[1] == "0" && std::stod(cells[2]) < 30.0)
            highest = std::max(highest, std::stod(cells[10]));
    }
    const double onGround = 120.0 + 800.0 * std::sin(40.0 * 3.14159265 / 180.0);
    EXPECT_GT(highest, 60.0 + 0.12 * onGround * 0.2);
    EXPECT_LT(highest, 60.0 + 0.12 * onGround * 0.5);
}

TEST_F(RenderCli, SunByDateAndSkyByModel)
{
    const std::string scene = HELIO_SCENES "/twobox";
    const auto bake = [&](const std::string& more) {
        const std::string line = concat(scene, ".obj --surfaces ", scene, ".csv --rays 1024 ", more);
        EXPECT_EQ(test::runProgram(HELIO_BAKE, line, temp_.path()).exitCode, 0) << more;
    };
    bake("--lat 39.742476 --lon -105.1786 -o here");
    bake("--sky-patches 1 -o plain");
    const std::string quick = " --size 64x36 --samples 1 --sun-texel 0.25 ";

    // The place and time of the solar position algorithm's test vector; the air is not, which moves the elevation.
    const RunResult dated = render("here --date 2003-10-17 --time 12:30:30 --utc-offset -7 --sky perez --turbidity 3 "
                                   "--sun-texel 0.25 --table dated.csv");
    ASSERT_EQ(dated.exitCode, 0) << dated.err;
    EXPECT_NE(bytesOf("dated.csv").find("azimuth 194.34 elevation 39.89"), std::string::npos);
    EXPECT_NE(bytesOf("dated.csv").find("Perez sky"), std::string::npos);

    // One uniform sky, whatever the dome; another sky only where the pack can tell its parts.
    const auto sky = [&](const std::string& pack, const std::string& model) {
        const RunResult run = render(concat(pack, quick, "--dni 0 --dhi 100 --sky ", model, " --table t.csv"));
        EXPECT_EQ(run.exitCode, 0) << run.err;
        std::vector<double> values;
        const std::vector<std::string> lines = split(bytesOf("t.csv"), '\n');
        const std::vector<std::string> header = lines.size() > 2 ? split(lines[1], ',') : std::vector<std::string>{};
        const size_t column = size_t(std::find(header.begin(), header.end(), "E_sky_solar") - header.begin());
        for (size_t i = 2; i < lines.size() && column < header.size(); ++i)
            values.push_back(std::stod(split(lines[i], ',')[column]));
        return values;
    };
    const std::vector<double> parts = sky("here", "uniform"), whole = sky("plain", "uniform");
    const std::vector<double> overcast = sky("here", "cie:16");
    ASSERT_EQ(parts.size(), whole.size());
    ASSERT_EQ(parts.size(), overcast.size());
    ASSERT_FALSE(parts.empty());
    double brighter = 0.0, darker = 0.0;
    for (size_t i = 0; i < parts.size(); ++i) {
        EXPECT_NEAR(parts[i], whole[i], 3e-4);
        brighter = std::max(brighter, overcast[i] - parts[i]);
        darker = std::max(darker, parts[i] - overcast[i]);
    }
    EXPECT_GT(darker, 5.0) << "walls see the dark part of an overcast sky";
    EXPECT_LT(brighter, 10.0);
    expectRefusal(concat("plain --sky cie:16", quick, "-o a.png"), "bake it with --sky-patches");
}

TEST_F(RenderCli, RefusesBadUsage)
{
    expectRefusal("p -o a.png --date 2026-06-21", "--time");
    expectRefusal("p -o a.png --time 12:00", "--date");
    expectRefusal("p -o a.png --date 2026-06-31 --time 12:00", "2026-06-31");
    expectRefusal("p -o a.png --date 2026-06-21 --time 12:00 --sun 1,2", "--sun");
    expectRefusal("p -o a.png --date 2026-06-21 --time 12:00 --turbidity 3 --dni 5", "--dni");
    expectRefusal("p -o a.png --turbidity 3", "--date");
    expectRefusal("p -o a.png --sky cie:17", "cie:17");
    expectRefusal("", "PACK");
    expectRefusal("p", "nothing to do");
    expectRefusal("p -o a.png --wobble", "--wobble");
    expectRefusal("p more -o a.png", "more");
    for (const char* sun : {"180", "180,91", "south,45", "180,45,3", "nan,45", "180,inf", "361,45", ""})
        expectRefusal(concat("p -o a.png --sun '", sun, "'"), "--sun");
    for (const char* size : {"64", "0x36", "64x-1", "64x36x3", "99999x36", "axb"})
        expectRefusal(concat("p -o a.png --size ", size), "--size");
    for (const char* camera : {"bird", "1,2,3", "1,2,3,4,5", "1,2,3,1,2,3", "0,0,1,0,1,1,180", "0,0,nan,0,1,1"})
        expectRefusal(concat("p -o a.png --camera ", camera), camera);
    for (const char* option : {"--view x-ray", "--sky cloudy", "--per house", "--samples 5", "--dni -1", "--dhi nan",
                               "--dni nan", "--residual nan", "--exposure nan", "--sun-texel nan", "--dhi inf",
                               "--residual 0", "--sun-texel -1", "--exposure 99", "--size", "-o b.png -o c.png"})
        expectRefusal(concat("p -o a.png ", option), split(option, ' ')[0]);
    for (const char* sweeps : {"0", "-1", "two", "2.5"})
        expectRefusal(concat("p --table t.csv --iterations ", sweeps), "--iterations");
    expectRefusal("p --table t.csv --iterations 2 --residual 0.1", "--residual");
}

TEST_F(RenderCli, RefusesWhatIsNotAPack)
{
    expectRefusal("none -o a.png", "none");
    std::filesystem::create_directory(temp_ / "empty");
    expectRefusal("empty -o a.png", "empty");
    put("file", "hello\n");
    expectRefusal("file -o a.png", "file");
}

TEST_F(RenderCli, RefusesDamagedPacks)
{
    const std::string index = bytesOf("p/index"), tile = bytesOf("p/tile-0000");
    std::string flipped = tile, version = tile, indexVersion = index;
    flipped[tile.size() / 2] = char(flipped[tile.size() / 2] ^ 4);
    version[8] = 9;
    indexVersion[indexVersion.find(concat(kPackVersion, "\n"))] = '9';
    struct Damage
    {
        std::string index, tile;
        const char* what;
    };
    std::filesystem::create_directory(temp_ / "q");
    for (const Damage& damage :
         {Damage{index, tile.substr(0, tile.size() - 1), "its header says"},
          Damage{index, tile.substr(0, 40), "ends inside the header"}, Damage{index, "", "tile-0000"},
          Damage{index, flipped, "the checksum"}, Damage{index, version, "version 9"},
          Damage{indexVersion, tile, "version 9"}, Damage{index.substr(0, 99), tile, "checksum line"},
          Damage{"{}", tile, "this is not the index"}}) {
        put("q/index", damage.index);
        put("q/tile-0000", damage.tile);
        expectRefusal("q -o a.png --table t.csv", damage.what);
    }
}

TEST_F(RenderCli, RefusesFacesWhereThereAreNone)
{
    put("town.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"height":9},
        "geometry":{"type":"Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,9],[0,0]]]}}]})");
    const RunResult baked = test::runProgram(HELIO_BAKE, "town.geojson --rays 16 -o town", temp_.path());
    ASSERT_EQ(baked.exitCode, 0) << baked.err;
    expectRefusal("town --per face --table t.csv", "--per patch");
}

TEST_F(RenderCli, RefusesPlacesWhereNothingCanBeWritten)
{
    for (const char* target : {"none/a", "p", "p/index/a"})
        for (const char* option : {"-o", "--exr", "--table"})
            expectRefusal(concat(kQuick, option, " ", target), concat(target, ": cannot be written"));
    expectRefusal(kQuick + "-o a.png --exr a.exr --table none/t.csv", "none/t.csv");
}

TEST_F(RenderCli, AFileThatGrowsTooLargeLeavesNothing)
{
    const size_t before = temp_.entryCount();
    const RunResult result = test::runProgram(
        "/bin/bash", concat("-c 'ulimit -f 1; exec \"" HELIO_RENDER "\" ", kQuick, "--table t.csv'"), temp_.path());
    EXPECT_EQ(result.exitCode, 1) << result.err;
    EXPECT_EQ(result.errorLines(), 1u) << result.err;
    EXPECT_NE(result.err.find("t.csv: cannot be written: File too large"), std::string::npos) << result.err;
    EXPECT_EQ(temp_.entryCount(), before);
}

TEST_F(RenderCli, WritesPicturesOfTheSizeAskedFor)
{
    const RunResult result = render(kQuick + "-o a.png --exr a.exr");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(temp_.entryCount(), 3u) << "pack and two pictures";
    for (const char* name : {"a.png", "a.exr"}) {
        const Result<TestImage> image = readTestImage(temp_ / name);
        ASSERT_TRUE(image.ok()) << image.error().message;
        EXPECT_EQ(image->width, 64u);
        EXPECT_EQ(image->height, 36u);
        const auto [low, high] = std::minmax_element(image->rgb.begin(), image->rgb.end());
        EXPECT_LT(*low, *high) << name << " is of one colour";
    }
}

TEST_F(RenderCli, APackWithoutExpectedErrorsShowsNone)
{
    const std::string scene = HELIO_SCENES "/twobox";
    ASSERT_EQ(test::runProgram(HELIO_BAKE,
                               concat(scene, ".obj --surfaces ", scene, ".csv --rays 16 --method paper -o paper"),
                               temp_.path())
                  .exitCode,
              0);
    expectRefusal("paper --view error -o e.png", "paper: the pack says nothing of errors");
    ASSERT_EQ(render("paper --size 64x36 --samples 1 --sun-texel 0.25 --table t.csv").exitCode, 0);
    EXPECT_EQ(bytesOf("t.csv").find("E_indirect_error"), std::string::npos);
}

TEST_F(RenderCli, TableHasARowAPatch)
{
    // Enough sweeps that E_indirect and B belong to the same solution.
    const RunResult result = render(kQuick + "--iterations 40 --table t.csv --dni 700 --dhi 90");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(temp_.entryCount(), 2u);
    const Result<Pack> pack = Pack::open(temp_ / "p");
    ASSERT_TRUE(pack.ok());
    const std::vector<std::string> lines = split(bytesOf("t.csv"), '\n');
    ASSERT_EQ(lines.size(), 2u + pack->patchCount());
    EXPECT_EQ(lines[0].rfind("# ", 0), 0u);
    for (const char* word : {"m2", "W/m2", "residual ", "after 40 sweeps", "DNI 700", "DHI 90"})
        EXPECT_NE(lines[0].find(word), std::string::npos) << word << " in " << lines[0];
    EXPECT_EQ(lines[1], "patch,building,area,E_sun_r,E_sun_g,E_sun_b,E_sun_solar,E_sky_r,E_sky_g,E_sky_b,E_sky_solar,"
                        "E_indirect_r,E_indirect_g,E_indirect_b,E_indirect_solar,B_r,B_g,B_b,B_solar,E_indirect_error");
    double largestIndirect = 0.0;
    for (u32 i = 0; i < pack->patchCount(); ++i) {
        const std::vector<std::string> fields = split(lines[2 + i], ',');
        ASSERT_EQ(fields.size(), 20u) << lines[2 + i];
        const gpu::PatchRecord& patch = pack->tile().patches[i];
        EXPECT_EQ(fields[0], std::to_string(i));
        EXPECT_EQ(std::stol(fields[1]), patch.building == gpu::kNone ? -1 : long(patch.building));
        EXPECT_EQ(std::stof(fields[2]), patch.area);
        EXPECT_GT(std::stod(fields[19]), 0.0);
        for (u32 c = 0; c < 4; ++c) {
            const auto at = [&](u32 quantity) { return std::stod(fields[3 + 4 * quantity + c]); };
            EXPECT_LE(at(0), 700.0 * (1 + 1e-6)) << "no patch gets more than the sun sends";
            EXPECT_LE(at(1), 90.0 * (1 + 1e-6)) << "nor more than the open sky";
            // B = emission + rho E, the definition of radiosity.
            const double b = double(patch.emission[int(c)]) + double(patch.rho[int(c)]) * (at(0) + at(1) + at(2));
            EXPECT_NEAR(at(3), b, 1e-4 * (1.0 + b)) << "patch " << i << " channel " << c;
            largestIndirect = std::max(largestIndirect, at(2));
        }
    }
    EXPECT_GT(largestIndirect, 1.0);
}

TEST_F(RenderCli, TableHasARowAFace)
{
    ASSERT_EQ(render(kQuick + "--per face --table t.csv").exitCode, 0);
    const std::vector<std::string> lines = split(bytesOf("t.csv"), '\n');
    // twobox.csv has a header and one line a face.
    const size_t faces = split(*readTextFile(HELIO_SCENES "/twobox.csv"), '\n').size() - 1;
    ASSERT_EQ(lines.size(), 2 + faces);
    EXPECT_EQ(lines[1].rfind("face,building,area,E_sun_r,", 0), 0u) << lines[1];
}

TEST_F(RenderCli, TwoRunsGiveTheSameBytes)
{
    ASSERT_EQ(render(kQuick + "-o a.png --exr a.exr --table a.csv").exitCode, 0);
    ASSERT_EQ(render(kQuick + "-o b.png --exr b.exr --table b.csv").exitCode, 0);
    for (const char* type : {".png", ".exr", ".csv"})
        EXPECT_TRUE(bytesOf(concat("a", type)) == bytesOf(concat("b", type))) << type;
    ASSERT_EQ(render(kQuick + "-o c.png --table c.csv --sun 120,30").exitCode, 0);
    for (const char* type : {".png", ".csv"})
        EXPECT_FALSE(bytesOf(concat("a", type)) == bytesOf(concat("c", type))) << type;
}

TEST_F(RenderCli, PrintsBoundAndEnergyBalance)
{
    const RunResult result = render("p --sun-texel 0.25 --table a.csv");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    double solar = -1.0, number = -1.0;
    const char* bound = std::strstr(result.out.c_str(), "further from the links' solution than ");
    ASSERT_NE(bound, nullptr) << result.out;
    ASSERT_EQ(std::sscanf(bound, "further from the links' solution than %lf W/m2", &solar), 1);
    EXPECT_GT(solar, 0.0);
    EXPECT_LT(solar, 1.0);
    const char* contraction = std::strstr(bound, "contraction number ");
    ASSERT_NE(contraction, nullptr);
    ASSERT_EQ(std::sscanf(contraction, "contraction number %lf", &number), 1);
    EXPECT_GT(number, 0.0);
    EXPECT_LT(number, 1.0);

    // The figures add up to what comes in.
    const char* energy = std::strstr(result.out.c_str(), "Energy (solar)");
    ASSERT_NE(energy, nullptr) << result.out;
    double in, sun, sky, emitters, absorbed, toSky, away, missing;
    ASSERT_EQ(
        std::sscanf(energy,
                    "Energy (solar): in %lf W = sun %lf %% + sky %lf %% + emitters %lf %%; absorbed %lf %%, out to "
                    "the sky %lf %%, out of the scene %lf %%; unexplained %lf %%",
                    &in, &sun, &sky, &emitters, &absorbed, &toSky, &away, &missing),
        8)
        << energy;
    EXPECT_NEAR(sun + sky + emitters, 100.0, 0.02);
    EXPECT_NEAR(absorbed + toSky + away + missing, 100.0, 0.03);
    EXPECT_LT(std::abs(missing), 0.1);
    for (const double share : {sun, sky, absorbed, toSky, away}) EXPECT_GT(share, 1.0);
    EXPECT_EQ(result.out.find("Note:"), std::string::npos);
}

TEST_F(RenderCli, FirstLightOfATableStandsInPlaceOfTheRaster)
{
    const auto afterComment = [&](const std::string& name) {
        const std::string text = bytesOf(name);
        return text.substr(text.find('\n') + 1);
    };
    ASSERT_EQ(render("p --sun 120,35 --sun-texel 0.25 --table a.csv").exitCode, 0);
    const RunResult again = render("p --sun 300,10 --dni 1 --first-light a.csv --table b.csv");
    ASSERT_EQ(again.exitCode, 0) << again.err;
    EXPECT_EQ(again.out.find("Sun raster"), std::string::npos) << again.out;
    EXPECT_EQ(afterComment("a.csv"), afterComment("b.csv")) << "the same first light, the same links";
    EXPECT_NE(bytesOf("b.csv").find("first light of a.csv"), std::string::npos);

    // Twice the first light and no emitters: twice the light.
    const std::vector<std::string> lines = split(afterComment("a.csv"), '\n');
    std::string twice = lines[0] + "\n";
    for (size_t i = 1; i < lines.size(); ++i) {
        const std::vector<std::string> cells = split(lines[i], ',');
        for (size_t k = 0; k < cells.size(); ++k)
            twice += concat(k > 0 ? "," : "", k >= 3 && k < 11 ? std::to_string(2.0 * std::stod(cells[k])) : cells[k]);
        twice += "\n";
    }
    put("twice.csv", twice);
    ASSERT_EQ(render("p --no-emission --first-light a.csv --table one.csv").exitCode, 0);
    ASSERT_EQ(render("p --no-emission --first-light twice.csv --table two.csv").exitCode, 0);
    const std::vector<std::string> one = split(afterComment("one.csv"), '\n'),
                                   two = split(afterComment("two.csv"), '\n');
    ASSERT_EQ(one.size(), two.size());
    for (size_t i = 1; i < one.size(); ++i) {
        const double single = std::stod(split(one[i], ',').back()), doubled = std::stod(split(two[i], ',').back());
        EXPECT_NEAR(doubled, 2.0 * single, 1e-4 * single + 1e-5);
    }

    // Bad tables: one line, nothing written.
    const std::string header = lines[0] + "\n";
    put("short.csv", header + lines[1] + "\n");
    expectRefusal("p --first-light short.csv --table t.csv", "short.csv: 1 rows, but the pack has");
    put("empty.csv", "");
    expectRefusal("p --first-light empty.csv --table t.csv", "empty.csv: no header line");
    expectRefusal("p --first-light none.csv --table t.csv", "none.csv");
    std::string text = afterComment("a.csv");
    put("column.csv", "x" + text);
    expectRefusal("p --first-light column.csv --table t.csv", "no columns patch and area");
    std::string named = text;
    named.replace(named.find("E_sky_b"), 7, "E_sky_x");
    put("named.csv", named);
    expectRefusal("p --first-light named.csv --table t.csv", "no column E_sky_b");
    std::vector<std::string> rows = lines;
    const auto putRows = [&](const char* name) {
        std::string joined;
        for (const std::string& row : rows) joined += row + "\n";
        put(name, joined);
    };
    std::swap(rows[2], rows[3]);
    putRows("order.csv");
    expectRefusal("p --first-light order.csv --table t.csv", "row 1 is patch 2");
    rows = lines;
    std::vector<std::string> cells = split(rows[1], ',');
    const std::string area = cells[2];
    const auto putCells = [&](const char* name) {
        rows[1] = cells[0];
        for (size_t k = 1; k < cells.size(); ++k) rows[1] += "," + cells[k];
        putRows(name);
    };
    cells[2] = concat(1.01 * std::stod(area));
    putCells("area.csv");
    expectRefusal("p --first-light area.csv --table t.csv", "row 0 is patch 0 of");
    cells[2] = area;
    cells[3] = "-1";
    putCells("negative.csv");
    expectRefusal("p --first-light negative.csv --table t.csv", "patch 0: E_sun_r is -1");
    cells[3] = "nan";
    putCells("nan.csv");
    expectRefusal("p --first-light nan.csv --table t.csv", "nan.csv:2: column E_sun_r");
    expectRefusal("p --first-light a.csv -o a.png", "--first-light");
    expectRefusal("p --first-light a.csv", "nothing to do");
}

TEST_F(RenderCli, CameraPath)
{
    put("path.txt", "0 6,-6,4,0,0,1\n1 6,6,4,0,0,1,60\n");
    const std::string quick = "p --size 64x36 --samples 1 --sun-texel 0.25 ";
    const RunResult run = render(quick + "--path path.txt --frames 3 -o a.png --validate");
    ASSERT_EQ(run.exitCode, 0) << run.err;
    for (const char* name : {"a-0000.png", "a-0001.png", "a-0002.png"}) EXPECT_GT(bytesOf(name).size(), 100u) << name;
    EXPECT_NE(bytesOf("a-0000.png"), bytesOf("a-0002.png"));
    EXPECT_NE(run.out.find("Frame 2 at 1.000 s"), std::string::npos) << run.out;
    size_t still = 0;
    for (size_t at = run.out.find(" 0.0 for stages 1 to 3"); at != std::string::npos; ++still)
        at = run.out.find(" 0.0 for stages 1 to 3", at + 1);
    EXPECT_EQ(still, 3u) << "a moving camera costs no work of stages 1 to 3: " << run.out;
    EXPECT_FALSE(std::filesystem::exists(temp_ / "a.png"));
    // The first key, by itself.
    ASSERT_EQ(render(quick + "--camera 6,-6,4,0,0,1 -o b.png").exitCode, 0);
    EXPECT_EQ(bytesOf("a-0000.png"), bytesOf("b.png"));
    ASSERT_EQ(render(quick + "--path path.txt --frames 3 -o sheet.png --sheet").exitCode, 0);
    const Result<TestImage> sheet = readTestImage(temp_ / "sheet.png");
    ASSERT_TRUE(sheet.ok());
    EXPECT_EQ(sheet->width, 128u);
    EXPECT_EQ(sheet->height, 72u);

    expectRefusal(quick + "--path path.txt -o a.png", "--frames");
    expectRefusal(quick + "--path path.txt --frames 2 -o a.png --exr a.exr", "--exr");
    expectRefusal(quick + "--path none.txt --frames 2 -o a.png", "none.txt");
    put("bad.txt", "0 6,-6,4,0,0,1\n0 6,6,4,0,0,1\n");
    expectRefusal(quick + "--path bad.txt --frames 2 -o c.png", "bad.txt: line 2");
    expectRefusal(quick + "--sheet -o a.png", "--sheet");

    ASSERT_EQ(render(quick + "-o a.png --dump-graph g.dot").exitCode, 0);
    const std::string dot = bytesOf("g.dot");
    for (const char* word :
         {"digraph \"sun\"", "digraph \"sweep\"", "digraph \"frame\"", "wait: ", "compute to", "KiB", "forward"})
        EXPECT_NE(dot.find(word), std::string::npos) << word;
}

TEST_F(RenderCli, Day)
{
    const std::string scene = HELIO_SCENES "/twobox";
    ASSERT_EQ(test::runProgram(HELIO_BAKE,
                               concat(scene, ".obj --surfaces ", scene, ".csv --rays 16 --lat 50 --lon 14 -o here"),
                               temp_.path())
                  .exitCode,
              0);
    const std::string quick = "here --size 64x36 --samples 1 --sun-texel 0.25 --turbidity 3 ";
    const RunResult run = render(quick + "--day 2026-12-21 --every 120m --lag -o d.png");
    ASSERT_EQ(run.exitCode, 0) << run.err;
    // In the winter of Prague the sun is up from 7 to 15 UTC.
    for (const char* time : {"08:00", "10:00", "12:00", "14:00"}) {
        const size_t line = run.out.find(concat(time, ": sun azimuth"));
        ASSERT_NE(line, std::string::npos) << run.out;
        const double lag = std::stod(run.out.substr(run.out.find(", lag ", line) + 6));
        EXPECT_LE(lag, 0.5) << "percent, of E_indirect";
    }
    EXPECT_EQ(run.out.find("06:00"), std::string::npos);
    EXPECT_EQ(run.out.find("16:00"), std::string::npos);
    EXPECT_GT(bytesOf("d-1200.png").size(), 100u);
    EXPECT_FALSE(std::filesystem::exists(temp_ / "d.png"));

    expectRefusal(quick + "--day 2026-13-01 -o d.png", "--day");
    expectRefusal(quick + "--day 2026-12-21 --every 10 -o d.png", "--every");
    expectRefusal(quick + "--day 2026-12-21 --table t.csv", "--day");
    expectRefusal("here --turbidity 3 -o d.png", "--date or --day");
}

TEST_F(RenderCli, BenchReports)
{
    const RunResult result = test::runProgram(
        HELIO_BENCH, "p --json r.json --repeats 2 --size 64x36 --sun-texel 0.25 --copy 1", temp_.path());
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const Result<Pack> pack = Pack::open(temp_ / "p");
    ASSERT_TRUE(pack.ok());
    for (const std::string& word :
         {concat("patches: ", pack->patchCount()), concat("links: ", pack->tile().linkColumns.size()),
          std::string("triangles"), std::string("median"), std::string("pack open"), std::string("sun change, cold"),
          std::string("sun raster"), std::string("gather"), std::string("sweep, mean of 16"),
          std::string("camera move"), std::string("GB/s")})
        EXPECT_NE(result.out.find(word), std::string::npos) << word << " in\n" << result.out;
    const nlohmann::json json = nlohmann::json::parse(bytesOf("r.json"), nullptr, false);
    ASSERT_TRUE(json.is_object());
    EXPECT_EQ(json["context"]["patches"], std::to_string(pack->patchCount()));
    EXPECT_TRUE(json["context"].contains("device"));
    EXPECT_GT(json["benchmarks"].size(), 5u);
    for (const auto& entry : json["benchmarks"]) EXPECT_GE(entry["real_time"].get<double>(), 0.0) << entry.dump();
    EXPECT_EQ(temp_.entryCount(), 2u) << "pack and report";
    const RunResult compared = test::runProgram(HELIO_BENCH, "--compare r.json r.json", temp_.path());
    ASSERT_EQ(compared.exitCode, 0) << compared.err;
    EXPECT_NE(compared.out.find("sun change, cold"), std::string::npos) << compared.out;
    EXPECT_NE(compared.out.find(" 1.000"), std::string::npos) << compared.out;
    expectRefusal("--compare r.json none.json", "none.json", HELIO_BENCH);
    expectRefusal("--compare r.json p/index", "p/index", HELIO_BENCH);
    const RunResult kernels =
        test::runProgram(HELIO_BENCH, "--only \"stream copy\" --repeats 2 --copy 1", temp_.path());
    ASSERT_EQ(kernels.exitCode, 0) << kernels.err;
    EXPECT_NE(kernels.out.find("stream copy"), std::string::npos) << kernels.out;
    EXPECT_EQ(kernels.out.find("gather"), std::string::npos) << kernels.out;
    EXPECT_EQ(test::runProgram(HELIO_BENCH, "p --only wobble", temp_.path()).exitCode, 1);

    EXPECT_EQ(test::runProgram(HELIO_BENCH, "--help", temp_.path()).exitCode, 0);
    expectRefusal("none", "none", HELIO_BENCH);
    expectRefusal("p --wobble", "--wobble", HELIO_BENCH);
    expectRefusal("p --json none/r.json", "none/r.json", HELIO_BENCH);
    expectRefusal("p --repeats 0", "--repeats", HELIO_BENCH);
    expectRefusal("p --residual nan", "--residual", HELIO_BENCH);
    expectRefusal("p --size 64", "--size", HELIO_BENCH);
}

} // namespace
} // namespace helio
