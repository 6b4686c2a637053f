#include "core/orbit/elements/epoch.h"

#include <erfa.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/time/leap_seconds.h"

namespace dmise {

namespace {

/// Exactly `width` digits at `at`.
std::optional<int> digits(std::string_view text, std::size_t at, std::size_t width) {
  if (at + width > text.size()) return std::nullopt;
  int value = 0;
  for (std::size_t i = at; i < at + width; ++i) {
    if (text[i] < '0' || text[i] > '9') return std::nullopt;
    value = value * 10 + (text[i] - '0');
  }
  return value;
}

/// Length of the UTC day that begins at `midnight` [s]: 86400, or 86401 with a leap second.
double length_of_day_s(double midnight) {
  double tai1 = 0, tai2 = 0, next1 = 0, next2 = 0;
  // ERFA calls years before 1960 and beyond its table dubious; their days have 86400 s.
  if (eraUtctai(midnight, 0.0, &tai1, &tai2) != 0) return 86400.0;
  if (eraUtctai(midnight + 1.0, 0.0, &next1, &next2) != 0) return 86400.0;
  return std::round(((next1 - tai1) + (next2 - tai2)) * 86400.0);
}

constexpr double elapsed_behind_tai_s = 37.0;
constexpr double first_whole_mjd = 41317;  // 1972-01-01, from which TAI - UTC is in whole seconds

}  // namespace

ElapsedDate elapsed_date(const Utc& utc) {
  const double day = std::floor((utc.jd1 - mjd_zero_jd) + utc.jd2);
  if (!(std::abs(day) < 1e8)) return {utc.jd1, utc.jd2};
  const double fraction = (utc.jd1 - mjd_zero_jd - day) + utc.jd2;
  if (day < first_whole_mjd) {
    Tai tai;
    if (eraUtctai(mjd_zero_jd + day, fraction, &tai.jd1, &tai.jd2) < 0) return {utc.jd1, utc.jd2};
    return {tai.jd1, tai.jd2 - elapsed_behind_tai_s / day_s};
  }
  const auto mjd = static_cast<std::int64_t>(day);
  const int length_s = utc_day_length_s(mjd);
  const double ahead_s = tai_minus_utc_s(mjd) - elapsed_behind_tai_s;
  if (length_s == 86400 && ahead_s == 0.0) return {utc.jd1, utc.jd2};
  return {mjd_zero_jd + day, (fraction * length_s + ahead_s) / day_s};
}

bool is_leap_year(int year) { return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0); }

double julian_midnight(int year, int day_of_year) {
  const int y = year - 1;
  return 1721425.5 + 365.0 * y + (y / 4 - y / 100 + y / 400) + (day_of_year - 1);
}

int full_year(int two_digit_year) { return two_digit_year + (two_digit_year >= 57 ? 1900 : 2000); }

std::optional<CalendarTime> parse_calendar_time(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text.back() == 'Z') text.remove_suffix(1);
  const std::size_t t = text.find_first_of("T ");
  if (t == std::string_view::npos) return std::nullopt;
  const std::string_view date = text.substr(0, t), time = text.substr(t + 1);

  const auto year = digits(date, 0, 4);
  if (!year || *year < 1583 || date.size() < 8 || date[4] != '-') return std::nullopt;
  double midnight_jd = 0.0;
  if (date.size() == 8) {
    const auto day = digits(date, 5, 3);
    if (!day || *day < 1 || *day > 365 + is_leap_year(*year)) return std::nullopt;
    midnight_jd = julian_midnight(*year, *day);
  } else {
    const auto month = digits(date, 5, 2), day = digits(date, 8, 2);
    if (date.size() != 10 || date[7] != '-' || !month || !day) return std::nullopt;
    double mjd_zero = 0.0, mjd = 0.0;
    if (eraCal2jd(*year, *month, *day, &mjd_zero, &mjd) != 0) return std::nullopt;
    midnight_jd = mjd_zero + mjd;
  }

  const auto hour = digits(time, 0, 2), minute = digits(time, 3, 2);
  if (!hour || !minute || *hour > 23 || *minute > 59 || time.size() < 8) return std::nullopt;
  if (time[2] != ':' || time[5] != ':' || !digits(time, 6, 2)) return std::nullopt;
  for (const char c : time.substr(8))
    if (c != '.' && (c < '0' || c > '9')) return std::nullopt;
  const auto second = parse_real(time.substr(6));
  if (!second || *second < 0 || *second >= 61) return std::nullopt;

  if (*second >= 60 && (*hour != 23 || *minute != 59)) return std::nullopt;
  return CalendarTime{midnight_jd, (*hour * 60.0 + *minute) * 60.0 + *second};
}

std::optional<Utc> parse_iso_epoch(std::string_view text) {
  const auto time = parse_calendar_time(text);
  if (!time) return std::nullopt;
  const double day_length_s = length_of_day_s(time->midnight_jd);
  if (time->second_of_day >= day_length_s) return std::nullopt;
  return Utc{time->midnight_jd, time->second_of_day / day_length_s};
}

std::string format_iso_epoch(const Utc& epoch, int decimals) {
  decimals = std::clamp(decimals, 0, 6);
  const std::int64_t unit = std::llround(std::pow(10.0, decimals));  // in a second
  const std::int64_t day_length = std::llround(length_of_day_s(epoch.jd1)) * unit;
  std::int64_t time = std::llround(epoch.jd2 * static_cast<double>(day_length));
  double midnight = epoch.jd1;
  if (time >= day_length) {
    time = 0;
    midnight += 1.0;
  }
  int year = 0, month = 0, day = 0;
  double fraction = 0.0;
  eraJd2cal(midnight, 0.0, &year, &month, &day, &fraction);
  const std::int64_t second_of_day = time / unit;
  const std::int64_t minute_of_day = std::min<std::int64_t>(second_of_day / 60, 1439);
  const std::string whole = formatted(
      "%04d-%02d-%02dT%02d:%02d:%02d", year, month, day, static_cast<int>(minute_of_day / 60),
      static_cast<int>(minute_of_day % 60), static_cast<int>(second_of_day - minute_of_day * 60));
  if (decimals == 0) return whole;
  return whole + formatted(".%0*d", decimals, static_cast<int>(time % unit));
}

}  // namespace dmise
