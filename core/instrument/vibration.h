#pragma once
#include <vector>

#include "core/base/rng.h"
#include "core/base/sim_time.h"
#include "core/instrument/instrument_effect.h"

namespace dmise {

/// A camera that trembles: right and down by as much each, independently, by a power spectral
/// density and by sinusoids. An exposure of T seconds sees the mean of the tremble, its
/// displacement, and the rest of it as blur: of the power at a frequency f it displaces sinc^2(pi f
/// T) and blurs the rest. Displacements of exposures are those of one tremble in time; the blur is
/// Gaussian, of the mean power, and part of the point spread.
struct Vibration {
  static constexpr EffectFacts facts{
      "vibration", "the camera trembles: exposures are displaced and blurred",
      "its rms: frequencies below that of exposures displace them, those above blur",
      "Lucke, Sirlin & San Martin 1992, J. Astronautical Sciences 40, 557"};
  /// One-sided density of one axis, straight between frequencies that rise, none outside.
  std::vector<double> psd_frequency_hz, psd_rad2_per_hz;
  std::vector<double> sine_frequency_hz, sine_rms_rad;  // of one axis
  bool operator==(const Vibration&) const = default;

  static std::span<const InstrumentParameter> parameters();
  /// Returns why the lists do not go together; empty if they do.
  std::string_view fault() const;
  bool applies() const { return shift_rms_rad(0.0) > 0.0; }
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }

  /// Rms along an axis of what an exposure sees as displacement, and as blur.
  double shift_rms_rad(double exposure_s) const;
  double blur_rad(double exposure_s) const;
  /// The displacement of an exposure about `middle`. `key` is of all exposures of a sensor.
  ImageAxes shift_rad(const RngKey& key, SimTime middle, double exposure_s) const;

 private:
  double power_rad2(double exposure_s, bool of_blur) const;
};

}  // namespace dmise
