#include "core/time/leap_seconds.h"

#include <erfa.h>
#include <erfaextra.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace dmise {
namespace {

struct LeapSecond {
  std::int64_t first_mjd = 0;
  int tai_minus_utc_s = 0;
};

std::int64_t mjd_of(int year, int month, int day) {
  double zero = 0.0, mjd = 0.0;
  eraCal2jd(year, month, day, &zero, &mjd);
  return static_cast<std::int64_t>(mjd);
}

std::vector<LeapSecond> read_table() {
  eraLEAPSECOND* rows = nullptr;
  const int count = eraGetLeapSeconds(&rows);
  std::vector<LeapSecond> table;
  for (int i = 0; i < count; ++i)
    if (rows[i].iyear >= 1972)
      table.push_back(
          {mjd_of(rows[i].iyear, rows[i].month, 1), static_cast<int>(std::lround(rows[i].delat))});
  if (table.empty()) throw Error("ERFA has no leap seconds");
  return table;
}

// ERFA's table can be replaced while a program runs, so it is copied once.
const std::vector<LeapSecond>& table() {
  static const std::vector<LeapSecond> rows = read_table();
  return rows;
}

}  // namespace

int tai_minus_utc_s(std::int64_t mjd) {
  const std::vector<LeapSecond>& rows = table();
  if (mjd < rows.front().first_mjd - 1)
    throw Error("UTC before 1972-01-01 is not supported, got modified Julian day " +
                std::to_string(mjd));
  std::size_t i = rows.size() - 1;
  while (i > 0 && mjd < rows[i].first_mjd) --i;
  return rows[i].tai_minus_utc_s;
}

int utc_day_length_s(std::int64_t mjd) {
  return 86400 + tai_minus_utc_s(mjd + 1) - tai_minus_utc_s(mjd);
}

bool leap_seconds_uncertain(std::int64_t mjd) {
  table();  // before eraDat: initialises ERFA's table exactly once
  int year = 0, month = 0, day = 0;
  double fraction = 0.0, delta = 0.0;
  if (eraJd2cal(mjd_zero_jd, static_cast<double>(mjd), &year, &month, &day, &fraction) != 0)
    return true;
  return eraDat(year, month, day, 0.0, &delta) != 0;
}

TaiInstant to_tai(const UtcInstant& utc) {
  const std::int64_t ns = utc.ns_of_day + tai_minus_utc_s(utc.mjd) * ns_per_s;
  return {utc.mjd + ns / ns_per_day, ns % ns_per_day};
}

UtcInstant to_utc(const TaiInstant& tai) {
  // TAI is ahead of UTC by less than a day, so the UTC day is this one or the one before.
  const std::int64_t ns = tai.ns_of_day - tai_minus_utc_s(tai.mjd) * ns_per_s;
  if (ns >= 0) return {tai.mjd, ns};
  const std::int64_t yesterday = tai.mjd - 1;
  return {yesterday, tai.ns_of_day + ns_per_day - tai_minus_utc_s(yesterday) * ns_per_s};
}

UtcInstant to_instant(const Utc& utc) {
  const double whole1 = std::floor(utc.jd1 - mjd_zero_jd);
  double fraction = (utc.jd1 - mjd_zero_jd) - whole1;
  const double whole2 = std::floor(utc.jd2);
  fraction += utc.jd2 - whole2;
  std::int64_t mjd = static_cast<std::int64_t>(whole1 + whole2);
  if (fraction >= 1.0) {
    fraction -= 1.0;
    ++mjd;
  }
  const std::int64_t day_ns = utc_day_length_s(mjd) * ns_per_s;
  const std::int64_t ns = std::llround(fraction * static_cast<double>(day_ns));
  if (ns >= day_ns) return {mjd + 1, 0};
  return {mjd, ns};
}

Utc to_julian_date(const UtcInstant& utc) {
  return {mjd_zero_jd + static_cast<double>(utc.mjd),
          static_cast<double>(utc.ns_of_day) /
              static_cast<double>(utc_day_length_s(utc.mjd) * ns_per_s)};
}

}  // namespace dmise
