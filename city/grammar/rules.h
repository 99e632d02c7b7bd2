// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio {

namespace cga {
struct Program;
struct Annotation;
struct SourceFile;
} // namespace cga

/// What parsing depends on besides the text.
struct RuleOptions
{
    std::string style; ///< the style of the rule file that is in force; empty: Default
    /// Text of an imported file. `path`: as the import writes it, resolved against the folder of the importing file's
    /// name. Called once per path. Empty: imports are refused.
    std::function<Result<std::string>(const std::string& path)> readImport;
};

/// An attribute of a rule file that may be set.
struct RuleAttribute
{
    enum class Kind : u8
    {
        Unknown, ///< the default is an expression
        Number,
        Bool,
        Text
    };
    std::string name;        ///< with the import's id in front, `id.name`, if it is an import's
    std::string defaultText; ///< the value as written, at most 240 characters
    Kind kind = Kind::Unknown;
    /// Of the declaration, as written: @Range, @Enum, @Group, @Order, @Color, @Description, ...
    const std::vector<cga::Annotation>* annotations = nullptr; ///< lives as long as the RuleSet
};

/// A parsed rule file, ready to derive. Cheap to copy and safe to share between threads.
class RuleSet
{
public:
    explicit RuleSet(std::shared_ptr<const cga::Program> program) : program_(std::move(program)) {}

    const cga::Program& program() const { return *program_; }
    /// Names of the attributes, in the order of the files: what an attribute override may set.
    std::vector<std::string> attributeNames() const;
    /// The same with all that a user interface needs.
    std::vector<RuleAttribute> attributes() const;
    u32 ruleCount() const;
    /// Names of the rules, in the order of the files; a name once for each number of parameters.
    std::vector<std::string> ruleNames() const;
    /// Styles of the rule file itself, Default first.
    const std::vector<std::string>& styles() const;
    /// All that was read, the rule file first: names and texts, for a hash of what the rules depend on.
    const std::vector<cga::SourceFile>& files() const;

private:
    std::shared_ptr<const cga::Program> program_;
};

/// Parses CGA text (see README.md for the part of the language that is read) and what it imports. `fileName` serves the
/// messages, and the paths of imports are resolved against its folder.
/// Errors: up to 20 mistakes, each as `file:line:column: what is wrong, and what to use instead` followed by the line
/// of the text and a caret under the column; lines are separated by newlines. Any text gives a RuleSet or an error:
/// nesting, length, names and imports are limited, so no input can overflow the stack.
Result<RuleSet> parseRules(std::string_view text, std::string_view fileName, const RuleOptions& options = {});

} // namespace helio
