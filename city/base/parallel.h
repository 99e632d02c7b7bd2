// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "city/base/types.h"

namespace helio {

/// Number of worker threads: `jobs` if positive, else the number of cores.
u32 workerCount(u32 jobs);

/// Calls body(begin, end) for consecutive chunks of [0, count) of at most `grain` items on `jobs` threads (0 = all
/// cores). Chunks are handed out in order, and their borders do not depend on `jobs`: a body that writes only to the
/// places of its own items gives the same bytes for every number of threads. An exception of the body stops the handing
/// out and comes out here (one of them, if there are several).
void parallelFor(u32 count, u32 grain, u32 jobs, const std::function<void(u32 begin, u32 end)>& body);

} // namespace helio
