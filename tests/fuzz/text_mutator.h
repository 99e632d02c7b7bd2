// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "city/base/check.h"
#include "city/base/hash.h"

namespace helio::fuzz {

/// The pieces of a text: names, numbers, quoted texts, runs of white space, single other characters. One after the
/// other they are the text again.
std::vector<std::string_view> tokensOf(std::string_view text);

/// Changes a text in one to six places so that much of it keeps its meaning: tokens swapped, replaced by others of the
/// text or by `words`, numbers by extreme ones, bracketed blocks and lines doubled or dropped, brackets changed or
/// piled up, the end cut off, a block or the tail of `other` put in, bytes changed. At most `largest` bytes.
std::string mutateText(std::string_view text, std::string_view other, std::span<const std::string_view> words,
                       size_t largest, Random& random);

} // namespace helio::fuzz
