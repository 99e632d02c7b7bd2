// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tools/bench/case_list.h"

namespace helio {

/// Stage 2 on the sun's picture of a made-up city, about 4096^2 texels and 100,000 patches, against the pass that only
/// reads, one atomic a texel, and the same runs counted by two threads of the host. Aborts when a variant's counts are
/// not those of the host.
void addHistogramCases(CaseList& cases);

} // namespace helio
