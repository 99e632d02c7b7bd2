// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sstream>
#include <string>

namespace helio {

/// Prints the failed condition with its values and aborts, in release builds too.
[[noreturn]] void failCheck(const char* file, int line, const char* condition, const std::string& values);

/// Writes its arguments one after the other, for the messages of checks and errors.
template <class... Ts> std::string concat(const Ts&... parts)
{
    std::ostringstream out;
    (void)(out << ... << parts);
    return out.str();
}

} // namespace helio

/// A programmer error: aborts with the condition and the values that follow it. Never for bad input (see Result).
#define HELIO_CHECK(condition, ...)                                                                                    \
    do {                                                                                                               \
        if (!(condition)) ::helio::failCheck(__FILE__, __LINE__, #condition, ::helio::concat(__VA_ARGS__));            \
    } while (false)
