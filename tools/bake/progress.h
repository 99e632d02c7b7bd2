// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace helio {

/// One line on stderr that is overwritten as the work goes on. Silent unless stderr is a terminal, so that a log holds
/// errors alone.
class ProgressLine
{
public:
    ProgressLine();
    ~ProgressLine() { clear(); }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// `done` in 0..1.
    void show(const char* step, double done);
    /// Wipes the line, for other output to take its place.
    void clear();

private:
    bool terminal_;
    std::string shown_;
};

} // namespace helio
