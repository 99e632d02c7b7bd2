// SPDX-License-Identifier: Apache-2.0
// Stable keys of the tree, counts, progress and interruption of a derivation.
#include <atomic>
#include <stdexcept>

#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

std::vector<Footprint> boxes(u32 count)
{
    std::vector<Footprint> all;
    for (u32 k = 0; k < count; ++k) {
        all.push_back(boxFootprint(4 + k % 5, 6, 6));
        all.back().id = std::to_string(k);
    }
    return all;
}

/// Key and height of every leaf named A: its height is drawn at random.
std::map<std::string, double> draws(const std::string& rules)
{
    const Derivation d = mustDerive(rules, {boxFootprint(6, 6, 6)});
    std::map<std::string, double> result;
    for (u32 k = 0; k < d.shapes.shapes.size(); ++k)
        if (d.shapes.names[d.shapes.shapes[k].name] == "A") {
            EXPECT_TRUE(result.emplace(treeKey(d.shapes, k), boundsOf(d, d.shapes.shapes[k]).first.z).second);
        }
    return result;
}

TEST(GrammarTree, KeysArePathsOfChildNumbers)
{
    const Derivation d =
        mustDerive("Lot --> P split(x) { 2 : NIL | 2 : Q | ~1 : A. }\nP --> [ X. Y. ] Z.\nQ --> split(z) { ~3 : A. }*",
                   {boxFootprint(6, 6, 6)});
    std::map<std::string, std::string> names;
    for (u32 k = 0; k < d.shapes.shapes.size(); ++k)
        names[treeKey(d.shapes, k)] = d.shapes.names[d.shapes.shapes[k].name];
    EXPECT_EQ(names, (std::map<std::string, std::string>{{"", "Lot"},
                                                         {"0", "P"},
                                                         {"0/0", "push"},
                                                         {"0/0/0", "X"},
                                                         {"0/0/1", "Y"},
                                                         {"0/1", "Z"},
                                                         {"2", "Q"}, // 1 is the part that is gone
                                                         {"2/0", "A"},
                                                         {"2/1", "A"},
                                                         {"3", "A"}}));
}

TEST(GrammarTree, AnEditLeavesTheRestAlone)
{
    const std::string rules = "Lot --> split(x) { ~1 : Bay }*\nBay --> case split.index == 2 : Edited else : Other\n"
                              "Other --> split(z) { ~2 : A }*\nA --> t(0, rand(100), 0)\n";
    const auto before = draws(rules + "Edited --> split(z) { ~2 : A }*"),
               after = draws(rules + "Edited --> X. split(z) { ~1 : A }* A"), gone = draws(rules + "Edited --> NIL");
    ASSERT_EQ(before.size(), 6u * 3);
    u32 kept = 0;
    for (const auto& [key, height] : before) {
        if (key.rfind("2/", 0) == 0) continue; // the edited bay
        ++kept;
        ASSERT_EQ(after.count(key), 1u) << key;
        EXPECT_EQ(after.at(key), height) << key;
        ASSERT_EQ(gone.count(key), 1u) << key;
        EXPECT_EQ(gone.at(key), height) << key;
    }
    EXPECT_EQ(kept, 5u * 3);
    EXPECT_EQ(gone.size(), 15u);
}

TEST(GrammarProgress, ToldInOrderForAnyNumberOfThreads)
{
    const auto footprints = boxes(300);
    for (const u32 jobs : {1u, 2u, 7u}) {
        DeriveOptions options = unitAssets();
        options.jobs = jobs;
        std::vector<u32> done;
        options.progress = [&](u32 k, u32 total) {
            EXPECT_EQ(total, 300u);
            done.push_back(k);
        };
        const Derivation d = mustDerive("Lot --> extrude(height) comp(f) { side : A. | all : B. }\nattr height = 1",
                                        footprints, options);
        ASSERT_EQ(done.size(), 300u);
        for (u32 k = 0; k < 300; ++k) EXPECT_EQ(done[k], k + 1);
        EXPECT_EQ(d.counts.shapes, 300u * 7);
        EXPECT_EQ(d.counts.leaves, 300u * 6);
        for (u32 k = 0; k < 300; ++k) EXPECT_EQ(d.shapes.buildingIds[k], std::to_string(k));
    }
}

TEST(GrammarProgress, InterruptionStops)
{
    DeriveOptions options = unitAssets();
    options.jobs = 3;
    u32 done = 0;
    options.progress = [&](u32 k, u32) { done = k; };
    options.interrupted = [&] { return done == 100; };
    const auto stopped = deriveText("Lot --> A.", boxes(5000), options);
    ASSERT_FALSE(stopped.ok());
    EXPECT_EQ(stopped.error().message, "interrupted after 100 of 5000 buildings");
    EXPECT_EQ(done, 100u);
}

TEST(GrammarProgress, TheFirstErrorInTheOrderOfTheBuildingsIsReported)
{
    auto footprints = boxes(400);
    for (const u32 broken : {333u, 57u, 390u}) footprints[broken].attributes["bad"] = true;
    for (const u32 jobs : {1u, 2u, 8u}) {
        DeriveOptions options = unitAssets();
        options.jobs = jobs;
        const auto derivation =
            deriveText("attr bad = false\nLot --> case bad : extrude(1 / 0) A. else : A.", footprints, options);
        ASSERT_FALSE(derivation.ok());
        EXPECT_NE(derivation.error().message.find("building '57'"), std::string::npos) << derivation.error().message;
    }
}

TEST(GrammarProgress, AnExceptionOfTheCallerDoesNotHangTheOthers)
{
    DeriveOptions options = unitAssets();
    options.jobs = 4;
    options.assetBox = [](const std::string&) -> Result<AssetBox> { throw std::runtime_error("no memory"); };
    EXPECT_THROW((void)deriveText("Lot --> i(\"a.glb\") A.", boxes(2000), options), std::runtime_error);
    options = unitAssets();
    options.jobs = 4;
    options.progress = [](u32 k, u32) {
        if (k == 10) throw std::runtime_error("no memory");
    };
    EXPECT_THROW((void)deriveText("Lot --> A.", boxes(2000), options), std::runtime_error);
}

TEST(GrammarProgress, WarningsAreBounded)
{
    auto footprints = boxes(300);
    const Derivation d =
        mustDerive("attr id = \"\"\nLot --> split(x) { ~0.5 : print(id + split.index) A. }*", footprints);
    EXPECT_GE(d.warnings.size(), 900u);
    EXPECT_LE(d.warnings.size(), 1000u);
}

} // namespace
} // namespace helio::test
