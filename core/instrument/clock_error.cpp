#include "core/instrument/clock_error.h"

#include <cmath>

#include "core/effects/plan_facts.h"
#include "core/instrument/instrument.h"

namespace dmise {

std::span<const InstrumentParameter> ClockError::parameters() {
  using Kind = InstrumentParameter::Kind;
  static const InstrumentParameter table[] = {
      {"offset_ms", 1e-3, 60000.0, Kind::number, &ClockError::offset_s,
       "Time by which the clock is fast at the start of the run [ms]."},
      {"drift_ppm", 1e-6, 1000.0, Kind::number, &ClockError::drift,
       "Rate by which it gains [1e-6]."},
      {"jitter_ms", 1e-3, 1000.0, Kind::rms, &ClockError::clock_rms_s,
       "Rms error of each reading [ms]."}};
  return table;
}

ErrorBound ClockError::error(int, const PlanFacts& f) const {
  if (f.clock_error_s == 0.0 && drift == 0.0) return {};
  // A shadow, a glint or a speckle may begin or end within the error.
  if (f.near_shadow || f.shapes > 0 || f.screens > 0) return not_bounded;
  const double max_rad = std::max(f.star_rate_rad_per_s, f.object_rate_rad_per_s) * f.clock_error_s;
  if (max_rad > f.pixel_rad) return not_bounded;  // other sources enter the frame
  ErrorBound error = f.shifted_stars(f.star_rate_rad_per_s * f.clock_error_s);
  if (f.objects > 0) error += f.shifted_objects(f.object_rate_rad_per_s * f.clock_error_s);
  // The exposure is longer or shorter.
  return error + f.dimmed_by(2.0 * std::abs(drift));
}

SimTime ClockError::true_time(SimTime reading, double jitter_s) const {
  // The difference alone is rounded, so that the time may be long.
  const double ahead_s = (offset_s + jitter_s + drift * reading.seconds()) / (1.0 + drift);
  return reading - sim_seconds(ahead_s);
}

SimTime ClockError::reading(SimTime true_time, double jitter_s) const {
  return true_time + sim_seconds(offset_s + jitter_s + drift * true_time.seconds());
}

SimTime ClockError::surely_read_by(SimTime true_time) const {
  constexpr SimTime rounding{3};
  return reading(true_time, -max_jitter_s()) - rounding;
}

}  // namespace dmise
