#include "sensors/survey/noise_table.h"

#include <algorithm>
#include <cmath>

#include "sensors/forecast/detection_limit.h"

namespace dmise {
namespace {

constexpr double first_sky_e = 0.01, steps_per_octave = 2.0;

}  // namespace

NoiseTable::NoiseTable(const SensorConfig& sensor, std::uint64_t seed) {
  const Detector detector = acting_detector(sensor.camera.detector, sensor.effects);
  full_sky_e_ = std::max(0.0, saturation_e(detector) - detector.dark_e_per_s * sensor.exposure_s);
  const auto add = [&](double sky_e) {
    const double noise_e = noise_over_sky_e(sensor, frame_times(sensor, 1), seed, sky_e);
    sky_e_.push_back(sky_e);
    variance_e2_.push_back(noise_e * noise_e);
  };
  add(0.0);
  for (double sky_e = first_sky_e; sky_e < full_sky_e_; sky_e *= std::exp2(1.0 / steps_per_octave))
    add(sky_e);
  add(std::max(full_sky_e_, 2.0 * first_sky_e));
}

double NoiseTable::noise_e(double sky_e) const {
  const auto after = std::upper_bound(sky_e_.begin(), sky_e_.end(), sky_e);
  if (after == sky_e_.end()) return std::sqrt(variance_e2_.back());
  const std::size_t k = std::max<std::size_t>(1, std::size_t(after - sky_e_.begin()));
  const double share = std::max(0.0, (sky_e - sky_e_[k - 1]) / (sky_e_[k] - sky_e_[k - 1]));
  return std::sqrt(variance_e2_[k - 1] + share * (variance_e2_[k] - variance_e2_[k - 1]));
}

}  // namespace dmise
