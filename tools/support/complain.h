// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cerrno>
#include <cstdio>
#include <string>

namespace helio {

/// What the programs end with.
enum ExitCode
{
    kOk = 0,
    kBadInput = 1, ///< or usage
    kInternal = 2  ///< or no device
};

/// Prints what is wrong after the program's name, and gives the code back: one line, or for a text with mistakes (rule
/// files) a line each with what it points at.
inline int complain(const std::string& message, ExitCode code)
{
    std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, message.c_str());
    return code;
}

} // namespace helio
