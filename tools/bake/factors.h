// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio {

struct FactorOptions
{
    std::string pairs, output; ///< JSON to read, CSV to write
    bool reference = false;    ///< reference accuracy instead of production
    u32 jobs = 0;              ///< threads; 0 = all cores
};

/// Form factors and visibility of every pair of a list (see readPolygonPairs), as a CSV file with one row a pair in
/// their order: id, F_ab, F_ba, visibility, error, evaluations. F is without occluders; error is the estimated error of
/// F_ab and of F_ab x visibility as a fraction of F_ab. The bytes do not depend on the number of threads. Prints one
/// line when done.
Status writeFactors(const FactorOptions& options);

} // namespace helio
