// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

#include "city/base/types.h"

namespace helio::test {

/// A row of tests/data/closed_forms/solutions.csv.
struct SolutionRow
{
    std::string id, quantity;
    double onePatch = 0.0; ///< with one radiosity a face; NaN where there is none
    double converged = 0.0;
};
std::vector<SolutionRow> solutionRows(const std::string& dataFolder);

/// The id that stands for a row's scene: that of the first row of it.
std::string sceneOf(const std::string& id);

/// Values by the names of the table's quantities.
using Quantities = std::map<std::string, double>;

/// A scene with exact factors and n patches along each edge, solved by elimination. Cube and courtyard:
/// factors by exchange(), the courtyard's opening a black emitter. Canyons: endless, crossed strings. Rows of the sky:
/// Simpson's rule over it with 2 n intervals each way.
Quantities solveExactly(const std::string& scene, u32 n);

/// The same by bakeLight with its defaults and solveLight; faces are cut beforehand, finest at their edges. The sky
/// comes through the bake's sky rows (rows of a CIE sky: `skyPatches` cells). The canyons are 5 km long and 10 m wide,
/// cut in 15; what counts are the middle nine.
Quantities solveBaked(const std::string& scene, u32 skyPatches);

/// A value and its standard error.
struct Traced
{
    double value = 0.0, error = 0.0;
};
/// A room or canyon by paths over one patch a face (canyons as in solveBaked), whose means are those of the continuous
/// solution; albedos as what is not absorbed.
std::map<std::string, Traced> solveTraced(const std::string& scene, u32 samples);

} // namespace helio::test
