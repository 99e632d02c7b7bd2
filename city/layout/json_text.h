// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string_view>

#include "city/base/result.h"

// JSON texts from outside, read without exceptions. For readers of JSON inputs, not for other code.
namespace helio {

/// What the library says is wrong, without its own prefix ("parse error at line 1, column 5: "); at most 160 bytes.
std::string jsonReason(const std::exception& failure);

/// Parses one JSON value that fills `part`, a piece of `whole` (for line and byte in messages). Errors (one line):
/// `name`, line, byte, what is wrong, `advice`; nesting beyond kMaxJsonDepth is one.
Result<nlohmann::json> parseJson(std::string_view part, std::string_view whole, std::string_view name,
                                 std::string_view advice);

/// The member of an object; null if there is none or `object` is no object.
const nlohmann::json* findMember(const nlohmann::json& object, const char* key);
/// The same, null if it is no array.
const nlohmann::json* findArray(const nlohmann::json& object, const char* key);
/// The text of a member; empty if there is none or it is no text.
std::string findText(const nlohmann::json& object, const char* key);

} // namespace helio
