#pragma once
#include <algorithm>
#include <cstdint>

#include "core/photometry/band.h"
#include "core/photometry/curve.h"

namespace dmise {

/// Range of B-V [mag] of the colour-temperature relation; values outside are clamped.
inline constexpr double min_bv = -0.4, greatest_bv = 2.0;

/// Black-body temperature [K] of a star by its B-V, 3,168 K at 2.0 to 21,707 K at -0.4; NaN counts
/// as `min_bv`.
/// Source: Ballesteros 2012, EPL 97, 34008, equation 14. Its pole is at B-V = -0.674.
double colour_temperature_k(double bv);

/// Stars whose other colours are not those that most stars of their B-V have.
enum class StarKind : std::uint8_t {
  most,
  red_dwarf,  // B-V from 0.95 on, no number of type M is known
  m0_giant,   // then M1 to M7: B-V stays at 1.6 while V-I grows from 1.8 to 4
  m7_giant = m0_giant + 7,
  m0_dwarf,  // then M1 to M5
  m5_dwarf = m0_dwarf + 5,
};

/// Stars of type M and a number; later ones than M7 are as M7, later dwarfs than M5 as M5.
constexpr StarKind m_giant(int number) {
  return StarKind(int(StarKind::m0_giant) + std::clamp(number, 0, 7));
}
constexpr StarKind m_dwarf(int number) {
  return StarKind(int(StarKind::m0_dwarf) + std::clamp(number, 0, 5));
}

/// What a catalogue tells of a star's spectrum. That of a type M has the B-V of its type.
struct StarColour {
  double bv = 0.0;
  StarKind kind = StarKind::most;

  StarColour(double bv_, StarKind kind_ = StarKind::most) : bv(bv_), kind(kind_) {}  // NOLINT
};

/// Spectrum of stars of one B-V, up to a factor: a black body of the colour temperature times
/// factors, linear between eight wavelengths from 360 to 2159 nm, that give it the mean colours of
/// real stars in UBVRIJHK: of dwarfs to B-V = 0.95, of giants from 1.16. Source: Pecaut & Mamajek
/// 2013, ApJS 208, 9; Landolt 1992, AJ 104, 340; Yale Bright Star Catalogue. Lines and the Balmer
/// jump are smoothed out. Red dwarfs have colours from Pecaut & Mamajek, giants of type M from
/// Bessell & Brett 1988, PASP 100, 1134, and the Yale catalogue. Reddened stars and white
/// dwarfs differ.
struct StarSpectrum {
  double kelvin = 0.0;
  Curve factors;

  /// Photons by wavelength, up to the factor.
  double photons_at(double wavelength_m) const;
};

/// B-V is clamped as by `colour_temperature_k`; red dwarfs have one of 0.95 or more.
StarSpectrum star_spectrum(const StarColour& colour);

/// Photon rate of a star of one colour in `band`, up to a factor that depends on the colour alone.
double photon_rate(const StarSpectrum& star, const Band& band);

}  // namespace dmise
