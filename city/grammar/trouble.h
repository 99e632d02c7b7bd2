// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <vector>

#include "city/grammar/lexer.h"
#include "city/grammar/limits.h"

namespace helio::cga {

/// Errors, warnings and the work budget of one building. The first error sticks; everything that follows sees failed()
/// and stops.
class Trouble
{
public:
    Trouble(std::string_view fileName, std::string_view building) : fileName_(fileName), building_(building) {}

    void fail(Place place, std::string_view message)
    {
        if (!failed()) error_ = errorAt(fileName_, place, concat("building '", building_, "': ", message));
    }
    bool failed() const { return !error_.message.empty(); }
    const Error& error() const { return error_; }

    /// Every text is kept once, so warnings must not name the building.
    void warn(Place place, std::string_view message)
    {
        std::string line = errorAt(fileName_, place, message).message;
        if (seen_.size() < kMaxWarnings && seen_.insert(line).second) warnings_.push_back(std::move(line));
    }
    const std::vector<std::string>& warnings() const { return warnings_; }

    /// Charges work; fails when the building's budget is spent, so that no rule runs for ever.
    void spend(Place place, u64 steps)
    {
        steps_ += steps;
        if (steps_ > kMaxSteps)
            fail(place, concat("the rules take more than ", kMaxSteps,
                               " steps: look for a recursion that multiplies, or use larger sizes"));
    }

private:
    static constexpr size_t kMaxWarnings = 100;
    std::string_view fileName_, building_;
    Error error_;
    std::set<std::string> seen_;
    std::vector<std::string> warnings_;
    u64 steps_ = 0;
};

} // namespace helio::cga
