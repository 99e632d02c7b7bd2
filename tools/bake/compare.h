// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace helio {

/// `heliopolis-bake compare TABLE.csv REF.csv`.
struct CompareOptions
{
    std::string table, reference;
    bool json = false;
};

/// Adds the subcommand; `options` must outlive the parsing.
CLI::App* addCompareCommand(CLI::App& app, CompareOptions& options);

/// Prints the errors of a table of light against a reference, area weighted over all patches, in % of the reference's
/// mean, averaged over r, g and b and for solar alone; gives an exit code. Rows must be the same patches with the same
/// areas (to 1e-4).
int runCompare(const CompareOptions& options);

} // namespace helio
