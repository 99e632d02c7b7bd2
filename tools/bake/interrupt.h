// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

namespace helio {

/// While it lives, Ctrl-C, SIGTERM and SIGHUP only set a flag, so that a half-written pack can be removed; the
/// destructor gives the signals back. Before and after it they end the program at once, as there is nothing to clean
/// up.
class InterruptGuard
{
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    /// The signal that came, or 0.
    static int caught();

private:
    std::array<void (*)(int), 3> before_;
    void (*beforeTooLarge_)(int);
};

/// Ends the program as the signal would have.
[[noreturn]] void dieOf(int signal);

} // namespace helio
