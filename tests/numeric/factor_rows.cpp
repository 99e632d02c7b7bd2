// SPDX-License-Identifier: Apache-2.0
#include "tests/numeric/factor_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "city/light/form_factor.h"
#include "tests/numeric/text_table.h"

namespace helio::test {
namespace {

struct Geometry
{
    PairRings pair;
    std::vector<Ring3> occluders = {};
};

std::map<std::string, Geometry> geometries()
{
    const Ring3 street{{-5, 0, 0}, {5, 0, 0}, {5, 10, 0}, {-5, 10, 0}};
    const Ring3 lShape{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    const auto square = [](double z) { return Ring3{{.25, .25, z}, {.75, .25, z}, {.75, .75, z}, {.25, .75, z}}; };
    const PairRings cube = opposed(0, 1, 0, 1, 1, 0, 1, 0, 1);
    const PairRings windows = opposed(0, 1.5, 0, 1.2, 12, 7.3, 8.5, 4.1, 5.6);
    const glm::dvec3 map(5e5, 4.5e6, 0.0);
    return {
        {"P01", {cube}},
        {"P02", {opposed(.1, .2, .1, .2, .05, .1, .2, .1, .2)}},
        {"P03", {opposed(0, 100, 0, 20, 15, 0, 100, 0, 20)}},
        {"P04", {windows}},
        {"P06", {opposed(0, 1, 0, 1, 1e-3, 0, 1, 0, 1)}},
        {"P07", {opposed(0, 1, 0, 1, 1e-6, 0, 1, 0, 1)}},
        {"P08", {opposed(-.0005, .0005, -.0005, .0005, 10, -500, 500, -500, 500)}},
        {"P10", {opposed(0, 1, 0, 1, 1000, 0, 1, 0, 1)}},
        {"P11", {opposed(0, 3, 0, 3, 250, 80, 83, 20, 23)}},
        {"P13", {opposed(0, .001, 0, 100, 10, 0, 20, 0, 100)}},
        {"P14", {opposed(0, .001, 0, 100, .001, 0, .001, 0, 100)}},
        {"Q01", {perpendicular(0, 1, 0, 1, 0, 1, 0, 1)}},
        {"Q02", {perpendicular(0, 15, 0, 100, 0, 20, 0, 100)}},
        {"Q03", {perpendicular(.5, 2, 0, 3, .25, 1.5, -1, 2.2)}},
        {"Q05", {perpendicular(0, 20, 0, 100, 0, .001, 0, 100)}},
        {"Q06", {perpendicular(1e-6, 1.000001, 0, 1, 0, 1, 0, 1)}},
        {"Q07", {perpendicular(0, 1, 0, 1, 0, 1, 1, 2)}},
        {"Q08", {perpendicular(0, 1.5, 0, 1.2, 0, .12, 0, 1.2)}},
        {"Q10", {perpendicular(800, 801, 0, 1, 30, 31, 100, 101)}},
        {"R01", {hinged(1, 1, 1, 60)}},
        {"R02", {hinged(1, 1, 1, 120)}},
        {"R03", {hinged(1, 1, 1, 179)}},
        {"R04", {hinged(1, 1, 1, 179.9)}},
        {"R06", {hinged(6, 20, 100, 150)}},
        {"S01", {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 2, 1}, {2, 0, 1}}}}},
        {"S03", {{lShape, {{0, 0, 2}, {0, 2, 2}, {2, 2, 2}, {2, 0, 2}}}}},
        {"U01", {{moved(windows.a, map), moved(windows.b, map)}}},
        {"U02",
         {{{{500000, 4500000, 0}, {500001.5, 4500000, 0}, {500001.5, 4500001, 0}, {500000, 4500001, 0}},
           {{500007.3125, 4500004, 12},
            {500007.3125, 4500005.5, 12},
            {500008.5, 4500005.5, 12},
            {500008.5, 4500004, 12}}}}},
        {"H01", {{street, {{0, 0, 0}, {0, 10, 0}, {0, 10, 8}, {0, 0, 8}}}}},
        {"V01", {cube, {square(0.5)}}},
        {"V04", {cube, {square(0.75)}}},
    };
}

/// Endless strips and points.
const std::set<std::string> kOtherRows{"D01", "D02", "D03", "D04", "V03", "C01", "C02", "C03"};

std::vector<std::vector<std::string>> table(const std::string& dataFolder)
{
    return readTextTable(dataFolder + "/closed_forms/formfactors.csv");
}

} // namespace

std::vector<FactorRow> factorRows(const std::string& dataFolder)
{
    const std::map<std::string, Geometry> known = geometries();
    std::vector<FactorRow> rows;
    for (const std::vector<std::string>& cells : table(dataFolder)) {
        const auto found = known.find(cells[0]);
        if (found == known.end()) {
            EXPECT_TRUE(kOtherRows.contains(cells[0])) << cells[0] << " has no geometry";
            continue;
        }
        const auto& [pair, occluders] = found->second;
        const auto area = [](const Ring3& ring) { return planarShape({{ring}}).area; };
        FactorRow row{cells[0], pair, occluders, std::strtod(cells[2].c_str(), nullptr), 0.0};
        row.ba = cells[3].empty() ? row.ab * area(pair.a) / area(pair.b) : std::strtod(cells[3].c_str(), nullptr);
        rows.push_back(row);
    }
    EXPECT_EQ(rows.size(), known.size());
    return rows;
}

double factorOf(const std::string& dataFolder, const std::string& id)
{
    for (const std::vector<std::string>& cells : table(dataFolder))
        if (cells[0] == id) return std::strtod(cells[2].c_str(), nullptr);
    ADD_FAILURE() << "no row " << id;
    return std::nan("");
}

} // namespace helio::test
