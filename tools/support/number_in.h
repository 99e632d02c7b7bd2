// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "city/base/result.h"

namespace helio {

/// Accepts numbers of [low, high]. CLI::Range lets NaN pass, because it asks whether the number is outside.
inline CLI::Validator numberIn(double low, double high)
{
    const auto check = [low, high](const std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return {};
        return concat(text, " is not a number of ", low, " to ", high);
    };
    return CLI::Validator(check, concat("FLOAT in [", low, " - ", high, "]"));
}

} // namespace helio
