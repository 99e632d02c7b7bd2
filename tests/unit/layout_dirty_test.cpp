// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "city/layout/import.h"
#include "city/layout/polygon_repair.h"

using namespace helio;

namespace {

// What real files have wrong, one kind a row: the feature "x" beside two good houses, and what must become of it.
struct DirtyCase
{
    const char* name;
    std::string rings;      ///< coordinates of a Polygon
    std::string properties; ///< of the feature
    double area;            ///< m2 that remain in footprints x, x.2, ...; 0: the feature is skipped
    u32 pieces;
    const char* note; ///< words of a note that names x; empty: there is none
    double height = 12.0;
};

std::ostream& operator<<(std::ostream& out, const DirtyCase& dirty)
{
    return out << dirty.name;
}

std::string ringText(const Ring2& ring)
{
    std::ostringstream out;
    out.precision(17);
    out << "[";
    for (const glm::dvec2& p : ring) out << "[" << p.x << "," << p.y << "],";
    out << "[" << ring[0].x << "," << ring[0].y << "]]";
    return out.str();
}

Ring2 circle(int corners, double radius)
{
    Ring2 ring;
    for (int i = 0; i < corners; ++i)
        ring.push_back(radius * glm::dvec2(std::cos(2.0 * std::numbers::pi * i / corners),
                                           std::sin(2.0 * std::numbers::pi * i / corners)));
    return ring;
}

// A comb: 40 teeth of 1 x 4 m on a back of 79 x 2 m, 160 corners.
Ring2 comb()
{
    Ring2 ring{{0, 0}, {79, 0}};
    for (int tooth = 39; tooth >= 0; --tooth) {
        const double x = 2.0 * tooth;
        ring.insert(ring.end(), {{x + 1, 2}, {x + 1, 6}, {x, 6}, {x, 2}});
    }
    ring.erase(ring.begin() + 2); // (79, 2) and (0, 2) lie on straight sides
    ring.pop_back();
    return ring;
}

const std::string kBox = "[[0,0],[10,0],[10,8],[0,8],[0,0]]";
const std::string kSquare = "[[0,0],[12,0],[12,12],[0,12],[0,0]]";

std::vector<DirtyCase> dirtyCases()
{
    std::vector<DirtyCase> cases{
        {"unclosed ring", "[[[0,0],[10,0],[10,8],[0,8]]]", "", 80, 1, "closed 1 open ring"},
        {"two corners", "[[[0,0],[5,0],[0,0]]]", "", 0, 0, "no area, skipped"},
        {"one corner", "[[[3,3]]]", "", 0, 0, "no area"},
        {"no corner", "[[]]", "", 0, 0, "without corners, skipped"},
        {"no ring", "[]", "", 0, 0, "without coordinates, skipped"},
        {"zero area", "[[[0,0],[5,0],[10,0],[0,0]]]", "", 0, 0, "no area, skipped"},
        {"micro footprint", "[[[0,0],[0.7,0],[0.7,0.7],[0,0.7],[0,0]]]", "", 0, 0, "below 1 m2"},
        {"needle of 0.2 degrees", "[[[0,0],[30,0],[30,0.1],[0,0]]]", "", 0, 0, "0.1 m of width"},
        {"bow tie", "[[[0,0],[10,8],[10,0],[0,8],[0,0]]]", "", 40, 2, "united crossing"},
        {"figure 8", "[[[0,0],[5,0],[5,5],[10,5],[10,10],[5,10],[5,5],[0,5],[0,0]]]", "", 50, 2, "united"},
        {"antenna", "[[[0,0],[10,0],[10,8],[10,20],[10,8],[0,8],[0,0]]]", "", 80, 1, "removed 2 spike corners"},
        {"repeated corners", "[[[0,0],[10,0],[10.0001,0],[10.0001,0],[10,8],[0,8],[0,8.0001],[0,0]]]", "", 80, 1,
         "dropped 3 repeated corners"},
        {"short edge", "[[[0,0],[10,0],[10,8],[9.95,8.01],[0,8],[0,0]]]", "", 80, 1, "collapsed 1 edge"},
        {"clockwise", "[[[0,0],[0,8],[10,8],[10,0],[0,0]]]", "", 80, 1, ""},
        {"hole touches the outline", concat("[", kSquare, ",[[0,6],[6,3],[6,9],[0,6]]]"), "", 126, 1, "united"},
        {"hole on the outline", concat("[", kSquare, ",[[0,3],[0,9],[6,9],[6,3],[0,3]]]"), "", 108, 1, "united"},
        {"overlapping holes",
         "[[[0,0],[20,0],[20,12],[0,12],[0,0]],[[3,3],[9,3],[9,9],[3,9],[3,3]],[[7,4],[14,4],[14,8],[7,8],[7,4]]]", "",
         240 - 36 - 28 + 8, 1, "united"},
        {"several courtyards",
         "[[[0,0],[30,0],[30,12],[0,12],[0,0]],[[2,2],[9,2],[9,10],[2,10],[2,2]],"
         "[[12,2],[19,2],[19,10],[12,10],[12,2]]]",
         "", 360 - 112, 1, ""},
        {"hole without area", concat("[", kSquare, ",[[3,3],[6,6],[9,9],[3,3]]]"), "", 144, 1, "hole without area"},
        {"over 120 corners", concat("[", ringText(comb()), "]"), "", 79 * 2 + 40 * 4, 1, ""},
        {"circle of 256", concat("[", ringText(circle(256, 10)), "]"), "", std::numbers::pi * 100, 1, ""},
        {"1e308", "[[[0,0],[1e308,0],[10,8],[0,8],[0,0]]]", "", 0, 0, "beyond 1e7 m, skipped"},
        {"null coordinate", "[[[0,0],[null,0],[10,8],[0,0]]]", "", 0, 0, "not a pair of numbers, skipped"},
        {"text coordinate", R"([[[0,0],["10",0],[10,8],[0,0]]])", "", 0, 0, "not a pair of numbers, skipped"},
        {"degrees among metres", "[[[7.42,43.73],[7.4202,43.73],[7.4202,43.7302],[7.42,43.7302],[7.42,43.73]]]", "", 0,
         0, "longitude and latitude"},
        {"far away", "[[[2.6e6,1.2e6],[2600010,1.2e6],[2600010,1200010],[2.6e6,1200010],[2.6e6,1.2e6]]]", "", 0, 0,
         "km from the other footprints, skipped"},
        {"over 20,000 corners", concat("[", ringText(circle(20001, 50)), "]"), "", 0, 0, "over 20,000 corners"},
        {"height 0", concat("[", kBox, "]"), R"("height":0)", 80, 1, "height 0 is not usable"},
        {"height -3", concat("[", kBox, "]"), R"("height":-3)", 80, 1, "height -3 is not usable"},
        {"height 12 m", concat("[", kBox, "]"), R"("height":"15 m")", 80, 1, "read as 15", 15.0},
        {"height ca. 12", concat("[", kBox, "]"), R"("height":"ca. 15")", 80, 1, "ca. 15"},
        {"height 1e300", concat("[", kBox, "]"), R"("height":1e300)", 80, 1, "not usable"},
        {"levels in words", concat("[", kBox, "]"), R"("levels":"some")", 80, 1, "levels"},
    };
    return cases;
}

class DirtyCases : public testing::TestWithParam<DirtyCase>
{
};
INSTANTIATE_TEST_SUITE_P(Dirty, DirtyCases, testing::ValuesIn(dirtyCases()));

TEST_P(DirtyCases, AreRepairedOrSkippedWithTheirName)
{
    const DirtyCase& dirty = GetParam();
    const std::string text =
        R"({"type":"FeatureCollection","features":[{"type":"Feature","id":"good","properties":{},"geometry":)"
        R"({"type":"Polygon","coordinates":[[[200,200],[210,200],[210,210],[200,210],[200,200]]]}},)"
        R"({"type":"Feature","id":"good too","properties":{},"geometry":)"
        R"({"type":"Polygon","coordinates":[[[230,200],[240,200],[240,210],[230,210],[230,200]]]}},)"
        R"({"type":"Feature","id":"x","properties":{)" +
        dirty.properties + R"(},"geometry":{"type":"Polygon","coordinates":)" + dirty.rings + "}}]}";
    const Result<Layout> layout = parseCity(text, "dirty.geojson", {});
    ASSERT_TRUE(layout.ok()) << layout.error().message;
    double sum = 0.0;
    u32 pieces = 0;
    for (const Footprint& footprint : layout->footprints) {
        EXPECT_TRUE(isSimple(footprint.outline)) << footprint.id;
        EXPECT_GT(signedArea(footprint.outline.outer), 0.0);
        EXPECT_EQ(footprint.height, footprint.id.starts_with("good") ? 12.0 : dirty.height);
        if (footprint.id.starts_with("good")) continue;
        EXPECT_TRUE(footprint.id == "x" || footprint.id.starts_with("x.")) << footprint.id;
        sum += area(footprint.outline);
        ++pieces;
    }
    EXPECT_EQ(layout->footprints.size(), pieces + 2u) << "the good houses stay";
    EXPECT_EQ(pieces, dirty.pieces);
    EXPECT_NEAR(sum, dirty.area, 0.005 * dirty.area); // corners of 0.1 m and 2 cm of a curve may go
    std::string notes;
    for (const std::string& note : layout->notes)
        if (note.starts_with("feature x:")) notes = concat(notes, note, "; ");
    EXPECT_NE(notes.find(dirty.note), std::string::npos) << notes;
    EXPECT_EQ(notes.empty(), *dirty.note == '\0') << notes;
    EXPECT_EQ(notes.find("skipped") != std::string::npos, dirty.pieces == 0) << notes;
    // Alone in its file it is repaired, or the error names it.
    const size_t x = text.find(R"({"type":"Feature","id":"x")");
    const Result<Layout> alone = parseCity(text.substr(x, text.size() - x - 2), "dirty.geojson", {});
    EXPECT_TRUE(alone.ok() || alone.error().message.find("feature x") != std::string::npos) << alone.error().message;
}

TEST(DirtyFeatures, ThatRepeatOrCoverEachOtherAreDroppedOrCut)
{
    const auto feature = [](const std::string& id, const std::string& ring, double height) {
        std::ostringstream out;
        out << R"({"type":"Feature","id":")" << id << R"(","properties":{"height":)" << height
            << R"(},"geometry":{"type":"Polygon","coordinates":[)" << ring << "]}}";
        return out.str();
    };
    // Nested: a yard building inside a house, higher and lower; redundant: the same outline once more, from another
    // corner; a slab that lies half on the house.
    const std::string text = R"({"type":"FeatureCollection","features":[)" +
                             feature("house", "[[0,0],[20,0],[20,20],[0,20],[0,0]]", 10) + "," +
                             feature("core", "[[5,5],[10,5],[10,10],[5,10],[5,5]]", 15) + "," +
                             feature("cellar", "[[12,12],[15,12],[15,15],[12,15],[12,12]]", 3) + "," +
                             feature("again", "[[20,20],[20,0],[0,0],[0,20],[20,20]]", 8) + "," +
                             feature("slab", "[[15,0],[30,0],[30,4],[15,4],[15,0]]", 4) + "]}";
    const Result<Layout> layout = parseCity(text, "nested.geojson", {});
    ASSERT_TRUE(layout.ok());
    std::map<std::string, double> areas;
    for (const Footprint& footprint : layout->footprints) areas[footprint.id] = area(footprint.outline);
    ASSERT_EQ(areas.size(), 3u);
    EXPECT_NEAR(areas.at("house"), 400.0 - 25.0, 1e-6);
    EXPECT_NEAR(areas.at("core"), 25.0, 1e-6);
    EXPECT_NEAR(areas.at("slab"), 60.0 - 20.0, 1e-6);
    EXPECT_EQ(layout->counts.at("repaired.equal_dropped"), 1u);
    EXPECT_EQ(layout->counts.at("repaired.overlap_cut"), 2u);
    EXPECT_EQ(layout->counts.at("repaired.overlap_dropped"), 1u);
    EXPECT_EQ(layout->counts.at("duplicate_footprints"), 1u);
}

} // namespace
