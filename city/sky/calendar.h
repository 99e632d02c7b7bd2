// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "city/base/result.h"

namespace helio {

/// Julian day of a date of the Gregorian calendar (also before it was introduced) and a time of day in hours, UTC. The
/// hours may lie outside 0..24: they are added to the day. Not checked: month 1..12, day 1..31.
double julianDay(int year, int month, int day, double hours);

/// Julian day of a date "YYYY-MM-DD", years 1600 to 2999, and a time "HH:MM" or "HH:MM:SS" on a clock that is
/// `utcOffset` hours ahead of UTC. Error: one line that says which text is not a date or a time.
Result<double> parseJulianDay(std::string_view date, std::string_view time, double utcOffset);

} // namespace helio
