// SPDX-License-Identifier: Apache-2.0
#include "city/base/json_depth.h"

namespace helio {

std::optional<size_t> findDeepJson(std::string_view text, u32 limit)
{
    u32 depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            quoted = c != '"';
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            if (++depth > limit) return i;
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
    return std::nullopt;
}

} // namespace helio
