// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>

#include "city/grammar/error_list.h"
#include "city/grammar/program.h"

namespace helio::cga {

/// Names that mistakes have taken away: what uses them makes no second mistake.
struct BrokenNames
{
    std::set<std::string> names;    ///< with the imports' ids
    std::set<std::string> prefixes; ///< `id.` of imports that could not be read
    bool unknown = false;           ///< a name is lost that nobody knows

    /// True if `name` may be one of them.
    bool has(const std::string& name) const;
};

/// Binds every name of a parsed program to what it means, checks numbers of arguments and bare words, and finds the
/// start rule. Reported: an operation, function, selector or name that is unknown or not supported.
void resolveProgram(Program& program, const BrokenNames& broken, ErrorList& errors);

} // namespace helio::cga
