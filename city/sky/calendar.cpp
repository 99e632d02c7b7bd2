// SPDX-License-Identifier: Apache-2.0
#include "city/sky/calendar.h"

#include <algorithm>
#include <array>

namespace helio {
namespace {

/// Days from 1970-01-01, negative before. Counts in eras of 400 years from 1 March of year 0.
long daysFromEpoch(int year, int month, int day)
{
    const int shifted = month > 2 ? year : year - 1;
    const int era = (shifted >= 0 ? shifted : shifted - 399) / 400;
    const int yearOfEra = shifted - era * 400;
    const int dayOfYear = (153 * (month > 2 ? month - 3 : month + 9) + 2) / 5 + day - 1;
    const int dayOfEra = yearOfEra * 365 + yearOfEra / 4 - yearOfEra / 100 + dayOfYear;
    return long(era) * 146097 + dayOfEra - 719468;
}

bool isLeap(int year)
{
    return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
}

int daysInMonth(int year, int month)
{
    constexpr std::array<int, 12> kDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    return month == 2 && isLeap(year) ? 29 : kDays[size_t(month - 1)];
}

/// Reads digits where `pattern` has '0' and demands the pattern's other characters as they are; the numbers between
/// them go to `fields`.
bool matches(std::string_view text, std::string_view pattern, std::array<int, 3>& fields)
{
    if (text.size() != pattern.size()) return false;
    size_t field = 0;
    fields = {};
    for (size_t i = 0; i < text.size(); ++i) {
        if (pattern[i] != '0') {
            if (text[i] != pattern[i]) return false;
            ++field;
        } else {
            if (text[i] < '0' || text[i] > '9') return false;
            fields[field] = fields[field] * 10 + (text[i] - '0');
        }
    }
    return true;
}

} // namespace

double julianDay(int year, int month, int day, double hours)
{
    constexpr double kEpoch = 2440587.5; // 1970-01-01, 0 h
    return kEpoch + double(daysFromEpoch(year, month, day)) + hours / 24.0;
}

Result<double> parseJulianDay(std::string_view date, std::string_view time, double utcOffset)
{
    std::array<int, 3> d{}, t{};
    if (!matches(date, "0000-00-00", d) || d[0] < 1600 || d[0] > 2999 || d[1] < 1 || d[1] > 12 || d[2] < 1 ||
        d[2] > daysInMonth(d[0], d[1]))
        return Error{concat("date ", date, ": expected YYYY-MM-DD, 1600-01-01 to 2999-12-31, such as 2026-06-21")};
    if ((!matches(time, "00:00", t) && !matches(time, "00:00:00", t)) || t[0] > 23 || t[1] > 59 || t[2] > 59)
        return Error{concat("time ", time, ": expected HH:MM or HH:MM:SS, 00:00 to 23:59:59, such as 14:30")};
    return julianDay(d[0], d[1], d[2], t[0] + t[1] / 60.0 + t[2] / 3600.0 - utcOffset);
}

} // namespace helio
