// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/base/types.h"
#include "tools/bake/sun_option.h"

namespace helio {

/// `heliopolis-bake export PACK`.
struct ExportOptions
{
    std::string pack, surfaces, radiance, mitsuba;
    SunOptions light;
    u32 points = 16, meters = 0;
};

/// Adds the subcommand; `options` must outlive the parsing.
CLI::App* addExportCommand(CLI::App& app, ExportOptions& options);

/// Writes what is asked for, at least one scene; gives an exit code.
int runExport(const ExportOptions& options);

} // namespace helio
