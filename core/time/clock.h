#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/time/iers.h"
#include "core/time/julian_date.h"
#include "core/time/leap_seconds.h"

namespace dmise {

/// What the four time scales read at a simulation time. Arithmetic is in whole nanoseconds of TAI:
/// nothing accumulates, whatever the length of a run. Immutable; shared between threads freely.
class Clock {
 public:
  /// `start`: UTC at simulation time 0, taken to the nanosecond, not before 1972 (`Error`).
  /// `iers`: Earth rotation. Where it does not cover the start, UT1 is UTC there and polar motion
  /// 0; where it ends within a run, its last values are kept. Either way UT1 then runs on with TAI,
  /// so that the Earth does not jump at a leap second.
  explicit Clock(const Utc& start, std::shared_ptr<const IersTable> iers = nullptr);

  Utc utc(SimTime t) const;
  Tai tai(SimTime t) const;
  Tt tt(SimTime t) const;
  Ut1 ut1(SimTime t) const;

  /// The UT1 and polar motion that `ut1` uses.
  EarthRotationParameters earth_rotation(SimTime t) const;

  /// Exact to the nanosecond.
  SimTime sim_time(const Utc& utc) const;

  /// What a run from simulation time 0 to `end` should tell its user, one line each, empty when all
  /// is measured: leap seconds that nobody can know yet, UT1 taken for UTC and the size of that
  /// error.
  std::vector<std::string> warnings(SimTime end) const;

 private:
  TaiInstant tai_instant(SimTime t) const;

  TaiInstant start_;
  std::shared_ptr<const IersTable> iers_;
  EarthRotationParameters unmeasured_;  // where `iers_` says nothing
};

}  // namespace dmise
