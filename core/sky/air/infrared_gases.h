#pragma once
#include <vector>

#include "core/sky/air/air_gases.h"

namespace dmise {

/// Air towards space at one wavelength. Water vapour, carbon dioxide and other mixed gases lie
/// below the ozone.
struct InfraredAir {
  double wavelength_m = 0.0;
  double lower_depth = 0.0, ozone_depth = 0.0;  // optical depths
  double height_m = 0.0;                        // from which the lower gases radiate, over the site
};

/// The air at 2.506 to 25 um, every 10 cm-1, by rising wavelength. Depths are
///   water lines  a (W X P^0.9 T^2)^0.55     water, continuum  (b W / T^2 + c P) W X
///   mixed gases  d (X P^1.76)^p             ozone  e X^0.73
/// with water W [mm], airmass X, P of 1013.25 hPa and T of 288.15 K at the site; the height is the
/// table's times P^0.08. Source: LOWTRAN 7
/// (Kneizys et al. 1988, AFGL-TR-88-0177) in the U.S. Standard Atmosphere, 20 cm-1 wide, with 330
/// ppm of carbon dioxide (tests/reference/infrared_gas_tables.py).
std::vector<InfraredAir> infrared_air(const AirGases& gases, double airmass);

/// Ends of the table [m].
inline constexpr double infrared_from_m = 1e-2 / 3990, infrared_to_m = 1e-2 / 400;

}  // namespace dmise
