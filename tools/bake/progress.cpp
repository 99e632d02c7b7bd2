// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/progress.h"

#include <cstdio>
#include <unistd.h>

#include "city/base/check.h"

namespace helio {

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(const char* step, double done)
{
    const std::string text = done > 0.0 ? concat(step, ' ', int(100.0 * done), " %") : std::string(step);
    if (!terminal_ || text == shown_) return;
    shown_ = text;
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    std::fflush(stderr);
}

void ProgressLine::clear()
{
    if (terminal_ && !shown_.empty()) std::fprintf(stderr, "\r\033[K");
    shown_.clear();
}

} // namespace helio
