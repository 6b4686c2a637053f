#include "core/sky/twilight.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/numeric/table_place.h"
#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

constexpr double dark_v_mag_per_arcsec2 = 21.7;

double patat_v_mag_per_arcsec2(double depression_deg) {
  const double x = depression_deg - 5.0;
  return 11.84 + 1.518 * x - 0.057 * x * x;
}

/// Twilight without the dark sky, at 5 to 14 deg.
double twilight_mag_per_arcsec2(double depression_deg) {
  return mag_per_arcsec2_of_s10(s10_of_mag_per_arcsec2(patat_v_mag_per_arcsec2(depression_deg)) -
                                s10_of_mag_per_arcsec2(dark_v_mag_per_arcsec2));
}

/// Cubic through (0, y0) and (width, y1) with slopes there.
double hermite(double x, double width, double y0, double slope0, double y1, double slope1) {
  const double t = x / width;
  return y0 + t * (slope0 * width + t * (3 * (y1 - y0) - (2 * slope0 + slope1) * width +
                                         t * (2 * (y0 - y1) + (slope0 + slope1) * width)));
}

double zenith_mag_per_arcsec2(double depression_deg) {
  constexpr double deepest = 14.0, shallowest = 5.0;
  constexpr double sunset = 7.2, sunset_slope = 0.6, day = 4.0;
  if (depression_deg >= deepest) {
    static const double there = twilight_mag_per_arcsec2(deepest);
    static const double slope = (there - twilight_mag_per_arcsec2(deepest - 1e-3)) / 1e-3;
    const double beyond = depression_deg - deepest;
    return there + beyond * (slope + 0.15 * beyond);
  }
  if (depression_deg >= shallowest) return twilight_mag_per_arcsec2(depression_deg);
  if (depression_deg >= 0) {
    static const double there = twilight_mag_per_arcsec2(shallowest);
    static const double slope = (twilight_mag_per_arcsec2(shallowest + 1e-3) - there) / 1e-3;
    return hermite(depression_deg, shallowest, sunset, sunset_slope, there, slope);
  }
  return std::max(sunset + sunset_slope * depression_deg, day);
}

}  // namespace

ErrorBound Twilight::error(int, const PlanFacts& f) { return f.without_part(SkyPart::twilight); }

double Twilight::cost_s(int level, const PlanFacts& f) { return level * 175e-9 * f.sky_looks(); }

double twilight_zenith_s10(double sun_altitude_rad) {
  return s10_of_mag_per_arcsec2(zenith_mag_per_arcsec2(-sun_altitude_rad / deg));
}

TwilightPattern::TwilightPattern(const Vec<Enu>& sun) {
#include "core/sky/twilight_pattern.inc"
  const double depression_deg = -std::asin(std::clamp(sun.z, -1.0, 1.0)) / deg;
  const TablePlace at = table_place(depression_deg / step_deg, std::size(nodes));
  for (std::size_t i = 0; i < powers_of_x; ++i)
    for (std::size_t j = 0; j < powers_of_v; ++j)
      coefficients_[i][j] = std::lerp(nodes[at.node][i][j], nodes[at.node + 1][i][j], at.part);
  const double horizontal = std::hypot(sun.x, sun.y);
  if (!(horizontal > 0.0)) return;
  sun_east_ = sun.x / horizontal;
  sun_north_ = sun.y / horizontal;
}

double TwilightPattern::over_zenith(const Vec<Enu>& direction) const {
  constexpr double near_horizon = 0.3;
  const double s = std::clamp(direction.z, 0.0, 1.0);
  const double v = near_horizon * (1.0 - s) / (s + near_horizon);
  const double x = direction.x * sun_east_ + direction.y * sun_north_;
  double sum = 0.0;
  for (std::size_t i = powers_of_x; i-- > 0;) {
    double of_v = 0.0;
    for (std::size_t j = powers_of_v; j-- > 0;) of_v = of_v * v + coefficients_[i][j];
    sum = sum * x + of_v;
  }
  return std::exp(sum);
}

Spectrum twilight_spectrum(double sun_altitude_rad) {
  // Brightness a0 + a1 x + a2 x^2, x = depression - 5 deg, and that of the night sky; the factor on
  // sunlight at the middle of the band for 5 deg.
  struct BandOfPatat {
    double wavelength_nm, a0, a1, a2, night, factor;
  };
  constexpr BandOfPatat bands[] = {{360, 11.78, 1.376, -0.039, 22.28, 2.4},
                                   {438, 11.84, 1.411, -0.041, 22.64, 2.53},
                                   {545, 11.84, 1.518, -0.057, dark_v_mag_per_arcsec2, 1.0},
                                   {641, 11.40, 1.567, -0.064, 20.87, 1.36},
                                   {798, 10.93, 1.470, -0.062, 19.71, 1.48}};
  constexpr int of_v = 2;
  const double x = std::clamp(-sun_altitude_rad / deg, 5.0, 14.0) - 5.0;
  const auto darker = [](const BandOfPatat& band, double at) {  // than 5 deg down [mag]
    const auto light = [&](double y) {
      return light_of_magnitude(band.a0 + band.a1 * y + band.a2 * y * y) -
             light_of_magnitude(band.night);
    };
    return magnitude_of_light(light(at) / light(0.0));
  };
  Curve factors;
  const auto add = [&](double wavelength_nm, double factor) {
    factors.add(wavelength_nm * nm, factor);
  };
  for (const BandOfPatat& band : bands) {
    const double factor =
        band.factor * light_of_magnitude(darker(band, x) - darker(bands[of_v], x));
    if (factors.empty()) add(300, factor * 2.5 / 2.4);
    add(band.wavelength_nm, factor);
  }
  add(1000, factors.value.back());
  return times(sunlight_spectrum(), [&](double x_m) { return factors.at_or_end(x_m); });
}

}  // namespace dmise
