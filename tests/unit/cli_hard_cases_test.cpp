// SPDX-License-Identifier: Apache-2.0
// Hard cases through the built heliopolis-bake: baked, verified and traced as a user does it.
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "city/base/file.h"
#include "tests/unit/cli_runner.h"

namespace helio {
namespace {

using test::RunResult;
using test::TempFolder;

/// Numbers of a JSON value, all the way down, are finite; nlohmann writes others as null.
void expectFinite(const nlohmann::json& value, const std::string& where)
{
    EXPECT_FALSE(value.is_null()) << where;
    if (value.is_structured())
        for (const auto& [key, inner] : value.items()) expectFinite(inner, where + "/" + key);
}

class HardCasesCli : public testing::Test
{
protected:
    RunResult bake(const std::string& arguments) const { return test::runProgram(HELIO_BAKE, arguments, temp_.path()); }

    void put(const std::string& name, const std::string& text) const
    {
        ASSERT_TRUE(writeTextAtomically(temp_ / name, text).ok());
    }

    /// Bakes, verifies and traces; the columns E_sun_r, E_sky_r and E_indirect_r of each patch.
    std::vector<std::array<double, 3>> light(const std::string& input, const std::string& sun) const
    {
        const RunResult baked = bake(input + " --rays 64 --stats stats.json -o p");
        EXPECT_EQ(baked.exitCode, 0) << input << ": " << baked.err;
        const RunResult verified = bake("verify p");
        EXPECT_EQ(verified.exitCode, 0) << input << ": " << verified.err;
        const Result<std::string> stats = readTextFile(temp_ / "stats.json");
        EXPECT_TRUE(stats.ok());
        if (stats) expectFinite(nlohmann::json::parse(*stats), input);
        const RunResult traced = bake("reference p --sun " + sun + " --spp 64 -o r.csv");
        EXPECT_EQ(traced.exitCode, 0) << input << ": " << traced.err;
        const Result<std::string> table = readTextFile(temp_ / "r.csv");
        std::istringstream lines(table ? *table : "");
        std::vector<std::string> head;
        std::vector<std::array<double, 3>> rows;
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with('#')) continue;
            std::istringstream parts(line);
            std::vector<std::string> cells;
            for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
            if (head.empty()) {
                head = cells;
                continue;
            }
            std::array<double, 3> row{NAN, NAN, NAN};
            for (size_t k = 0; k < head.size() && k < cells.size(); ++k) {
                if (head[k] == "E_sun_r") row[0] = std::stod(cells[k]);
                if (head[k] == "E_sky_r") row[1] = std::stod(cells[k]);
                if (head[k] == "E_indirect_r") row[2] = std::stod(cells[k]);
            }
            for (const double value : row) EXPECT_TRUE(std::isfinite(value) && value >= 0.0) << input << ": " << line;
            rows.push_back(row);
        }
        EXPECT_FALSE(rows.empty()) << input;
        return rows;
    }

    /// An OBJ of squares of 1 m with their CSV: each by its lowest corner and two edges; nothing emits.
    struct Square
    {
        glm::dvec3 corner, u, v;
    };
    void putSquares(const std::string& name, const std::vector<Square>& squares) const
    {
        std::ostringstream obj, csv;
        obj.precision(17);
        csv << "kind,building,facade,floor,bay,rho_r,rho_g,rho_b,emit_r,emit_g,emit_b\n";
        for (const Square& s : squares) {
            for (const glm::dvec3& p : {s.corner, s.corner + s.u, s.corner + s.u + s.v, s.corner + s.v})
                obj << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
            obj << "f -4 -3 -2 -1\n";
            csv << "wall,0,0,0,0,.5,.5,.5,0,0,0\n";
        }
        put(name + ".obj", obj.str());
        put(name + ".csv", csv.str());
    }

    /// The six sides of a room of 1 m, or without its ceiling.
    static std::vector<Square> room(bool closed, const glm::dvec3& offset)
    {
        const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), o = offset;
        std::vector<Square> sides{{o, x, y}, {o, y, z}, {o + x, z, y}, {o, z, x}, {o + y, x, z}};
        if (closed) sides.push_back({o + z, y, x});
        return sides;
    }

    std::string feature(const std::string& id, const std::string& height, const std::string& ring) const
    {
        std::ostringstream out;
        out << R"({"type":"Feature","id":")" << id << R"(","properties":{"height":)" << height
            << R"(},"geometry":{"type":"Polygon","coordinates":[)" << ring << "]}}";
        return out.str();
    }
    void putTown(const std::string& name, const std::vector<std::string>& features) const
    {
        std::ostringstream out;
        out << R"({"type":"FeatureCollection","features":[)";
        for (const std::string& one : features) out << (&one == features.data() ? "" : ",") << one;
        out << "]}";
        put(name, out.str());
    }

    TempFolder temp_;
};

TEST_F(HardCasesCli, TownsOfHardFootprints)
{
    const std::string house = "[[0,0],[12,0],[12,10],[0,10],[0,0]]";
    putTown("touching.geojson",
            {feature("a", "12", house), feature("b", "15", "[[12,0],[22,0],[22,10],[12,10],[12,0]]")});
    putTown("gap.geojson",
            {feature("a", "12", house), feature("b", "15", "[[12.001,0],[22,0],[22,10],[12.001,10],[12.001,0]]")});
    putTown("overlap.geojson", {feature("a", "12", house), feature("b", "15", "[[8,4],[20,6],[18,16],[6,14],[8,4]]")});
    putTown("twice.geojson", {feature("a", "12", house), feature("b", "12", house)});
    putTown("sliver.geojson",
            {feature("a", "12", house), feature("b", "9", "[[12,0],[12.15,0],[12.15,10],[12,10],[12,0]]")});
    putTown("court.geojson",
            {feature("a", "30", "[[0,0],[20,0],[20,20],[0,20],[0,0]],[[9,9],[9,11],[11,11],[11,9],[9,9]]")});
    for (const char* town : {"touching", "gap", "overlap", "twice", "sliver", "court"}) {
        const auto rows = light(std::string(town) + ".geojson", "200,40");
        double sun = 0.0;
        for (const auto& row : rows) {
            sun += row[0];
            EXPECT_TRUE(row[0] <= 800.0 && row[1] <= 121.0) << town;
        }
        EXPECT_GT(sun, 0.0) << town;
    }
}

TEST_F(HardCasesCli, OnePatchNoPatchAndTheDark)
{
    putSquares("one", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    const auto one = light("one.obj --surfaces one.csv", "10,30");
    ASSERT_EQ(one.size(), 1u);
    EXPECT_NEAR(one[0][0], 400.0, 1e-3);
    EXPECT_NEAR(one[0][1], 120.0, 1e-3);
    EXPECT_EQ(one[0][2], 0.0);
    EXPECT_EQ(light("one.obj --surfaces one.csv", "10,0")[0][0], 0.0) << "sun at the horizon";
    EXPECT_EQ(light("one.obj --surfaces one.csv", "10,-20")[0][0], 0.0) << "sun below the horizon";

    putSquares("none", {});
    const RunResult none = bake("none.obj --surfaces none.csv -o q");
    EXPECT_EQ(none.exitCode, 1);
    EXPECT_EQ(none.errorLines(), 1u) << none.err;
    EXPECT_NE(none.err.find("none.obj"), std::string::npos) << none.err;
    EXPECT_FALSE(std::filesystem::exists(temp_ / "q"));

    putSquares("closed", room(true, glm::dvec3(0.0)));
    for (const auto& row : light("closed.obj --surfaces closed.csv", "150,60"))
        EXPECT_EQ(row[0] + row[1] + row[2], 0.0) << "no sky, no sun, no lamp";
}

TEST_F(HardCasesCli, FiveMillionMetresFromTheOrigin)
{
    putSquares("here", room(false, glm::dvec3(0.0)));
    putSquares("there", room(false, glm::dvec3(5e6, 5e6, 0.0)));
    const auto here = light("here.obj --surfaces here.csv", "150,60"),
               there = light("there.obj --surfaces there.csv", "150,60");
    ASSERT_EQ(here.size(), there.size());
    for (size_t i = 0; i < here.size(); ++i)
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(there[i][c], here[i][c], 0.01) << i << " " << c;
}

TEST_F(HardCasesCli, APatchOfAMillionthOfASquareMetre)
{
    putSquares("tiny", {{{0, -50, 0}, {100, 0, 0}, {0, 100, 0}}, {{50, 0, 0}, {0, 1e-3, 0}, {0, 0, 1e-3}}});
    const auto rows = light("tiny.obj --surfaces tiny.csv", "90,30");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_NEAR(rows[0][0], 400.0, 1e-3);
    EXPECT_NEAR(rows[1][0], 800.0 * std::cos(std::numbers::pi / 6), 1e-2);
    EXPECT_NEAR(rows[1][1], 60.0, 5.0);
    EXPECT_NEAR(rows[1][2], 0.5 * 0.5 * 520.0, 0.1 * 130.0);
}

} // namespace
} // namespace helio
