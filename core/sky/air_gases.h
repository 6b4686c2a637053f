#pragma once
#include "core/photometry/curve.h"

namespace dmise {

/// Gases over a site that absorb in bands.
struct AirGases {
  double pwv_mm = 0.0;            // water vapour as a layer of water towards the zenith, [0, 100]
  double pressure_hpa = 1013.25;  // of the air with oxygen, carbon dioxide and methane, [0, 1100]

  bool operator==(const AirGases&) const = default;
};

/// Transmission over wavelength, 0.3-4 um, at an airmass >= 0: water vapour exp(-0.2385 a W X / (1
/// + 20.07 a W X)^0.45) with W in cm, mixed gases exp(-1.41 u X' / (1 + 118.3 u X')^0.45) with X' =
/// X P / 1013.25 hPa; linear between 122 wavelengths. Beyond its ends the end values. Source: Bird
/// & Riordan 1986, J. Climate Appl. Meteor. 25, 87, equations 2-8 and 2-11. In bands within 0.03
/// mag of ASTM G173 (`GasAbsorption.BesideTheStandardSpectrumOfTheGround`).
Curve gas_transmission(const AirGases& gases, double airmass);

/// Continues an extinction curve beyond its red end to 4 um, every 100 nm, by the power -1.3 of the
/// wavelength, as haze does. Source of the power: Patat et al. 2011, A&A 527, A91 (-1.38).
Curve with_haze_beyond(const Curve& extinction_mag_per_airmass);

}  // namespace dmise
