// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "city/base/types.h"

// What a fuzz target of texts tells text_main.cpp, which mutates its corpus. Beside it, a target has the entry point in
// libFuzzer's form.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size);

namespace helio::fuzz {

struct TextTarget
{
    std::string_view name;                   ///< of the executable and of the files it leaves
    std::span<const std::string_view> words; ///< that make a difference: keywords, member names
};

extern const TextTarget textTarget;

/// Inputs that went through without an error, and those that were refused: the proof that both sides are reached.
extern u64 acceptedTexts, refusedTexts;

} // namespace helio::fuzz
