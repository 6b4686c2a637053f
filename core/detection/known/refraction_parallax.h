#pragma once
#include "core/products/frame_header.h"

namespace dmise {

/// Prior of a detected object's altitude above the mean sphere [m]: uniform in its logarithm
/// between these two (decision 0064).
inline constexpr double lowest_altitude_m = 300e3, highest_altitude_m = 35786e3;

/// Residual refraction of a direction measured relative to the stars: the stars' refraction is
/// removed, but light of a near body travels along a line that passes beside the sensor. At range d
/// the body is norm(offset_m) / d higher than measured. One frame does not determine d: `mean_rad`
/// and `sigma_rad` are the moments of that angle over the altitudes above. All 0 without
/// refraction.
struct RefractionParallax {
  Vec<Gcrs> offset_m;  // from the sensor, perpendicular, to the line of sight outside the air
  Vec<Gcrs> upwards;   // unit: towards the zenith, perpendicular to the direction; 0 at the zenith
  double mean_rad = 0.0, sigma_rad = 0.0;
};

/// `direction`: unit, ICRS, from the WCS.
RefractionParallax refraction_parallax(const FrameHeader& header, const Vec<Gcrs>& direction);

}  // namespace dmise
