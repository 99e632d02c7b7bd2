// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <mutex>
#include <string>
#include <vector>

#include "city/base/types.h"

namespace helio {

/// Collects the validation layer's warnings and errors. The layer may call from any thread.
class MessageLog
{
public:
    void add(std::string message);
    u32 count() const;
    /// All messages since the last clear, in order of arrival.
    std::vector<std::string> all() const;
    void clear();

private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

} // namespace helio
