// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio {

namespace cga {
struct Program;
}

/// A parsed rule file, ready to derive. Cheap to copy and safe to share between threads.
class RuleSet
{
public:
    explicit RuleSet(std::shared_ptr<const cga::Program> program) : program_(std::move(program)) {}

    const cga::Program& program() const { return *program_; }
    /// Names of the `attr` declarations, in the order of the file: what an attribute override may set.
    std::vector<std::string> attributeNames() const;
    u32 ruleCount() const;

private:
    std::shared_ptr<const cga::Program> program_;
};

/// Parses CGA text (see README.md for the part of the language that is read). `fileName` only serves the messages.
/// Errors are one line, `file:line:column: what is wrong, and what to use instead`. Any text gives a RuleSet or an
/// error: nesting, length and names are limited, so no input can overflow the stack.
Result<RuleSet> parseRules(std::string_view text, std::string_view fileName);

} // namespace helio
