// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio {

/// The command line of heliopolis-bench.
struct BenchOptions
{
    std::string pack, json, device, only, camera = "aerial", size = "1280x720";
    std::vector<std::string> compare; ///< two files of --json, or none
    u32 width = 0, height = 0, repeats = 9, copyMiB = 64;
    double residual = 1e-3, sunTexel = 0.0;
};

/// Parses the command line. `done` is set when the program has nothing more to do (--help). Errors: one line each.
Result<BenchOptions> parseCommandLine(int argc, char** argv, bool& done);

} // namespace helio
