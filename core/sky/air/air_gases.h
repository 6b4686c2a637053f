#pragma once
#include "core/photometry/curve.h"

namespace dmise {

/// Gases over a site that absorb in bands.
struct AirGases {
  double pwv_mm = 0.0;            // water vapour as a layer of water towards the zenith, [0, 100]
  double pressure_hpa = 1013.25;  // oxygen, carbon dioxide and methane go with it, [0, 1100]
  double temperature_k = 288.15;  // air at the site; matters beyond 2.5 um alone

  bool operator==(const AirGases&) const = default;
};

/// Water vapour towards the zenith [mm] where a site has no `pwv_mm`: that of the U.S. Standard
/// Atmosphere (14.2 mm, ASTM G173) over the sea, less by a scale height of 2 km. Paranal's median
/// is 2.4 mm (Kerber et al. 2014, MNRAS 439, 247) and this 3.8: bands beyond 2.5 um need the figure
/// itself.
double usual_pwv_mm(double height_m);

/// Transmission over wavelength, 0.3-25 um, at an airmass >= 0. Beyond the ends it has the end
/// values. To 2.5 um water vapour is exp(-0.2385 a W X / (1 + 20.07 a W X)^0.45) with W in cm, and
/// mixed gases exp(-1.41 u X' / (1 + 118.3 u X')^0.45) with X' = X P / 1013.25 hPa; linear between
/// wavelengths. Beyond 2.5 um it is that of `infrared_air`. Source: Bird & Riordan 1986, J. Climate
/// Appl. Meteor. 25, 87, equations 2-8 and 2-11. In bands within 0.03 mag of ASTM G173
/// (`GasAbsorption.BesideTheStandardSpectrumOfTheGround`).
Curve gas_transmission(const AirGases& gases, double airmass);

/// Continues an extinction curve beyond its red end to 4 um, every 100 nm, by the power -1.3 of the
/// wavelength, as haze does. Source of the power: Patat et al. 2011, A&A 527, A91 (-1.38).
Curve with_haze_beyond(const Curve& extinction_mag_per_airmass);

}  // namespace dmise
