// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "city/grammar/program.h"

namespace helio::cga {

/// What became of the bare words of an operation (`y`, `world.up`, `byAngle`, `street.front`).
struct WordsResult
{
    std::optional<std::string> error; ///< a word is unknown: what is wrong, and what to write
    Place place;                      ///< of the error
    std::string ignored;              ///< set(material.x, ..) and the like: read, without effect
};

/// Takes the bare words of an operation out of its arguments and puts what they say into Statement::mode; reads the
/// selectors of its block from BlockElement::size (but for split, whose sizes are expressions).
WordsResult resolveWords(Statement& statement, const Program& program);

} // namespace helio::cga
