// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/base/types.h"
#include "tools/bake/sun_option.h"

namespace helio {

/// `heliopolis-bake reference PACK -o REF.csv`.
struct ReferenceOptions
{
    std::string pack, output;
    SunOptions light;
    u32 samples = 1024, jobs = 0;
    u64 seed = 1;
    bool sunDisc = false; ///< the sun is a disc with penumbras, not a point
    bool noEmission = false;
    bool firstHand = false;
};

/// Adds the subcommand; `options` must outlive the parsing.
CLI::App* addReferenceCommand(CLI::App& app, ReferenceOptions& options);

/// Traces, writes the table, prints a summary; gives an exit code.
int runReference(const ReferenceOptions& options);

} // namespace helio
