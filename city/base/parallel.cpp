// SPDX-License-Identifier: Apache-2.0
#include "city/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "city/base/check.h"

namespace helio {

u32 workerCount(u32 jobs) { return jobs > 0 ? jobs : std::max(1u, std::thread::hardware_concurrency()); }

void parallelFor(u32 count, u32 grain, u32 jobs, const std::function<void(u32, u32)>& body)
{
    HELIO_CHECK(grain > 0, "grain = ", grain);
    const u32 chunkCount = count / grain + (count % grain != 0);
    std::atomic<u32> next{0};
    const auto work = [&] {
        for (u32 chunk = next++; chunk < chunkCount; chunk = next++) {
            const u32 begin = chunk * grain;
            body(begin, std::min(count - begin, grain) + begin);
        }
    };
    std::vector<std::thread> threads;
    for (u32 i = 1; i < std::min(workerCount(jobs), chunkCount); ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
}

} // namespace helio
