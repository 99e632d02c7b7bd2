// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/rules.h"

#include "city/grammar/parser.h"
#include "city/grammar/resolve.h"

namespace helio {

std::vector<std::string> RuleSet::attributeNames() const
{
    std::vector<std::string> names;
    for (const cga::Global& global : program_->globals)
        if (global.kind == cga::GlobalKind::Attribute) names.push_back(global.name);
    return names;
}

u32 RuleSet::ruleCount() const
{
    return u32(program_->rules.size());
}

Result<RuleSet> parseRules(std::string_view text, std::string_view fileName)
{
    auto program = cga::parseProgram(text, fileName);
    if (!program) return program.error();
    if (const Status status = cga::resolveProgram(**program); !status) return status.error();
    return RuleSet(std::move(*program));
}

} // namespace helio
