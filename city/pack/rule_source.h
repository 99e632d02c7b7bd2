// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "city/base/result.h"
#include "city/grammar/rules.h"

namespace helio {

/// A rule file with all that it imports, ready to derive.
struct RuleSource
{
    RuleSet rules;
    std::string name; ///< of the file, without its folder
    u64 hash = 0;     ///< of the texts of all files
};

/// Reads the rule file at `path`, or the shipped file of that name where no such file exists ("tower.cga"). Imports are
/// looked up beside the file that names them; those of a shipped file among the shipped ones. `style`: empty = Default.
/// Errors: not readable, and those of parseRules.
Result<RuleSource> readRules(const std::filesystem::path& path, const std::string& style);

} // namespace helio
