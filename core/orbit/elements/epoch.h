#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "core/time/julian_date.h"

namespace dmise {

struct ElapsedScale {};  // TAI - 37 s: equal to UTC, to the bit, since the leap second of 2016
using ElapsedDate = JulianDate<ElapsedScale>;

/// `utc`, of any split into two parts, on the scale whose days all have 86400 SI seconds. By ERFA's
/// rates of UTC from 1960 to 1972; before 1960, when there was no UTC, TAI is taken to equal it.
ElapsedDate elapsed_date(const Utc& utc);

/// Days of 86400 SI seconds from `from` to `to`.
inline double epoch_days_between(const Utc& from, const Utc& to) {
  return days_between(elapsed_date(to), elapsed_date(from));
}

/// Whether `year` is a leap year of the Gregorian calendar.
bool is_leap_year(int year);

/// Midnight that begins `day_of_year` (1 = 1 January), for years 1583 to 9999.
double julian_midnight(int year, int day_of_year);

/// Century of a two-digit TLE year: 57-99 are 19xx (Sputnik's launch), 00-56 are 20xx.
int full_year(int two_digit_year);

/// A calendar date and time of day as written, in no particular time scale.
struct CalendarTime {
  double midnight_jd = 0.0;    // ends in .5
  double second_of_day = 0.0;  // [0, 86401): from 86400 on inside a leap second
};

/// `2018-01-20T23:40:00.123456Z`, or with day of year `2018-020T23:40:00`; 'Z' and the fraction of
/// the second are optional. Second 60 is read at 23:59 only. Nothing if it is not such a text.
/// Source: CCSDS 301.0-B-4, ASCII time codes A and B.
std::optional<CalendarTime> parse_calendar_time(std::string_view text);

/// Reads an ISO epoch as UTC; empty for second 60 on a day without a leap second.
std::optional<Utc> parse_iso_epoch(std::string_view text);

/// `2018-01-20T23:40:00.123` with `decimals` in [0, 6] of a second, rounded to nearest; for any
/// year, while `format_utc` starts in 1972.
std::string format_iso_epoch(const Utc& epoch, int decimals = 3);

}  // namespace dmise
