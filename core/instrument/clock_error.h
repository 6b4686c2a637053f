#pragma once
#include "core/base/sim_time.h"
#include "core/instrument/instrument_effect.h"

namespace dmise {

/// The clock by which a sensor opens and closes its shutter and moves its mount. It reads
///   t + offset + drift t + jitter
/// at the time t since the start of the run, so that an exposure truly begins when it reads the
/// commanded time: earlier than commanded, if the clock is ahead.
struct ClockError {
  static constexpr EffectFacts facts{
      "clock_error", "the sensor's clock is wrong, and exposures begin when it reads their time",
      "the error times the rate: up to 1 deg a second in a low orbit, 15 arcsec a second for stars",
      "offset, drift and a normal deviate an exposure"};
  double offset_s = 0.0;     // reading less true time, at the start of the run
  double drift = 0.0;        // growth of the offset [s/s]
  double clock_rms_s = 0.0;  // jitter, drawn anew for each exposure
  bool operator==(const ClockError&) const = default;

  static std::span<const InstrumentParameter> parameters();
  bool applies() const { return offset_s != 0.0 || drift != 0.0 || clock_rms_s != 0.0; }
  ErrorBound error(int level, const PlanFacts& f) const;

  /// Returns the true time at which the clock reads `reading`, in an exposure with this jitter.
  SimTime true_time(SimTime reading, double jitter_s) const;
  /// The inverse.
  SimTime reading(SimTime true_time, double jitter_s) const;

  /// Bound of the jitter in units of its rms: that of `normal_of` (core/base/numeric/rng.h).
  static constexpr double max_deviations = 6.35;
  double max_jitter_s() const { return max_deviations * clock_rms_s; }
  /// Returns the first and the last true time at which the clock may read `reading`.
  SimTime earliest(SimTime reading) const { return true_time(reading, max_jitter_s()); }
  SimTime latest(SimTime reading) const { return true_time(reading, -max_jitter_s()); }
  /// Returns the largest reading whose `latest` is not after `true_time`, or one a few ns less.
  SimTime surely_read_by(SimTime true_time) const;
};

}  // namespace dmise
