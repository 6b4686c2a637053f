#pragma once
#include <optional>
#include <string_view>

namespace dmise {

/// A UTC instant as a two-part Julian date [days]. One double would be good to 40 us only, 0.3 m
/// along a low orbit. On a day with a leap second jd2 is ERFA's quasi-JD: the day is stretched to
/// 86401 s.
struct UtcEpoch {
  double jd1 = 0.0;  // midnight: ends in .5
  double jd2 = 0.0;  // fraction of the day, [0, 1)

  bool operator==(const UtcEpoch&) const = default;
};

/// Later instants are greater; a rounded difference in days.
inline double days_between(const UtcEpoch& from, const UtcEpoch& to) {
  return (to.jd1 - from.jd1) + (to.jd2 - from.jd2);
}

/// Whether `year` is a leap year of the Gregorian calendar.
bool is_leap_year(int year);

/// Midnight that begins `day_of_year` (1 = 1 January), for years 1583 to 9999.
double julian_midnight(int year, int day_of_year);

/// Century of a two-digit TLE year: 57-99 are 19xx (Sputnik's launch), 00-56 are 20xx.
int full_year(int two_digit_year);

/// `2018-01-20T23:40:00.123456Z`, or with day of year `2018-020T23:40:00`; 'Z' and the fraction of
/// the second are optional, second 60 is allowed on a day that has one. Nothing if it is not such a
/// text.
std::optional<UtcEpoch> parse_iso_epoch(std::string_view text);

}  // namespace dmise
