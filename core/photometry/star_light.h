#pragma once
#include <span>
#include <vector>

#include "core/photometry/band.h"

namespace dmise {

/// Range of B-V [mag] of the colour-temperature relation; values outside are clamped.
inline constexpr double least_bv = -0.4, greatest_bv = 2.0;

struct ColourTemperature {
  double kelvin = 0.0;
  bool clamped = false;  // B-V was outside the range, or NaN, which counts as least_bv
};

/// Black-body temperature of a star by its B-V, 3,168 K at 2.0 to 21,707 K at -0.4.
/// Source: Ballesteros 2012, EPL 97, 34008, equation 14. Its pole is at B-V = -0.674.
ColourTemperature colour_temperature(double bv);

/// Photons/s/m2 of stars in one band above the atmosphere: a black body of the colour temperature,
/// scaled to the star's V magnitude. Differs from real spectra by some 0.15 mag in the visible (0
/// in V) and by 0.3 mag and more in the near infrared for cool stars. Tabulated over B-V, within
/// 1e-4 of the integral.
class StarLight {
 public:
  /// `band`: the complete response, with telescope and atmosphere.
  explicit StarLight(const Band& band);

  double photons_per_s_m2(double v_mag, double bv) const;

  /// For many stars; all spans must have one size.
  void photons_per_s_m2(std::span<const float> v_mag, std::span<const float> bv,
                        std::span<double> rate) const;

 private:
  std::vector<double> at_v_0_;  // by B-V, `step` apart, from least_bv
};

}  // namespace dmise
