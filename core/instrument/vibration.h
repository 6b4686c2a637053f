#pragma once
#include <vector>

#include "core/base/numeric/rng.h"
#include "core/base/sim_time.h"
#include "core/effects/accuracy.h"
#include "core/instrument/instrument_effect.h"

namespace dmise {

/// Vibration of a camera along both axes of the image, independent and of equal power, by a power
/// spectral density and by sinusoids. In an exposure of T seconds a share sinc^2(pi f T) of the
/// power at a frequency f displaces the image, and the rest blurs it. The displacements of a
/// sensor's exposures are those of one vibration in time; the blur is Gaussian, of the mean power,
/// and part of the point spread.
struct Vibration {
  static constexpr EffectFacts facts{
      "vibration", "the camera vibrates: exposures are displaced and blurred",
      "its rms: frequencies below that of exposures displace them, those above blur",
      "Lucke, Sirlin & San Martin 1992, J. Astronautical Sciences 40, 557"};
  /// One-sided density of one axis, linear between frequencies in ascending order, 0 outside.
  std::vector<double> psd_frequency_hz, psd_rad2_per_hz;
  std::vector<double> sine_frequency_hz, sine_rms_rad;  // along one axis
  bool operator==(const Vibration&) const = default;

  static std::span<const InstrumentParameter> parameters();
  /// Returns why the lists do not go together; empty if they do.
  std::string_view fault() const;
  bool applies() const { return shift_rms_rad(0.0) > 0.0; }
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }

  /// Rms of the displacement and of the blur of an exposure, along each axis.
  double shift_rms_rad(double exposure_s) const;
  double blur_rad(double exposure_s) const;
  /// Displacement of an exposure whose middle is `middle`. `key`: one for all exposures of a
  /// sensor.
  ImageAxes shift_rad(const RngKey& key, SimTime middle, double exposure_s) const;

 private:
  double power_rad2(double exposure_s, bool of_blur) const;
};

}  // namespace dmise
