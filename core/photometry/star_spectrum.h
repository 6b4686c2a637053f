#pragma once
#include "core/photometry/band.h"
#include "core/photometry/curve.h"

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

/// Spectrum of stars of one B-V, up to a factor: a black body of the colour temperature times
/// factors, linear between eight wavelengths from 360 to 2159 nm, that give it the mean colours of
/// real stars in UBVRIJHK: of dwarfs to B-V = 0.95, of giants from 1.16. Source: Pecaut & Mamajek
/// 2013, ApJS 208, 9; Landolt 1992, AJ 104, 340; Yale Bright Star Catalogue. Lines and the Balmer
/// jump are smoothed out. Reddened stars, dwarfs as red as giants and white dwarfs differ.
struct StarSpectrum {
  double kelvin = 0.0;
  Curve factors;

  /// Photons by wavelength, up to the factor.
  double photons_at(double wavelength_m) const;
};

/// `bv` is clamped as by `colour_temperature`.
StarSpectrum star_spectrum(double bv);

/// Photon rate of a star of one B-V in `band`, up to a factor that depends on the B-V alone.
double photon_rate(const StarSpectrum& star, const Band& band);

}  // namespace dmise
