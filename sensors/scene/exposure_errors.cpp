#include "sensors/scene/exposure_errors.h"

#include <algorithm>

#include "core/base/numeric/rng.h"

namespace dmise {

ExposureErrors::ExposureErrors(const SensorConfig& sensor, const FrameTimes& commanded,
                               std::uint64_t seed)
    : commanded_(commanded),
      last_row_delay_(last_row_delay(sensor)),
      instrument_(acting_instrument(sensor.instrument, sensor.effects)) {
  const auto deviate = [&](const EffectFacts& effect, std::uint32_t number) {
    const RngKey key = rng_key(seed, sensor.name, commanded.frame, effect.name);
    return double(normal_of(rng_word(key, number, 0)));
  };
  if (of_clock()) clock_jitter_s_ = instrument_.clock_rms_s * deviate(ClockError::facts, 0);
  if (of_pointing())
    for (std::uint32_t k = 0; k < pointing_deviate_.size(); ++k)
      pointing_deviate_[k] = deviate(PointingError::facts, k);
  if (of_vibration()) {
    const FrameTimes times = exposed();
    vibration_rad_ = instrument_.shift_rad(rng_key(seed, sensor.name, 0, Vibration::facts.name),
                                           times.middle, times.seconds());
  }
}

FrameTimes ExposureErrors::exposed() const {
  if (!of_clock()) return commanded_;
  const auto truly = [&](SimTime reading) {
    return instrument_.true_time(reading, clock_jitter_s_);
  };
  return {commanded_.frame, truly(commanded_.start), truly(commanded_.middle),
          truly(commanded_.end)};
}

SimTime ExposureErrors::reading(SimTime t) const {
  if (!of_clock()) return t;
  // Rounding must not ask for states beyond those of the exposure.
  const SimTime reading = instrument_.ClockError::reading(t, clock_jitter_s_);
  return std::clamp(reading, commanded_.start, commanded_.end + last_row_delay_);
}

Rotation<CameraFrame, CameraFrame> ExposureErrors::true_from_commanded(SimTime t) const {
  ImageAxes displaced_rad = instrument_.at_rad(t, pointing_deviate_);
  for (std::size_t k = 0; k < displaced_rad.size(); ++k) displaced_rad[k] += vibration_rad_[k];
  return dmise::true_from_commanded(displaced_rad);
}

}  // namespace dmise
