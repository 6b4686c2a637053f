#pragma once
#include <array>

#include "core/effects/effects.h"
#include "core/frames/vec.h"
#include "core/photometry/spectrum.h"

namespace dmise {

/// Sunlight scattered high up while the Sun is below the horizon: brightest above where it stands.
struct Twilight {
  static constexpr EffectFacts facts{
      "twilight", "sunlight scattered by the air with the Sun below the horizon",
      "18 mag/arcsec2 with the Sun 10 deg down",
      "Patat et al. 2006, A&A 455, 385; orders of scattering in spherical air"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  double factor = 1.0;
};

/// Brightness of the zenith [S10 in V] by the Sun's altitude [rad]. Depression 5-14 deg: 11.84 +
/// 1.518 x - 0.057 x^2 mag/arcsec2, x = depression - 5 deg, the dark sky of 21.7 subtracted.
/// Source: Patat, Ugolnikov & Postylyakov 2006, A&A 455, 385, table 1. Deeper, it goes on falling
/// at the slope of 14 deg and by the square of the rest (it is gone, below 1 S10, at 18 deg);
/// higher, it joins 7.2 mag/arcsec2 at sunset (+-0.5 mag) and is held at 4 by day.
double twilight_zenith_s10(double sun_altitude_rad);

/// Brightness over the sky, 1 at the zenith: exp of a polynomial of X, the component of the
/// direction towards the Sun's azimuth, and V = c (1 - s) / (s + c), s the sine of the altitude,
/// 0 at the zenith and 1 at the horizon. Coefficients are linear between depressions of 0 to 18 deg
/// and held outside of them. They are fitted to all orders of scattering in spherical air over a
/// Lambertian ground (tests/reference/twilight_light.py).
class TwilightPattern {
 public:
  explicit TwilightPattern(const Vec<Enu>& sun);

  /// `direction`: unit; below the horizon continuous, without a meaning.
  double over_zenith(const Vec<Enu>& direction) const;

 private:
  static constexpr std::size_t powers_of_x = 7, powers_of_v = 5;
  std::array<std::array<double, powers_of_v>, powers_of_x> coefficients_{};
  double sun_east_ = 0.0, sun_north_ = 0.0;  // unit
};

/// Colour by the Sun's altitude [rad], 0.2-2.5 um: sunlight times factors that give it the UBVRI of
/// Patat et al. 2006, table 1, for depressions of 5 to 14 deg, the night sky of Patat 2003
/// subtracted; held outside of them.
Spectrum twilight_spectrum(double sun_altitude_rad);

}  // namespace dmise
