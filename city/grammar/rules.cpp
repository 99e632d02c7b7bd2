// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/rules.h"

#include "city/grammar/limits.h"
#include "city/grammar/program_loader.h"

namespace helio {

namespace {

using namespace cga;

RuleAttribute::Kind kindOf(const Expr& value)
{
    switch (value.kind) {
    case ExprKind::Number:
        return RuleAttribute::Kind::Number;
    case ExprKind::Text:
        return RuleAttribute::Kind::Text;
    case ExprKind::Bool:
        return RuleAttribute::Kind::Bool;
    case ExprKind::Negate:
        return RuleAttribute::Kind::Number;
    default:
        return RuleAttribute::Kind::Unknown;
    }
}

void loadProgram(Program& program, const std::string& style, const RuleOptions& options, ErrorList& errors)
{
    ProgramLoader loader(program, options, errors);
    loader.load(style);
    resolveProgram(program, loader.broken(), errors);
}

/// Loads the styles that are not in force, only to find the mistakes in them.
void checkOtherStyles(const Program& program, const RuleOptions& options, ErrorList& errors)
{
    u64 bytes = 0;
    for (u32 k = 0; k < program.styles.size() && k < kMaxStyles; ++k) {
        if (program.styles[k] == program.style) continue;
        for (const SourceFile& file : program.files) bytes += file.text.size();
        if (bytes > kMaxSourceBytes) return; // a file of this size would take too long
        Program other;
        other.files = program.files;
        ErrorList found(other.files);
        loadProgram(other, program.styles[k], options, found);
        errors.merge(found);
    }
}

} // namespace

std::vector<std::string> RuleSet::attributeNames() const
{
    std::vector<std::string> names;
    for (const Global& global : program_->globals)
        if (global.kind == GlobalKind::Attribute) names.push_back(global.name);
    return names;
}

std::vector<RuleAttribute> RuleSet::attributes() const
{
    std::vector<RuleAttribute> attributes;
    for (const Global& global : program_->globals)
        if (global.kind == GlobalKind::Attribute)
            attributes.push_back({global.name, global.source, kindOf(global.value), &global.annotations});
    return attributes;
}

u32 RuleSet::ruleCount() const
{
    return u32(program_->rules.size());
}

std::vector<std::string> RuleSet::ruleNames() const
{
    std::vector<std::string> names;
    for (const Rule& rule : program_->rules) names.push_back(program_->names[rule.name]);
    return names;
}

const std::vector<std::string>& RuleSet::styles() const
{
    return program_->styles;
}

const std::vector<SourceFile>& RuleSet::files() const
{
    return program_->files;
}

Result<RuleSet> parseRules(std::string_view text, std::string_view fileName, const RuleOptions& options)
{
    auto program = std::make_shared<Program>();
    program->fileName = fileName;
    program->files.push_back({program->fileName, std::string(text)});
    ErrorList errors(program->files);
    loadProgram(*program, options.style, options, errors);
    checkOtherStyles(*program, options, errors);
    if (!errors.empty()) return errors.join();
    return RuleSet(std::move(program));
}

} // namespace helio
