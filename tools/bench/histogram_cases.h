// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tools/bench/case_list.h"

namespace helio {

/// Stage 2 on a picture of 4096^2 texels with 100,000 patches and background, against the pass that only reads, one
/// atomic a texel, and the same runs counted by two threads of the host. Aborts when a variant's counts are not those
/// of the host.
void addHistogramCases(CaseList& cases);

} // namespace helio
