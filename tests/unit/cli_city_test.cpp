// SPDX-License-Identifier: Apache-2.0
// heliopolis-bake over footprints and rules, without light: what a user sees of the grammar and of the import.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "city/base/file.h"
#include "tests/unit/cli_runner.h"
#include "tests/unit/pack_temp_folder.h"

namespace helio::test {
namespace {

constexpr const char* kRules = HELIO_TEST_DATA_DIR "/rules/";

class CityCli : public testing::Test
{
protected:
    void put(const std::string& name, const std::string& text) { std::ofstream(temp_ / name) << text; }
    RunResult bake(const std::string& arguments) { return runProgram(HELIO_BAKE, arguments, temp_.path()); }

    /// A lot of w x d m whose first edge is the one of w m.
    void putLot(const std::string& name, double w, double d, double height)
    {
        put(name,
            concat(R"({"type":"FeatureCollection","features":[{"type":"Feature","id":"lot","properties":{"height":)",
                   height, R"(},"geometry":{"type":"Polygon","coordinates":[[[0,0],[)", w, ",0],[", w, ",", d, "],[0,",
                   d, R"(],[0,0]]]}}]})"));
    }

    nlohmann::json stats(const std::string& arguments)
    {
        const RunResult result = bake(arguments + " --tree-only --stats s.json");
        EXPECT_EQ(result.exitCode, 0) << result.err;
        const auto text = readTextFile(temp_ / "s.json");
        return nlohmann::json::parse(text.ok() ? *text : "{}");
    }

    TempFolder temp_;
};

// The counts are worked out in grammar_reference_rules_test.cpp.
TEST_F(CityCli, ReportsOfTheRulesAreInTheStatistics)
{
    putLot("narrow.geojson", 14, 18, 21);
    putLot("wide.geojson", 18, 14, 21);
    const std::string haussmann = concat(" --rules ", kRules, "haussmann_midrise.cga");
    EXPECT_EQ(stats("narrow.geojson --front first" + haussmann)["report"]["windows"], 109);
    EXPECT_EQ(stats("wide.geojson --front first" + haussmann)["report"]["windows"], 113);
    EXPECT_EQ(stats("narrow.geojson" + haussmann)["report"]["windows"], 113); // the longest free edge is the front
}

TEST_F(CityCli, TreeOnlyWritesNoPack)
{
    putLot("lot.geojson", 18, 14, 21);
    const RunResult result = bake("lot.geojson --tree-only");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.out.find("report windows"), std::string::npos) << result.out;
    EXPECT_EQ(bake("lot.geojson --tree-only -o p").exitCode, 1);
    EXPECT_FALSE(std::filesystem::exists(temp_ / "p"));
}

TEST_F(CityCli, BaysMakeFewerPatchesOfTheSameArea)
{
    putLot("lot.geojson", 18, 14, 21);
    const auto piece = stats("lot.geojson --set roof=flat"), bay = stats("lot.geojson --set roof=flat --patch bay");
    // Nearly every one of the windows shares a patch with the wall around it.
    EXPECT_GE(piece["patches"].get<double>() - bay["patches"].get<double>(),
              0.8 * piece["report"]["windows"].get<double>());
    EXPECT_EQ(bay["report"], piece["report"]);
}

TEST_F(CityCli, ExplainsRulesAndPointsAtEveryMistake)
{
    const RunResult good = bake(concat("--explain ", kRules, "gabled_rowhouse.cga"));
    EXPECT_EQ(good.exitCode, 0) << good.err;
    for (const char* word : {"pitch", "15 to 60", "Plaster", "GableWall", "Lot"})
        EXPECT_NE(good.out.find(word), std::string::npos) << word;
    EXPECT_EQ(bake("--explain tower.cga").exitCode, 0) << "a shipped file by its name";

    put("bad.cga",
        "Lot --> extrude(9) comp(f) { side : Wall | tip : Roof }\nWall --> wobble(1)\nRoof --> roofHip(30\n");
    const RunResult bad = bake("--explain bad.cga");
    EXPECT_EQ(bad.exitCode, 1);
    for (const char* place : {"bad.cga:1:44: ", "bad.cga:2:10: ", "bad.cga:4:1: "})
        EXPECT_NE(bad.err.find(place), std::string::npos) << place << "\n" << bad.err;
}

TEST_F(CityCli, RefusesBadChoices)
{
    putLot("lot.geojson", 18, 14, 21);
    const auto refuses = [&](const std::string& arguments, const std::string& word) {
        const RunResult result = bake("lot.geojson --tree-only " + arguments);
        EXPECT_EQ(result.exitCode, 1) << arguments;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    };
    refuses("--front back", "--front");
    refuses("--patch wall", "--patch");
    refuses("--bbox 5,0,1,9", "west must be below east");
    refuses("--bbox 100,100,200,200", "lot.geojson");
    refuses("--limit 0", "--limit");
    refuses("--style Neon", "Neon");
    refuses("--streets none.geojson", "none.geojson");
    refuses("--rules none.cga", "none.cga");
    refuses("--set colour=3", "colour");
}

} // namespace
} // namespace helio::test
