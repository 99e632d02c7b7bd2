// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/base/result.h"
#include "city/grammar/program.h"

namespace helio::cga {

/// Binds every name of a parsed program to what it means, checks numbers of arguments and bare words, and finds the
/// start rule. Errors: `file:line:column: ...` for an operation, function, selector or name that is unknown or not
/// supported.
Status resolveProgram(Program& program);

} // namespace helio::cga
