#pragma once
#include <cstdint>

#include "core/time/julian_date.h"

namespace dmise {

/// UTC instant in whole numbers, so that a scenario's times are never rounded.
struct UtcInstant {
  std::int64_t mjd = 0;        // UTC day
  std::int64_t ns_of_day = 0;  // [0, day length): up to 86401e9 on a day with a leap second

  bool operator==(const UtcInstant&) const = default;
};

/// An instant on the uniform scale.
struct TaiInstant {
  std::int64_t mjd = 0;
  std::int64_t ns_of_day = 0;  // [0, 86400e9)

  bool operator==(const TaiInstant&) const = default;
};

/// TAI - UTC on the UTC day `mjd` [s], from ERFA's table. Throws `Error` before 1972, when UTC was
/// not yet kept in whole seconds; the last day of 1971 has the 10 s of the next, because rates at
/// its end are taken from instants on both sides.
int tai_minus_utc_s(std::int64_t mjd);

/// Length of the UTC day `mjd` [s]: 86400, 86401 when it ends with a leap second.
int utc_day_length_s(std::int64_t mjd);

/// True if ERFA calls the year dubious: so far beyond its table that leap seconds may have been
/// announced since. Only UTC is affected, by that many seconds.
bool leap_seconds_uncertain(std::int64_t mjd);

TaiInstant to_tai(const UtcInstant& utc);
UtcInstant to_utc(const TaiInstant& tai);

/// Nearest nanosecond.
UtcInstant to_instant(const Utc& utc);
Utc to_julian_date(const UtcInstant& utc);

}  // namespace dmise
