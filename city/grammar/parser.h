// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string_view>

#include "city/base/result.h"
#include "city/grammar/program.h"

namespace helio::cga {

/// Parses CGA text into a program whose names are not resolved yet (see resolve.h).
/// Precondition of nothing: any text gives a program or an error with its place.
Result<std::shared_ptr<Program>> parseProgram(std::string_view text, std::string_view fileName);

} // namespace helio::cga
