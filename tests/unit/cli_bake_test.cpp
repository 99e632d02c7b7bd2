// SPDX-License-Identifier: Apache-2.0
// The built heliopolis-bake, run as a user runs it: bad input gets one line and exit code 1 and leaves nothing behind;
// good input gives the same bytes for any number of threads.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "city/base/file.h"
#include "city/format/pack.h"
#include "city/pack/writer.h"
#include "tests/unit/cli_runner.h"
#include "tests/unit/pack_sample.h"

namespace helio {
namespace {

using test::RunResult;
using test::TempFolder;

/// Two houses of different height on either side of a lane, one with a court, in metres.
constexpr const char* kTown = R"({"type":"FeatureCollection","features":[
{"type":"Feature","id":"east","properties":{"height":14},"geometry":{"type":"Polygon","coordinates":
  [[[0,0],[16,0],[16,20],[0,20],[0,0]],[[5,6],[5,14],[11,14],[11,6],[5,6]]]}},
{"type":"Feature","id":"west","properties":{"levels":3},"geometry":{"type":"Polygon","coordinates":
  [[[-20,0],[-8,0],[-8,12],[-20,13],[-20,0]]]}}]})";

const std::string kScene = HELIO_SCENES "/twobox";

class BakeCli : public testing::Test
{
protected:
    RunResult bake(const std::string& arguments) const { return test::runProgram(HELIO_BAKE, arguments, temp_.path()); }

    void put(const std::string& name, const std::string& text) const
    {
        ASSERT_TRUE(writeTextAtomically(temp_ / name, text).ok());
    }

    std::string bytesOf(const std::string& pack) const
    {
        Result<std::string> index = readTextFile(temp_ / (pack + "/index")),
                            tile = readTextFile(temp_ / (pack + "/tile-0000"));
        EXPECT_TRUE(index.ok() && tile.ok()) << pack;
        return index && tile ? *index + *tile : "";
    }

    /// One line that holds `what`, exit code 1, and no file more than before.
    void expectRefusal(const std::string& arguments, const std::string& what) const
    {
        const size_t before = temp_.entryCount();
        const RunResult result = bake(arguments);
        EXPECT_EQ(result.exitCode, 1) << arguments;
        EXPECT_EQ(result.errorLines(), 1u) << arguments << ": " << result.err;
        EXPECT_EQ(result.err.rfind("heliopolis-bake: ", 0), 0u) << result.err;
        EXPECT_NE(result.err.find(what), std::string::npos) << arguments << ": " << result.err;
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_EQ(temp_.entryCount(), before) << arguments << " left something behind";
    }

    TempFolder temp_;
};

TEST_F(BakeCli, HelpSaysUnitsAndExitsWithZero)
{
    const RunResult result = bake("--help");
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err, "");
    for (const char* word :
         {"--lat", "degrees", "--height", "metres", "--jobs", "--method", "paper-literal", "export", "verify", "info"})
        EXPECT_NE(result.out.find(word), std::string::npos) << word;
    EXPECT_EQ(bake("export --help").exitCode, 0);
}

TEST_F(BakeCli, RefusesBadUsage)
{
    put("town.geojson", kTown);
    expectRefusal("town.geojson", "-o PACK is missing");
    expectRefusal("town.geojson -o p --fast", "--fast");
    expectRefusal("town.geojson -o p --jobs many", "--jobs");
    expectRefusal("town.geojson -o p --jobs 1025", "--jobs");
    expectRefusal("town.geojson -o p --jobs -1", "--jobs");
    expectRefusal("town.geojson -o p --stats missing/s.json", "missing/s.json: cannot be written");
    expectRefusal("town.geojson -o p --stats /", "/: cannot be written");
    expectRefusal("town.geojson -o p --stats town.geojson/s.json", "there is no folder town.geojson");
    expectRefusal("town.geojson -o p --method wrong", "wrong");
    expectRefusal("town.geojson -o p --lat 91", "--lat");
    expectRefusal("town.geojson -o p --height nan", "--height");
    expectRefusal("town.geojson more -o p", "more");
    expectRefusal("info", "PACK is required");
    expectRefusal("export p", "--surfaces is required");
    expectRefusal("town.geojson -o missing/p", "there is no such folder");
    expectRefusal("town.geojson -o town.geojson", "is not a pack; it is not replaced");
    expectRefusal("scene.obj -o p", "needs the CSV");
    expectRefusal("--surfaces scene.csv -o p", "goes with an OBJ file");
}

TEST_F(BakeCli, RefusesBadInput)
{
    expectRefusal("none.geojson -o p", "none.geojson");
    put("text.geojson", "this is not JSON");
    expectRefusal("text.geojson -o p", "text.geojson");
    put("list.geojson", "[1,2,3]");
    expectRefusal("list.geojson -o p", "list.geojson");
    put("cut.geojson", std::string(kTown).substr(0, 200));
    expectRefusal("cut.geojson -o p", "cut.geojson");
    put("deep.geojson", std::string(200000, '['));
    expectRefusal("deep.geojson -o p", "deep.geojson:1: byte 64: nests deeper than 64 levels");
    put("empty.geojson", R"({"type":"FeatureCollection","features":[]})");
    expectRefusal("empty.geojson -o p", "empty.geojson");
    put("scene.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    put("scene.csv",
        "kind,building,facade,floor,bay,rho_r,rho_g,rho_b,emit_r,emit_g,emit_b\nwall,0,0,0,0,.5,.5,.5,0,0,0\n");
    expectRefusal("scene.obj --surfaces scene.csv -o p", "scene.obj:4");
    expectRefusal("scene.obj --surfaces none.csv -o p", "none.csv");
}

TEST_F(BakeCli, RefusesBadRules)
{
    put("town.geojson", kTown);
    expectRefusal("town.geojson --rules none.cga -o p", "none.cga");
    put("bad.cga", "Lot --> extrude(9) Mass\nMass -->\n    wobble(3) Roof\n");
    const RunResult bad = bake("town.geojson --rules bad.cga -o p"); // one mistake: a line, the text, a caret
    EXPECT_EQ(bad.exitCode, 1);
    EXPECT_EQ(bad.errorLines(), 3u) << bad.err;
    EXPECT_EQ(bad.err.rfind("heliopolis-bake: ", 0), 0u) << bad.err;
    EXPECT_NE(bad.err.find("bad.cga:3:5: "), std::string::npos) << bad.err;
    EXPECT_NE(bad.err.find("\n        wobble(3) Roof\n        ^\n"), std::string::npos) << bad.err;
    put("asset.cga", "Lot --> extrude(9) comp(f) { side : Wall | top : Roof }\nWall --> i(\"facade/none.glb\")\n");
    expectRefusal("town.geojson --rules asset.cga -o p", "facade/none.glb");
}

TEST_F(BakeCli, FindsAssetsBesideTheRules)
{
    put("town.geojson", kTown);
    for (const char* folder : {"rules", "rules/assets", "assets"}) std::filesystem::create_directory(temp_ / folder);
    std::filesystem::copy_file(HELIO_ASSETS "/facade/sill.glb", temp_ / "rules/assets/near.glb");
    std::filesystem::copy_file(HELIO_ASSETS "/facade/sill.glb", temp_ / "assets/far.glb");
    put("rules/own.cga",
        "Lot --> extrude(9) comp(f) { side : Wall | top : Roof. }\n"
        "Wall --> split(x) { '0.3 : i(\"near.glb\") | '0.3 : i(\"far.glb\") | ~1 : i(\"facade/sill.glb\") }\n");
    const RunResult result = bake("town.geojson --rules rules/own.cga --rays 16 -o p");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const Result<Pack> pack = Pack::open(temp_ / "p");
    ASSERT_TRUE(pack.ok());
    // The static mesh and three assets; four walls outside of each house. The assets of the four walls in the court of
    // one house are as deep as they are high, so they are mitred there and part of the static mesh.
    ASSERT_EQ(pack->tile().draws.size(), 4u);
    for (u32 draw = 1; draw < 4; ++draw) EXPECT_EQ(pack->tile().draws[draw].instanceCount, 8u);
    EXPECT_EQ(pack->index().rules, "own.cga");
}

TEST_F(BakeCli, RefusesDamagedPacks)
{
    ASSERT_TRUE(writePack(test::samplePack(), temp_ / "good").ok());
    EXPECT_EQ(bake("verify good").exitCode, 0);
    EXPECT_EQ(bake("info good").exitCode, 0);
    const std::string index = *readTextFile(temp_ / "good/index"), tile = *readTextFile(temp_ / "good/tile-0000");
    std::string flipped = tile, version = tile, indexVersion = index;
    flipped.back() = char(flipped.back() ^ 4); // the last section ends the file
    version[8] = 9;
    indexVersion.replace(indexVersion.find(concat(kPackVersion, "\n")), 1, "9");
    struct Damage
    {
        std::string index, tile;
        const char* what;
    };
    for (const Damage& damage :
         {Damage{index, tile.substr(0, tile.size() - 1), "its header says"},
          Damage{index, tile.substr(0, 40), "ends inside the header"}, Damage{index, flipped, "the checksum"},
          Damage{index, version, "version 9"}, Damage{indexVersion, tile, "version 9"},
          Damage{index.substr(0, 99), tile, "checksum line"}, Damage{"{}", tile, "this is not the index"}}) {
        std::filesystem::create_directory(temp_ / "p");
        put("p/index", damage.index);
        put("p/tile-0000", damage.tile);
        for (const char* command : {"info p", "verify p", "export p --surfaces out"}) {
            expectRefusal(command, damage.what);
            expectRefusal(command, "bake");
        }
    }
    expectRefusal("info none", "there is no such pack");
}

TEST_F(BakeCli, ScenesComeBackFromExport)
{
    ASSERT_EQ(bake(kScene + ".obj --surfaces " + kScene + ".csv --rays 16 -o first").exitCode, 0);
    ASSERT_EQ(bake("export first --surfaces again").exitCode, 0);
    const RunResult second = bake("again.obj --surfaces again.csv --rays 16 --split 1 -o second");
    ASSERT_EQ(second.exitCode, 0) << second.err;
    const Result<Pack> first = Pack::open(temp_ / "first"), back = Pack::open(temp_ / "second");
    ASSERT_TRUE(first.ok() && back.ok());
    ASSERT_EQ(first->patchCount(), back->patchCount());
    EXPECT_EQ(back->index().sourceFaceCount, first->patchCount());
    for (const gpu::PatchRecord& patch : back->tile().patches) {
        const gpu::PatchRecord& was = first->tile().patches[patch.sourceFace];
        ASSERT_NEAR(double(patch.area), double(was.area), 1e-6 * double(was.area));
        ASSERT_EQ(patch.rho, was.rho);
        ASSERT_EQ(patch.emission, was.emission);
        ASSERT_EQ(patch.building, was.building);
    }
}

TEST_F(BakeCli, CitiesComeBackFromExport)
{
    put("town.geojson", kTown);
    const RunResult baked = bake("town.geojson --rays 16 -o first");
    ASSERT_EQ(baked.exitCode, 0) << baked.err;
    ASSERT_EQ(bake("export first --surfaces again").exitCode, 0);
    const RunResult second = bake("again.obj --surfaces again.csv --rays 16 --split 1 -o second");
    ASSERT_EQ(second.exitCode, 0) << second.err;
    const Result<Pack> first = Pack::open(temp_ / "first"), back = Pack::open(temp_ / "second");
    ASSERT_TRUE(first.ok() && back.ok());
    ASSERT_EQ(first->patchCount(), back->patchCount());
    for (const gpu::PatchRecord& patch : back->tile().patches) {
        const gpu::PatchRecord& was = first->tile().patches[patch.sourceFace];
        ASSERT_NEAR(double(patch.area), double(was.area), 1e-6 * double(was.area)) << "face " << patch.sourceFace;
        ASSERT_EQ(patch.rho, was.rho);
    }
}

TEST_F(BakeCli, SameBytesForAnyNumberOfThreads)
{
    put("town.geojson", kTown);
    for (const std::string& input : {std::string("town.geojson"), kScene + ".obj --surfaces " + kScene + ".csv"}) {
        ASSERT_EQ(bake(input + " --jobs 1 -o one").exitCode, 0);
        ASSERT_EQ(bake(input + " --jobs 2 -o two").exitCode, 0);
        ASSERT_EQ(bake(input + " --jobs 3 -o again").exitCode, 0);
        const std::string bytes = bytesOf("one");
        EXPECT_GT(bytes.size(), 10000u);
        EXPECT_TRUE(bytes == bytesOf("two")) << input;
        EXPECT_TRUE(bytes == bytesOf("again")) << input;
    }
}

TEST_F(BakeCli, OptionsChangeTheBytes)
{
    put("town.geojson", kTown);
    ASSERT_EQ(bake("town.geojson --rays 16 -o a").exitCode, 0);
    ASSERT_EQ(bake("town.geojson --rays 16 --seed 2 -o b").exitCode, 0);
    ASSERT_EQ(bake("town.geojson --rays 16 --method paper -o c").exitCode, 0);
    EXPECT_NE(bytesOf("a"), bytesOf("b"));
    EXPECT_EQ(Pack::open(temp_ / "b")->index().seed, 2u);
    EXPECT_EQ(Pack::open(temp_ / "c")->index().method, "paper");
    EXPECT_EQ(Pack::open(temp_ / "a")->index().source, "town.geojson");
}

TEST_F(BakeCli, TreeShapesAreRecorded)
{
    u32 nodes[3] = {}, patches[3] = {}, count = 0;
    for (const std::string shape : {"grammar", "free", "faces"}) {
        const RunResult baked = bake(kScene + ".obj --surfaces " + kScene + ".csv --rays 16 --tree " + shape + " -o p");
        ASSERT_EQ(baked.exitCode, 0) << baked.err;
        const Result<Pack> pack = Pack::open(temp_ / "p");
        ASSERT_TRUE(pack.ok());
        EXPECT_NE(pack->index().options.find("\"tree\":\"" + shape + "\""), std::string::npos) << pack->index().options;
        nodes[count] = pack->nodeCount();
        patches[count++] = pack->patchCount();
    }
    EXPECT_EQ(patches[0], patches[1]);
    EXPECT_EQ(patches[0], patches[2]);
    EXPECT_LT(nodes[2], nodes[0]) << "no planar levels";
    expectRefusal(kScene + ".obj --surfaces " + kScene + ".csv -o q --tree oak", "--tree");
}

TEST_F(BakeCli, CompactLinksAreSmallerAndSaidToBe)
{
    put("town.geojson", kTown);
    ASSERT_EQ(bake("town.geojson --rays 16 --stats a.json -o a").exitCode, 0);
    const RunResult baked = bake("town.geojson --rays 16 --compact-links --jobs 1 --stats b.json -o b");
    ASSERT_EQ(baked.exitCode, 0) << baked.err;
    ASSERT_EQ(bake("town.geojson --rays 16 --compact-links --jobs 2 -o c").exitCode, 0);
    EXPECT_TRUE(bytesOf("b") == bytesOf("c"));
    ASSERT_EQ(bake("town.geojson --rays 16 --compact-links --zstd -o d").exitCode, 0);
    EXPECT_EQ(bake("verify d").exitCode, 0);

    const Result<Pack> plain = Pack::open(temp_ / "a"), compact = Pack::open(temp_ / "b"),
                       both = Pack::open(temp_ / "d");
    ASSERT_TRUE(plain.ok() && compact.ok() && both.ok());
    EXPECT_TRUE(std::ranges::equal(plain->tile().linkColumns, compact->tile().linkColumns));
    EXPECT_TRUE(std::ranges::equal(both->tile().linkFactors, compact->tile().linkFactors));
    const double links = double(plain->tile().linkColumns.size());
    for (const auto& [name, pack] : {std::pair("a.json", &*plain), std::pair("b.json", &*compact)}) {
        const nlohmann::json stats = nlohmann::json::parse(*readTextFile(temp_ / name), nullptr, false);
        ASSERT_TRUE(stats.contains("link_bytes")) << name;
        const nlohmann::json& bytes = stats["link_bytes"];
        EXPECT_NEAR(bytes["columns"].get<double>(), double(pack->linkBytes().columns) / links, 1e-9) << name;
        EXPECT_NEAR(bytes["factors"].get<double>(), double(pack->linkBytes().factors) / links, 1e-9) << name;
        EXPECT_NEAR(bytes["moments"].get<double>(), double(pack->linkBytes().moments) / links, 1e-9) << name;
    }
    EXPECT_EQ(plain->linkBytes().columns, u64(4 * links));
    EXPECT_LT(compact->linkBytes().columns, u64(1.5 * links));
    EXPECT_LT(compact->linkBytes().factors, u64(2.5 * links));
    EXPECT_LT(both->linkBytes().columns, compact->linkBytes().columns);
    EXPECT_NE(baked.out.find("bytes a link         columns 1."), std::string::npos) << baked.out;
    const RunResult info = bake("info b");
    EXPECT_NE(info.out.find("link bytes  columns 1."), std::string::npos) << info.out;
}

TEST_F(BakeCli, AttributesCanBeSet)
{
    put("town.geojson", kTown);
    put("own.cga", "attr h = 5\nattr flat = false\nattr kind = \"a\"\nLot --> case flat : NIL case kind == \"b\" : "
                   "extrude(2 * h) else : extrude(h)\n");
    const auto top = [&](const std::string& set) {
        const RunResult result = bake("town.geojson --rules own.cga --rays 16 -o p " + set);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        const Result<Pack> pack = Pack::open(temp_ / "p");
        return pack ? pack->index().boundsMax.z : -1.0f;
    };
    EXPECT_EQ(top(""), 5.0f);
    EXPECT_EQ(top("--set h=7.5"), 7.5f);
    EXPECT_EQ(top("--set kind=b --set h=3"), 6.0f);
    EXPECT_EQ(top("--set flat=true"), 0.0f) << "only the ground is left";
    expectRefusal("town.geojson --rules own.cga -o q --set hight=3", "no attribute 'hight'");
    expectRefusal("town.geojson --rules own.cga -o q --set h", "NAME=VALUE");
}

TEST_F(BakeCli, StatisticsAgreeWithThePack)
{
    put("town.geojson", kTown);
    const RunResult result = bake("town.geojson --rays 16 --stats s.json -o p");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.err, "") << "a log holds errors alone";
    for (const char* word : {"buildings 2", "nodes", "patches", "links", "per patch", "row sum + sky",
                             "area-ledger defect", "seconds", "peak memory"})
        EXPECT_NE(result.out.find(word), std::string::npos) << word;
    const nlohmann::json stats = nlohmann::json::parse(*readTextFile(temp_ / "s.json"), nullptr, false);
    const Result<Pack> pack = Pack::open(temp_ / "p");
    ASSERT_TRUE(stats.is_object() && pack.ok());
    EXPECT_EQ(stats["buildings"], 2);
    EXPECT_EQ(stats["patches"], pack->patchCount());
    EXPECT_EQ(stats["nodes"], pack->nodeCount());
    EXPECT_EQ(stats["links"], pack->tile().linkColumns.size());
    EXPECT_EQ(stats["overlapping_nodes"], 0);
    EXPECT_LE(stats["area_ledger_defect"].get<double>(), 1e-5);
    EXPECT_GT(stats["peak_memory_mib"].get<double>(), 1.0);
    EXPECT_EQ(temp_.entryCount(), 3u) << "town, statistics, pack";
}

TEST_F(BakeCli, AFaceThatIsThereTwiceIsReported)
{
    put("scene.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\nf 1 2 3 4\n");
    const std::string row = "wall,0,0,0,0,.5,.5,.5,0,0,0\n";
    put("scene.csv", "kind,building,facade,floor,bay,rho_r,rho_g,rho_b,emit_r,emit_g,emit_b\n" + row + row);
    const RunResult result = bake("scene.obj --surfaces scene.csv --rays 16 --stats s.json -o p");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.out.find("overlapping nodes    1"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("note: nodes: in 1 "), std::string::npos) << result.out;
    const nlohmann::json stats = nlohmann::json::parse(*readTextFile(temp_ / "s.json"), nullptr, false);
    EXPECT_EQ(stats["overlapping_nodes"], 1);
    EXPECT_NEAR(stats["area_ledger_defect"].get<double>(), 1.0, 1e-6);
}

TEST_F(BakeCli, AFileThatGrowsTooLargeLeavesNothing)
{
    put("town.geojson", kTown);
    const RunResult result = test::runProgram(
        "/bin/bash", "-c 'ulimit -f 16; exec \"" HELIO_BAKE "\" town.geojson --rays 16 -o p'", temp_.path());
    EXPECT_EQ(result.exitCode, 1) << result.err;
    EXPECT_NE(result.err.find("p: cannot be written: File too large"), std::string::npos) << result.err;
    EXPECT_EQ(temp_.entryCount(), 1u) << "the town alone";
}

TEST_F(BakeCli, CtrlCLeavesNothing)
{
    const RunResult result =
        test::runProgram("/usr/bin/timeout", "-s INT 0.2 '" HELIO_BAKE "' --jobs 1 -o p", temp_.path());
    EXPECT_EQ(result.exitCode, 124) << "the built-in city takes longer than 0.2 s";
    EXPECT_EQ(temp_.entryCount(), 0u);
}

} // namespace
} // namespace helio
