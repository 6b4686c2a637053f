#pragma once
#include "core/products/frame_header.h"

namespace dmise {

/// Altitudes over the mean sphere [m] that a detected object is taken to have: evenly likely in
/// their logarithm between these two (decision 0064).
inline constexpr double lowest_altitude_m = 300e3, highest_altitude_m = 35786e3;

/// What refraction leaves in a direction that was read off the stars: the stars' share of it is
/// gone, but light of a near body comes along a line that passes the sensor aside. At range d the
/// body stands norm(offset_m) / d higher than it was read. One frame does not tell d: `mean_rad`
/// and `sigma_rad` are those of that angle over the altitudes above. All 0 where no air refracts.
struct RefractionParallax {
  Vec<Gcrs> offset_m;  // from the sensor to the line of sight outside the air, square to it
  Vec<Gcrs> upwards;   // unit: towards the zenith, square to the direction; 0 at the zenith
  double mean_rad = 0.0, sigma_rad = 0.0;
};

/// `direction`: unit, ICRS, as the WCS has it.
RefractionParallax refraction_parallax(const FrameHeader& header, const Vec<Gcrs>& direction);

}  // namespace dmise
