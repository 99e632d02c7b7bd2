// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

namespace helio {

/// Errors of a result against a reference, relative to the reference's area mean.
struct ErrorMetrics
{
    double rms =
        0.0; ///< sqrt(<(e - r)^2> - <se^2>) / <r>: the reference's own noise is subtracted; 0 when the noise is larger
    double bias = 0.0;      ///< <e - r> / <r>
    double p95 = 0.0;       ///< area-weighted 95th percentile of |e - r| / <r>; holds the reference's noise
    double largest = 0.0;   ///< max |e - r| / <r>; holds the reference's noise
    double noise = 0.0;     ///< sqrt(<se^2>) / <r>
    double biasError = 0.0; ///< standard error of <r> over <r>: no bias below twice this means anything
    double mean = 0.0;      ///< <r>
};

/// `area`, `result`, `reference` and `referenceSe` (standard error) have one entry a face; only faces with keep != 0
/// count. Infinite errors for lengths that differ, for values that are not finite, for a reference that is zero
/// everywhere while the result is not, and for no face at all.
ErrorMetrics compare(const std::vector<double>& area, const std::vector<double>& result,
                     const std::vector<double>& reference, const std::vector<double>& referenceSe,
                     const std::vector<bool>& keep);

} // namespace helio
