// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "city/grammar/rules.h"

namespace helio {

/// Rules as a text for people: styles, imports, start rule; attributes by @Group and @Order with default, @Range, @Enum
/// and @Description; functions and constants; and the rule graph, one line a rule, `Rule(parameters) -> A, B, C.` (a
/// dot ends the names of terminals) with the operations it uses and a mark at rules that the start rule never reaches.
/// Lines end in a newline. The same rules give the same text.
std::string explainRules(const RuleSet& rules);

} // namespace helio
