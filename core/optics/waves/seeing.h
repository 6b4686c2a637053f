#pragma once
#include <cmath>
#include <limits>

namespace dmise {

/// Turbulence in front of one sensor, along its line of sight.
struct SensorSeeing {
  double r0_m = 0.1;  // Fried's parameter at 0.5 um, > 0; infinite: none
  double outer_scale_m = std::numeric_limits<double>::infinity();  // in von Karman's spectrum
  double wind_m_per_s = 10.0;       // moves the frozen screen past the aperture, >= 0
  double wind_direction_deg = 0.0;  // towards which it moves: 0 is +x of the image, 90 is +y

  /// Fried's parameter at another wavelength: proportional to wavelength^(6/5).
  double r0_at_m(double wavelength_m) const { return r0_m * std::pow(wavelength_m / 0.5e-6, 1.2); }
  /// Time in which the screen moves by r0, the boundary between short and long exposures.
  double tau0_s(double wavelength_m) const {
    return wind_m_per_s > 0.0 ? r0_at_m(wavelength_m) / wind_m_per_s
                              : std::numeric_limits<double>::infinity();
  }
};

}  // namespace dmise
