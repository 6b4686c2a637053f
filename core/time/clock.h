#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/time/iers.h"
#include "core/time/julian_date.h"
#include "core/time/leap_seconds.h"

namespace dmise {

/// Converts simulation time to UTC, TAI, TT and UT1. All arithmetic is in whole nanoseconds of TAI,
/// so errors never accumulate. Immutable; may be shared between threads.
class Clock {
 public:
  /// `start`: UTC at simulation time 0, rounded to the nanosecond; throws `Error` before 1972.
  /// `iers`: Earth rotation. If the table does not cover the start, UT1 equals UTC there and polar
  /// motion is 0; if it ends during the run, its last values are kept. In both cases UT1 then
  /// advances with TAI, so that the Earth does not jump at a leap second.
  explicit Clock(const Utc& start, std::shared_ptr<const IersTable> iers = nullptr);

  Utc utc(SimTime t) const;
  Tai tai(SimTime t) const;
  Tt tt(SimTime t) const;
  Ut1 ut1(SimTime t) const;

  /// The UT1 and polar motion that `ut1` uses.
  EarthRotationParameters earth_rotation(SimTime t) const;

  /// Exact to the nanosecond. Throws `Error` beyond +-292 years from the start.
  SimTime sim_time(const Utc& utc) const;

  /// Returns warnings for a run from simulation time 0 to `end`, one line each, of leap seconds
  /// that are not yet announced and of UT1 that is not measured, with the size of that error.
  std::vector<std::string> warnings(SimTime end) const;

 private:
  TaiInstant tai_instant(SimTime t) const;

  TaiInstant start_;
  std::shared_ptr<const IersTable> iers_;
  EarthRotationParameters unmeasured_;  // outside `iers_`
};

}  // namespace dmise
