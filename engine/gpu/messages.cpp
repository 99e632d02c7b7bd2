// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/messages.h"

namespace helio {

void MessageLog::add(std::string message)
{
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

u32 MessageLog::count() const
{
    const std::lock_guard lock(mutex_);
    return u32(messages_.size());
}

std::vector<std::string> MessageLog::all() const
{
    const std::lock_guard lock(mutex_);
    return messages_;
}

void MessageLog::clear()
{
    const std::lock_guard lock(mutex_);
    messages_.clear();
}

} // namespace helio
