// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <benchmark/benchmark.h>

#include "engine/view/renderer.h"
#include "tools/bench/options.h"

namespace helio {

/// Bytes that a sweep must move if every array passes the memory once: links and rows, B read and E written by the
/// gather; E pushed down; the update of the patches; B pulled up; with linear senders their slopes, too.
double bytesOfSweep(const TileView& tile);

/// Runs every case under Google Benchmark, each once untimed and then options.repeats times, and hands the times to the
/// reporter and to the file that benchmark::Initialize was told.
void runCases(Context& context, const Pack& pack, Renderer& renderer, const Camera& camera, const BenchOptions& options,
              benchmark::BenchmarkReporter& reporter);

} // namespace helio
