// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/interrupt.h"

#include <csignal>
#include <cstdlib>
#include <initializer_list>

namespace helio {
namespace {

volatile std::sig_atomic_t caughtSignal = 0;

} // namespace

InterruptGuard::InterruptGuard()
{
    caughtSignal = 0;
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int number) { caughtSignal = number; });
}

InterruptGuard::~InterruptGuard()
{
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
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
