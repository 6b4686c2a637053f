#include "core/time/clock.h"

#include "core/base/error.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double day_ns = static_cast<double>(ns_per_day);
constexpr std::int64_t tt_minus_tai_ns = 32'184'000'000;  // IAU 1991 Recommendation IV

template <class Scale>
JulianDate<Scale> from_ns(std::int64_t mjd, std::int64_t ns_of_day) {
  mjd += ns_of_day / ns_per_day;
  return {mjd_zero_jd + static_cast<double>(mjd),
          static_cast<double>(ns_of_day % ns_per_day) / day_ns};
}

double mjd_with_fraction(const UtcInstant& utc) {
  const Utc date = to_julian_date(utc);
  return static_cast<double>(utc.mjd) + date.jd2;
}

}  // namespace

Clock::Clock(const Utc& start, std::shared_ptr<const IersTable> iers)
    : start_(to_tai(to_instant(start))), iers_(std::move(iers)) {
  const UtcInstant utc = to_utc(start_);
  unmeasured_.ut1_minus_tai_s = -tai_minus_utc_s(utc.mjd);
  if (iers_ && iers_->at(mjd_with_fraction(utc))) unmeasured_ = iers_->last();
}

TaiInstant Clock::tai_instant(SimTime t) const {
  // Whole days first, so that no sum comes near the limits of 64 bits.
  std::int64_t mjd = start_.mjd + t.ns / ns_per_day;
  std::int64_t ns = start_.ns_of_day + t.ns % ns_per_day;
  if (ns < 0) ns += ns_per_day, --mjd;
  if (ns >= ns_per_day) ns -= ns_per_day, ++mjd;
  return {mjd, ns};
}

Utc Clock::utc(SimTime t) const { return to_julian_date(to_utc(tai_instant(t))); }

Tai Clock::tai(SimTime t) const {
  const TaiInstant tai = tai_instant(t);
  return from_ns<TaiScale>(tai.mjd, tai.ns_of_day);
}

Tt Clock::tt(SimTime t) const {
  const TaiInstant tai = tai_instant(t);
  return from_ns<TtScale>(tai.mjd, tai.ns_of_day + tt_minus_tai_ns);
}

EarthRotationParameters Clock::earth_rotation(SimTime t) const {
  const UtcInstant utc = to_utc(tai_instant(t));
  if (iers_)
    if (const auto measured = iers_->at(mjd_with_fraction(utc))) return *measured;
  return unmeasured_;
}

Ut1 Clock::ut1(SimTime t) const {
  const TaiInstant tai = tai_instant(t);
  Ut1 date{mjd_zero_jd + static_cast<double>(tai.mjd),
           (static_cast<double>(tai.ns_of_day) + earth_rotation(t).ut1_minus_tai_s * 1e9) / day_ns};
  if (date.jd2 < 0.0) date = {date.jd1 - 1.0, date.jd2 + 1.0};
  return date;
}

SimTime Clock::sim_time(const Utc& utc) const {
  const TaiInstant tai = to_tai(to_instant(utc));
  SimTime time;
  if (__builtin_mul_overflow(tai.mjd - start_.mjd, ns_per_day, &time.ns) ||
      __builtin_add_overflow(time.ns, tai.ns_of_day - start_.ns_of_day, &time.ns))
    throw Error(format_utc(utc, 0) + ": is more than 292 years from " +
                format_utc(to_julian_date(to_utc(start_)), 0));
  return time;
}

std::vector<std::string> Clock::warnings(SimTime end) const {
  std::vector<std::string> lines;
  const UtcInstant first = to_utc(start_), last = to_utc(tai_instant(end));
  if (leap_seconds_uncertain(last.mjd))
    lines.push_back("leap seconds until " + format_utc(to_julian_date(last), 0) +
                    " are not all known: UTC may be ahead by whole seconds");
  const bool start_measured = iers_ && iers_->at(mjd_with_fraction(first));
  if (!start_measured || !iers_->at(mjd_with_fraction(last))) {
    std::string why = "no Earth orientation file given";
    if (iers_)
      why = "the Earth orientation file covers " +
            format_utc(to_julian_date({iers_->first_mjd(), 0}), 0) + " to " +
            format_utc(to_julian_date({iers_->last_mjd(), 0}), 0) + " only";
    lines.push_back(why +
                    (start_measured ? ": its last values are kept"
                                    : ": UT1 is taken for UTC, without polar motion") +
                    ", an error of up to 0.9 s or 13.5 arcsec of Earth rotation and 0.6 arcsec of "
                    "the pole");
  }
  return lines;
}

}  // namespace dmise
