// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "tests/numeric/pair_fixtures.h"

namespace helio::test {

/// A pair of tests/data/closed_forms/formfactors.csv.
struct FactorRow
{
    std::string id;
    PairRings pair;
    std::vector<Ring3> occluders;
    double ab = 0.0, ba = 0.0; ///< form factors, times the visibility where there are occluders
};

/// The rows that are pairs of polygons, in the file's order, with the geometry of each. Rows of points and of endless
/// strips have tests of their own; a row that is neither fails the running test. `dataFolder` is tests/data.
std::vector<FactorRow> factorRows(const std::string& dataFolder);

/// The form factor of a row by its id, for rows of points and strips.
double factorOf(const std::string& dataFolder, const std::string& id);

} // namespace helio::test
