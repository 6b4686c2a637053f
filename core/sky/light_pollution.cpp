#include "core/sky/light_pollution.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/airmass.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

struct Line {
  double centre_nm, sigma_nm, power;
};
constexpr Line low_pressure_sodium[] = {{589.3, 1.5, 1.0}};
constexpr Line high_pressure_sodium[] = {{440, 10, 0.024}, {467, 3, 0.016}, {498, 3, 0.031},
                                         {515, 4, 0.008},  {567, 6, 0.180}, {583, 5, 0.130},
                                         {597, 9, 0.290},  {616, 6, 0.060}, {640, 25, 0.100},
                                         {720, 30, 0.040}, {767, 4, 0.010}, {819, 6, 0.140}};
constexpr Line led_4000_k[] = {{447, 10, 0.155}, {520, 24, 0.14}, {590, 47, 0.705}};

Spectrum spectrum_of(std::span<const Line> lines) {
  Spectrum spectrum;
  const auto add = [&](double at_nm) {
    double flux = 0.0;
    for (const auto& [centre_nm, sigma_nm, power] : lines) {
      const double t = (at_nm - centre_nm) / sigma_nm;
      flux += power / sigma_nm * std::exp(-0.5 * t * t);
    }
    spectrum.irradiance.add(at_nm * nm, flux);
  };
  add(200);
  for (int at_nm = 380; at_nm <= 880; ++at_nm) add(at_nm);
  add(2500);
  return spectrum;
}

}  // namespace

ErrorBound LightPollution::error(int, const PlanFacts& f) {
  return f.without_part(SkyPart::light_pollution);
}

double LightPollution::cost_s(int level, const PlanFacts& f) {
  return level * 20e-9 * f.sky_looks();
}

Spectrum lamp_spectrum(const LampMix& lamps) {
  const double shares[] = {lamps.lps, lamps.hps, lamps.led};
  const Spectrum each[] = {spectrum_of(low_pressure_sodium), spectrum_of(high_pressure_sodium),
                           spectrum_of(led_4000_k)};
  double sum = 0.0;
  for (const double share : shares) {
    if (!(share >= 0) || !std::isfinite(share)) throw Error("lamps: shares must be >= 0");
    sum += share;
  }
  if (!(sum > 0)) throw Error("lamps: one share must be > 0");
  Spectrum mix = each[0];
  std::fill(mix.irradiance.value.begin(), mix.irradiance.value.end(), 0.0);
  for (int lamp = 0; lamp < 3; ++lamp) {
    const double scale = shares[lamp] / sum / photon_rate_per_m2(each[lamp], johnson_v());
    for (std::size_t i = 0; i < mix.irradiance.value.size(); ++i)
      mix.irradiance.value[i] += scale * each[lamp].irradiance.value[i];
  }
  mix.irradiance.add(mix.irradiance.wavelength_m.back() * 1.001, 0.0);
  mix.irradiance.add(100 * um, 0.0);
  return mix;
}

double light_pollution_s10(const LightPollution& pollution, const Vec<Enu>& direction, double k_v) {
  const double sin_altitude = std::clamp(direction.z, 0.0, 1.0);
  const double k = std::max(k_v, 1e-3);
  double over_zenith = (1.0 - light_of_magnitude(k * scattering_airmass(sin_altitude))) /
                       (1.0 - light_of_magnitude(k));
  for (const CityGlow& city : pollution.cities) {
    // Even in azimuth towards the zenith, so that it has no seam there.
    const double azimuth = std::atan2(direction.x, direction.y);
    const double off = std::remainder(azimuth - city.azimuth_rad, 2 * pi) *
                       std::sqrt(1.0 - sin_altitude * sin_altitude);
    const double across = off / city.half_width_rad;
    over_zenith += city.horizon_over_zenith * std::exp(-0.5 * across * across) *
                   std::exp(-std::asin(sin_altitude) / city.height_rad);
  }
  return s10_of_mag_per_arcsec2(pollution.zenith_v_mag_per_arcsec2) * over_zenith;
}

}  // namespace dmise
