// SPDX-License-Identifier: Apache-2.0
// Whole solutions against tests/data/closed_forms/solutions.csv: with exact factors, where nothing but the patches'
// size is left as an error, by paths, and as the bake solves them at its default error.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "tests/numeric/exact_light.h"
#include "tests/numeric/solution_scenes.h"

using namespace helio;
using namespace helio::test;

namespace {

/// The solutions of all rows; scenes that rows share are solved once.
class Cache
{
public:
    template <class Solve> double value(const SolutionRow& row, const Solve& solve)
    {
        const std::string scene = sceneOf(row.id);
        const auto found = scenes_.find(scene);
        const Quantities& quantities = found != scenes_.end() ? found->second : scenes_[scene] = solve(scene);
        const auto at = quantities.find(row.quantity);
        EXPECT_NE(at, quantities.end()) << row.id << ": nothing is called " << row.quantity;
        return at != quantities.end() ? at->second : std::nan("");
    }

private:
    std::map<std::string, Quantities> scenes_;
};

} // namespace

TEST(Solutions, OneRadiosityAFaceAsInTheTable)
{
    Cache cache;
    u32 checked = 0;
    for (const SolutionRow& row : solutionRows(HELIO_TEST_DATA)) {
        if (std::isnan(row.onePatch)) continue; // the sky's rows
        const double value = cache.value(row, [](const std::string& scene) { return solveExactly(scene, 1); });
        EXPECT_NEAR(value, row.onePatch, 2e-6 * row.onePatch) << row.id << " " << row.quantity;
        ++checked;
    }
    EXPECT_EQ(checked, 12u);
}

TEST(Solutions, ExactFactorsConvergeWithAnOrderOfAtLeastOneAndAHalf)
{
    Cache caches[3];
    for (const SolutionRow& row : solutionRows(HELIO_TEST_DATA)) {
        if (std::isnan(row.onePatch)) continue;
        constexpr u32 kPatches[] = {3, 6, 12}; // along an edge
        double error[3];
        for (u32 k = 0; k < 3; ++k) {
            const auto solve = [n = kPatches[k]](const std::string& scene) { return solveExactly(scene, n); };
            error[k] = caches[k].value(row, solve) / row.converged - 1.0;
        }
        const double first = orderOf(error[0], error[1]), second = orderOf(error[1], error[2]);
        std::printf("%s %-40s n = 3, 6, 12: %+.2e %+.2e %+.2e, orders %.2f %.2f\n", row.id.c_str(),
                    row.quantity.c_str(), error[0], error[1], error[2], first, second);
        EXPECT_GE(first, 1.5) << row.id << " " << row.quantity;
        EXPECT_GE(second, 1.5) << row.id << " " << row.quantity;
        EXPECT_LT(std::abs(error[2]), 3e-3) << row.id << " " << row.quantity;
    }
}

TEST(Solutions, SkyRowsByQuadrature)
{
    u32 checked = 0;
    for (const SolutionRow& row : solutionRows(HELIO_TEST_DATA)) {
        if (!std::isnan(row.onePatch)) continue;
        EXPECT_NEAR(solveExactly(sceneOf(row.id), 150).at(row.quantity), row.converged, 2e-8) << row.id;
        ++checked;
    }
    EXPECT_EQ(checked, 4u);
}

TEST(Solutions, PathsGiveTheConvergedMeans)
{
    std::map<std::string, std::map<std::string, Traced>> scenes;
    for (const SolutionRow& row : solutionRows(HELIO_TEST_DATA)) {
        if (std::isnan(row.onePatch)) continue; // rows of points under a sky
        const std::string scene = sceneOf(row.id);
        if (!scenes.contains(scene)) scenes[scene] = solveTraced(scene, 65536);
        const Traced traced = scenes[scene].at(row.quantity);
        std::printf("%s %-40s %.6f +- %.6f, %+.2f standard errors\n", row.id.c_str(), row.quantity.c_str(),
                    traced.value, traced.error, (traced.value - row.converged) / traced.error);
        EXPECT_GT(traced.error, 0.0);
        EXPECT_LT(traced.error, 0.02 * row.converged) << row.id << " " << row.quantity;
        EXPECT_NEAR(traced.value, row.converged, 4.0 * traced.error + 1e-5) << row.id << " " << row.quantity;
    }
}

TEST(Solutions, TheDefaultErrorIsWithinHalfAPercent)
{
    Cache cache;
    for (const SolutionRow& row : solutionRows(HELIO_TEST_DATA)) {
        const double value = cache.value(row, [](const std::string& scene) { return solveBaked(scene, 577); });
        std::printf("%s %-40s %.6f, %+.3f %%\n", row.id.c_str(), row.quantity.c_str(), value,
                    100.0 * (value / row.converged - 1.0));
        EXPECT_NEAR(value / row.converged, 1.0, 5e-3) << row.id << " " << row.quantity;
    }
}
