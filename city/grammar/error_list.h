// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "city/base/result.h"
#include "city/grammar/program.h"

namespace helio::cga {

/// The mistakes in the files of a program: the first of every place, and of all places the first kMaxErrors in the
/// order of the text.
class ErrorList
{
public:
    /// `files` may grow while the list lives.
    explicit ErrorList(const std::vector<SourceFile>& files) : files_(files) {}

    void report(Place place, std::string_view message);
    /// Adds the mistakes of another list over the same files (or files that only grew).
    void merge(const ErrorList& other);
    bool empty() const { return messages_.empty(); }

    /// Each mistake as `file:line:column: message`, the line of the text and a caret under the column; then a line that
    /// says if there are more. Precondition: not empty.
    Error join() const;

private:
    const std::vector<SourceFile>& files_;
    std::map<std::tuple<u32, u32, u32>, std::string> messages_; ///< by file, line, column
    bool more_ = false;
};

/// The line of a place and a caret line under its column (each indented by four spaces, separated by a newline); empty
/// if the line is empty. Lines longer than 100 columns are cut around the column.
std::string excerptOf(std::string_view text, Place place);

} // namespace helio::cga
