// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <vector>

#include "city/grammar/limits.h"
#include "city/grammar/program.h"

namespace helio::cga {

/// A line for the user; of several with the same key only the first is kept, over all buildings.
struct Warning
{
    std::string key, text;
};

/// Errors, warnings and the work budget of one building. The first error sticks; everything that follows sees failed()
/// and stops.
class Trouble
{
public:
    Trouble(const std::vector<SourceFile>& files, std::string_view building, u64 maxSteps = kMaxSteps)
        : files_(files), building_(building), maxSteps_(maxSteps)
    {
    }

    void fail(Place place, std::string_view message)
    {
        if (!failed()) error_ = errorAt(fileOf(place), place, concat("building '", building_, "': ", message));
    }
    bool failed() const { return !error_.message.empty(); }
    const Error& error() const { return error_; }

    /// Every text is kept once, so warnings must not name the building.
    void warn(Place place, std::string_view message) { warnOnce(place, message, ""); }
    /// The detail (which building, which value) belongs to the first warning with this message.
    void warnOnce(Place place, std::string_view message, std::string_view detail)
    {
        std::string line = errorAt(fileOf(place), place, message).message;
        if (seen_.size() >= kMaxWarnings || !seen_.insert(line).second) return;
        warnings_.push_back({line, concat(line, detail)});
    }
    const std::vector<Warning>& warnings() const { return warnings_; }

    /// Charges work; fails when the building's budget is spent, so that no rule runs for ever.
    void spend(Place place, u64 steps)
    {
        steps_ += steps;
        if (steps_ > maxSteps_)
            fail(place, concat("the rules take more than ", maxSteps_,
                               " steps: look for a recursion that multiplies, or use larger sizes"));
    }

private:
    std::string_view fileOf(Place place) const { return files_[place.file].name; }

    static constexpr size_t kMaxWarnings = 100;
    const std::vector<SourceFile>& files_;
    std::string_view building_;
    Error error_;
    std::set<std::string> seen_;
    std::vector<Warning> warnings_;
    u64 maxSteps_, steps_ = 0;
};

} // namespace helio::cga
