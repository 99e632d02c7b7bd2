// SPDX-License-Identifier: Apache-2.0
#include "city/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "city/base/check.h"

namespace helio {

u32 workerCount(u32 jobs)
{
    return jobs > 0 ? jobs : std::max(1u, std::thread::hardware_concurrency());
}

void parallelFor(u32 count, u32 grain, u32 jobs, const std::function<void(u32, u32)>& body)
{
    HELIO_CHECK(grain > 0, "grain = ", grain);
    const u32 chunkCount = count / grain + (count % grain != 0);
    std::atomic<u32> next{0};
    std::atomic<bool> stopped{false};
    std::mutex failureLock;
    std::exception_ptr failure;
    const auto work = [&] {
        try {
            for (u32 chunk = next++; chunk < chunkCount && !stopped; chunk = next++) {
                const u32 begin = chunk * grain;
                body(begin, std::min(count - begin, grain) + begin);
            }
        } catch (...) { // Out of memory, say: it belongs to the caller, and would end the program here.
            const std::lock_guard guard(failureLock);
            if (!failure) failure = std::current_exception();
            stopped = true;
        }
    };
    std::vector<std::thread> threads;
    try {
        const u32 workers = std::min(workerCount(jobs), chunkCount);
        for (u32 i = 1; i < workers; ++i) threads.emplace_back(work);
    } catch (const std::exception&) {
        // The system gives no more threads (or no memory for them): those there are do the work.
    }
    work();
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

} // namespace helio
