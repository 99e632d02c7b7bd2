// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "city/base/types.h"

// What an import says about the features that it repairs and skips. Internal to city/layout.
namespace helio {

/// Counts features by kind and keeps the lines of the first 20 of each kind.
class ImportNotes
{
public:
    /// One thing done to a feature: the name of its count, and the words for its note.
    using Item = std::pair<std::string, std::string>;

    /// All that happened to one feature, in one line: "feature ID: words, words". Without items nothing happens.
    void feature(const std::string& id, const std::vector<Item>& items);
    /// A line of its own under a kind.
    void line(const std::string& kind, std::string text);
    /// A line that is always kept and not counted.
    void summary(std::string text) { lines_.push_back(std::move(text)); }
    void count(const std::string& kind, u32 by = 1) { counts_[kind] += by; }

    const std::map<std::string, u32>& counts() const { return counts_; }
    /// The lines, and one more for each kind of which some were left out.
    std::vector<std::string> take();

private:
    bool admits(const std::string& kind);

    std::vector<std::string> lines_;
    std::map<std::string, u32> counts_;
    std::map<std::string, u32> lineCounts_; ///< lines asked for, kept or not
};

} // namespace helio
