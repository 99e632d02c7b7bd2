// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/interrupt.h"

#include <array>
#include <csignal>
#include <cstdlib>

namespace helio {
namespace {

constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t caughtSignal = 0;

} // namespace

InterruptGuard::InterruptGuard()
{
    caughtSignal = 0;
    for (size_t i = 0; i < kSignals.size(); ++i) {
        before_[i] = std::signal(kSignals[i], [](int number) { caughtSignal = number; });
        // What the caller ignores (nohup, a job in the background) stays ignored.
        if (before_[i] == SIG_IGN) std::signal(kSignals[i], SIG_IGN);
    }
    beforeTooLarge_ = std::signal(SIGXFSZ, SIG_IGN); // A file that grows too large is a failed write, reported as such.
}

InterruptGuard::~InterruptGuard()
{
    for (size_t i = 0; i < kSignals.size(); ++i) std::signal(kSignals[i], before_[i]);
    std::signal(SIGXFSZ, beforeTooLarge_);
}

int InterruptGuard::caught()
{
    return caughtSignal;
}

void dieOf(int signal)
{
    std::signal(signal, SIG_DFL);
    std::raise(signal);
    std::exit(128 + signal); // Reached only where the signal is blocked.
}

} // namespace helio
