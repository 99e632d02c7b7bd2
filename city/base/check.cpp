// SPDX-License-Identifier: Apache-2.0
#include "city/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace helio {

void failCheck(const char* file, int line, const char* condition, const std::string& values)
{
    std::fprintf(stderr, "internal error: %s:%d: %s does not hold%s%s\n", file, line, condition,
                 values.empty() ? "" : ": ", values.c_str());
    std::abort();
}

} // namespace helio
