// SPDX-License-Identifier: Apache-2.0
// heliopolis-bake factors, run as a user runs it.
#include <cmath>
#include <gtest/gtest.h>
#include <sstream>

#include "city/base/file.h"
#include "tests/numeric/factor_rows.h"
#include "tests/unit/cli_runner.h"

namespace helio {
namespace {

using test::RunResult;
using test::TempFolder;

constexpr const char* kFloor = "[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]";
constexpr const char* kCeiling = "[[0,0,1],[0,1,1],[1,1,1],[1,0,1]]";
constexpr const char* kBlocker = "[[0.25,0.25,0.5],[0.75,0.25,0.5],[0.75,0.75,0.5],[0.25,0.75,0.5]]";

std::string pairText(const std::string& id, const std::string& a, const std::string& b, const std::string& more = "")
{
    return R"({"id":")" + id + R"(","a":)" + a + R"(,"b":)" + b + more + "}";
}

class FactorsCli : public testing::Test
{
protected:
    RunResult factors(const std::string& json, const std::string& more = "") const
    {
        EXPECT_TRUE(writeTextAtomically(temp_ / "pairs.json", json).ok());
        return test::runProgram(HELIO_BAKE, "factors pairs.json -o out.csv " + more, temp_.path());
    }

    /// One line that names the file and holds `what`, exit code 1, nothing written.
    void expectRefusal(const std::string& json, const std::string& what) const
    {
        const RunResult result = factors(json);
        EXPECT_EQ(result.exitCode, 1) << json;
        EXPECT_EQ(result.errorLines(), 1u) << result.err;
        EXPECT_NE(result.err.find("pairs.json"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(temp_ / "out.csv")) << json;
    }

    /// The cells of one line of the output, 0 = the head.
    std::vector<std::string> cells(size_t line) const
    {
        const Result<std::string> text = readTextFile(temp_ / "out.csv");
        EXPECT_TRUE(text.ok());
        std::istringstream lines(text ? *text : "");
        std::string row, cell;
        for (size_t k = 0; k <= line; ++k) std::getline(lines, row);
        std::istringstream parts(row);
        std::vector<std::string> out;
        while (std::getline(parts, cell, ',')) out.push_back(cell);
        return out;
    }

    TempFolder temp_;
};

TEST_F(FactorsCli, OneRowAPairInOrder)
{
    // Cube by Howell C-11; the occluded one by quadrature of the exact visible rectangle (0.0995062945990 visible).
    const std::string occluders = std::string(R"(,"occluders":[)") + kBlocker + "]";
    const std::string json =
        "[" + pairText("open", kFloor, kCeiling) + "," + pairText("half hidden", kFloor, kCeiling, occluders) + "]";
    const RunResult result = factors(json);
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(cells(0), (std::vector<std::string>{"id", "F_ab", "F_ba", "visibility", "error", "evaluations"}));
    const std::vector<std::string> open = cells(1), hidden = cells(2);
    ASSERT_EQ(open.size(), 6u);
    ASSERT_EQ(hidden.size(), 6u);
    EXPECT_EQ(open[0], "open");
    EXPECT_NEAR(std::stod(open[1]), 0.19982489569838738, 1e-9);
    EXPECT_NEAR(std::stod(open[2]), 0.19982489569838738, 1e-9);
    EXPECT_EQ(std::stod(open[3]), 1.0);
    EXPECT_LT(std::stod(open[4]), 1e-6);
    EXPECT_GT(std::stod(open[5]), 0.0);
    EXPECT_EQ(hidden[0], "half hidden");
    EXPECT_EQ(hidden[1], open[1]) << "F is without occluders";
    EXPECT_NEAR(std::stod(hidden[1]) * std::stod(hidden[3]), 0.09950629459898479, 1e-5);
}

TEST_F(FactorsCli, ReferenceIsMoreExactAndJobsChangeNothing)
{
    // The 60-degree pair needs quadrature: R01 with 19 digits.
    const std::string json =
        "[" + pairText("R01", kFloor, "[[0,0,0],[0,1,0],[0.5,1,0.8660254037844386],[0.5,0,0.8660254037844386]]") + "]";
    ASSERT_EQ(factors(json, "--jobs 1").exitCode, 0);
    const Result<std::string> one = readTextFile(temp_ / "out.csv");
    const double error = std::stod(cells(1)[4]);
    ASSERT_EQ(factors(json, "--jobs 3").exitCode, 0);
    const Result<std::string> three = readTextFile(temp_ / "out.csv");
    ASSERT_TRUE(one && three);
    EXPECT_EQ(*one, *three);
    ASSERT_EQ(factors(json, "--reference").exitCode, 0);
    EXPECT_NEAR(std::stod(cells(1)[1]), 0.3709053211500514359, 1e-14);
    EXPECT_LT(std::stod(cells(1)[4]), error);
}

/// Corners as JSON, all digits kept.
std::string ringText(const Ring3& ring)
{
    std::ostringstream out;
    out.precision(17);
    const char* separator = "[";
    for (const glm::dvec3& p : ring) {
        out << separator << '[' << p.x << ',' << p.y << ',' << p.z << ']';
        separator = ",";
    }
    out << ']';
    return out.str();
}

TEST_F(FactorsCli, EveryPairOfTheTable)
{
    // At home and at map coordinates; production and reference. Corners of U01, and all that are moved, are rounded to
    // 1e-9 m.
    const std::vector<test::FactorRow> rows = test::factorRows(HELIO_TEST_DATA_DIR);
    ASSERT_GT(rows.size(), 25u);
    const glm::dvec3 map(5e5, 4.5e6, 0.0);
    std::ostringstream json;
    json << '[';
    for (const bool far : {false, true})
        for (const test::FactorRow& row : rows) {
            const glm::dvec3 offset = far ? map : glm::dvec3(0.0);
            const auto text = [&](const Ring3& ring) { return ringText(test::moved(ring, offset)); };
            json << (json.tellp() > 1 ? "," : "") << R"({"id":")" << row.id << (far ? " far" : "") << R"(","a":)"
                 << text(row.pair.a) << R"(,"b":)" << text(row.pair.b) << R"(,"occluders":[)";
            for (const Ring3& ring : row.occluders) json << (&ring == row.occluders.data() ? "" : ",") << text(ring);
            json << "]}";
        }
    json << ']';
    for (const bool reference : {false, true}) {
        const RunResult result = factors(json.str(), reference ? "--reference" : "");
        ASSERT_EQ(result.exitCode, 0) << result.err;
        for (size_t k = 0; k < 2 * rows.size(); ++k) {
            const test::FactorRow& row = rows[k % rows.size()];
            const bool far = k >= rows.size();
            const std::vector<std::string> values = cells(k + 1);
            ASSERT_EQ(values.size(), 6u);
            EXPECT_EQ(values[0], row.id + (far ? " far" : ""));
            const double ab = std::stod(values[1]), ba = std::stod(values[2]), visibility = std::stod(values[3]);
            for (const double share : {ab, ba, visibility}) EXPECT_TRUE(share >= 0.0 && share <= 1.0) << values[0];
            // Occluded rows: 1e-4 is asked for, both times.
            double bound = reference ? 1e-9 : 1e-4;
            if (!row.occluders.empty()) bound = 1e-4;
            if (row.id == "U01") bound = std::max(bound, 2e-8);
            if (far) bound = 1e-6 + (row.occluders.empty() ? 0.0 : 1e-4);
            EXPECT_NEAR(ab * visibility / row.ab, 1.0, bound) << values[0];
            EXPECT_NEAR(ba * visibility / row.ba, 1.0, bound) << values[0];
        }
    }
}

TEST_F(FactorsCli, BadInputIsRefusedInOneLine)
{
    expectRefusal("[{]", "not JSON");
    expectRefusal("{}", "a list of");
    expectRefusal("[7]", "pair 0");
    expectRefusal("[" + pairText("x,y", kFloor, kCeiling) + "]", "the id needs");
    expectRefusal("[" + pairText("p", kFloor, kCeiling) + "," + pairText("p", kFloor, kCeiling) + "]", "twice");
    expectRefusal(R"([{"id":"p","a":)" + std::string(kFloor) + "}]", "pair p: \"b\" is missing");
    expectRefusal("[" + pairText("p", "[[0,0,0],[1,0,0]]", kCeiling) + "]", "pair p: a: 2 corners");
    expectRefusal("[" + pairText("p", "[[0,0,0],[1,0,0],[2,0,0]]", kCeiling) + "]",
                  "pair p: a: the polygon has no area");
    expectRefusal("[" + pairText("p", "[[0,0],[1,0],[1,1]]", kCeiling) + "]", "pair p: a: corner 0 is not");
    expectRefusal("[" + pairText("p", "[[0,0,0],[1,0,0],[1,1,1e12]]", kCeiling) + "]",
                  "pair p: a: corner 2 lies beyond");
    expectRefusal("[" + pairText("p", kFloor, "[[0,0,1],[0,1,1.1],[1,1,1],[1,0,1]]") + "]", "off the plane");
    expectRefusal("[" + pairText("p", kFloor, "[[0,0,1],[2,0,1],[0,1,1],[1,1,1],[1,3,1]]") + "]", "cross");
    expectRefusal("[" + pairText("p", kFloor, kCeiling, R"(,"occluders":[7])") + "]", "pair p: occluder 0");
    expectRefusal("[" + pairText("p", kFloor, kCeiling, R"(,"occluders":7)") + "]", "pair p: \"occluders\"");
    const RunResult missing = test::runProgram(HELIO_BAKE, "factors none.json -o out.csv", temp_.path());
    EXPECT_EQ(missing.exitCode, 1);
    EXPECT_NE(missing.err.find("none.json"), std::string::npos) << missing.err;
    EXPECT_EQ(test::runProgram(HELIO_BAKE, "factors pairs.json", temp_.path()).exitCode, 1) << "-o is needed";
    const RunResult target = test::runProgram(HELIO_BAKE, "factors pairs.json -o no/such/out.csv", temp_.path());
    EXPECT_EQ(target.exitCode, 1);
    EXPECT_NE(target.err.find("no/such"), std::string::npos) << target.err;
}

TEST_F(FactorsCli, AnEmptyListGivesTheHeadAlone)
{
    ASSERT_EQ(factors("[]").exitCode, 0);
    const Result<std::string> text = readTextFile(temp_ / "out.csv");
    ASSERT_TRUE(text.ok());
    EXPECT_EQ(*text, "id,F_ab,F_ba,visibility,error,evaluations\n");
}

} // namespace
} // namespace helio
