// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
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

/// Prints the one line that a problem gets, after the program's name, and gives the code back.
inline int complain(std::string message, ExitCode code)
{
    std::replace(message.begin(), message.end(), '\n', ' ');
    std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, message.c_str());
    return code;
}

} // namespace helio
