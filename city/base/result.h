// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "city/base/check.h"

namespace helio {

/// What is wrong with an input, in one line: file, place (line, byte, feature id), what is wrong, what to do.
struct Error
{
    std::string message;
};

/// A value, or the error that explains why there is none. Bad input travels as a Result; programmer errors abort
/// (HELIO_CHECK). No exceptions leave our code.
template <class T> class [[nodiscard]] Result
{
public:
    Result(T value) : value_(std::move(value)) {}
    Result(Error error) : error_(std::move(error)) {}

    bool ok() const { return value_.has_value(); }
    explicit operator bool() const { return ok(); }

    T& value()
    {
        HELIO_CHECK(ok(), error_.message.c_str());
        return *value_;
    }
    const T& value() const
    {
        HELIO_CHECK(ok(), error_.message.c_str());
        return *value_;
    }
    T& operator*() { return value(); }
    const T& operator*() const { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    const Error& error() const { return error_; }

private:
    std::optional<T> value_;
    Error error_;
};

struct Nothing
{
};
/// The result of a call that gives no value.
using Status = Result<Nothing>;

} // namespace helio
