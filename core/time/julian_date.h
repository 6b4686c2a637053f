#pragma once
#include <concepts>
#include <cstdint>

namespace dmise {

// Time scales. Each has its own type of date, so that a UTC cannot be passed for a TT or subtracted
// from one; `core/time/clock.h` converts.
struct UtcScale {};  // quasi Julian date: the fraction of a day with a leap second counts 86401 s
struct TaiScale {};
struct TtScale {};   // TAI + 32.184 s; stands in for TDB, from which it differs by less than 2 ms
struct Ut1Scale {};  // angle of the Earth's rotation

inline constexpr double mjd_zero_jd = 2400000.5;  // Julian date of modified Julian date 0
inline constexpr std::int64_t ns_per_s = 1'000'000'000;
inline constexpr std::int64_t ns_per_day = 86'400 * ns_per_s;

/// Two-part Julian date [days] in the form that ERFA takes. From the functions of this library
/// `jd1` is a midnight (ends in .5) and `jd2` the fraction of the day in [0, 1): rounding is 0.01
/// ns.
template <class Scale>
struct JulianDate {
  double jd1 = 0.0;
  double jd2 = 0.0;

  bool operator==(const JulianDate&) const = default;
};

using Utc = JulianDate<UtcScale>;
using Tai = JulianDate<TaiScale>;
using Tt = JulianDate<TtScale>;
using Ut1 = JulianDate<Ut1Scale>;

/// `a - b` in days of their common scale. Not for UTC, whose days differ in length.
template <class Scale>
double days_between(const JulianDate<Scale>& a,
                    const JulianDate<Scale>& b) requires(!std::same_as<Scale, UtcScale>) {
  return (a.jd1 - b.jd1) + (a.jd2 - b.jd2);
}

/// Julian years of 365.25 days since J2000.0.
inline double julian_years_since_j2000(const Tt& t) {
  return ((t.jd1 - 2451545.0) + t.jd2) / 365.25;
}

}  // namespace dmise
