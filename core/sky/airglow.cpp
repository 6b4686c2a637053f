#include "core/sky/airglow.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/airmass.h"
#include "core/sky/surface_brightness.h"

namespace dmise {

ErrorBound Airglow::error(int, const PlanFacts& f) { return f.without_part(SkyPart::airglow); }

double Airglow::cost_s(int level, const PlanFacts& f) { return level * 75e-9 * f.sky_looks(); }

double van_rhijn(double sin_altitude, double layer_height_m) {
  constexpr double earth_radius_m = 6378e3;
  const double s = std::clamp(sin_altitude, 0.0, 1.0);
  const double ratio = earth_radius_m / (earth_radius_m + layer_height_m);
  return 1.0 / std::sqrt(1.0 - ratio * ratio * (1.0 - s * s));
}

double airglow_s10(const Airglow& airglow, double sin_altitude, double diffuse_extinction_mag) {
  return airglow_by_solar_flux(airglow.solar_flux_sfu) *
         s10_of_mag_per_arcsec2(airglow.zenith_v_mag_per_arcsec2) *
         van_rhijn(sin_altitude, airglow.layer_height_m) *
         light_of_magnitude(diffuse_extinction_mag * (scattering_airmass(sin_altitude) - 1.0));
}

double airglow_by_solar_flux(const std::optional<double>& solar_flux_sfu) {
  const auto light = [](double sfu) { return 0.2068 + 0.006139 * sfu; };
  return solar_flux_sfu ? light(*solar_flux_sfu) / light(130.0) : 1.0;
}

namespace {

const Spectrum& usual_spectrum() {
  static const Spectrum spectrum = [] {
    // Relative flux per wavelength from 350 nm on, every 10 nm.
    static constexpr double visible[] = {
        0.23, 0.21, 0.21, 0.23, 0.28, 0.29, 0.31, 0.32, 0.35, 0.42, 0.42, 0.45, 0.47,
        0.51, 0.52, 0.53, 0.54, 0.61, 0.63, 0.68, 1.31, 2.08, 0.83, 1.02, 1.71, 1.03,
        0.96, 1.29, 2.88, 1.36, 1.24, 1.06, 0.88, 1.29, 1.72, 1.35, 1.05, 1.91, 3.49,
        2.41, 2.34, 1.96, 4.10, 6.04, 6.24, 4.82, 2.15, 2.31, 7.36, 9.19, 4.84, 4.36,
        5.79, 12.5, 13.1, 6.62, 2.53, 2.62, 12.9, 18.4, 16.2, 9.20, 17.5};
    // OH of an average night: the whole dark sky then has I = 19.8 mag/arcsec2 (Patat 2003, A&A
    // 400, 1183).
    constexpr double oh_scale = 0.6;
    // Herzberg's bands of O2, likewise: U = 22.1 (Patat 2003: 22.3; Benn & Ellison 1998: 22.0).
    constexpr double herzberg_scale = 4.2;
    // Means over 100 nm, of OH. Thermal emission of the air, from 2.2 um on, is another part.
    static constexpr double infrared[][2] = {{1000, 9.0},  {1100, 10.0}, {1250, 13.0}, {1400, 15.0},
                                             {1500, 40.0}, {1600, 48.0}, {1700, 48.0}, {1800, 25.0},
                                             {1900, 8.0},  {2000, 11.0}, {2100, 9.0},  {2200, 4.0},
                                             {2250, 0.0},  {100000, 0.0}};
    Curve curve{{200 * nm, 300 * nm}, {0.0, herzberg_scale * 0.23}};
    double at_nm = 350;
    for (const double flux : visible) {
      curve.add(at_nm * nm, flux * (at_nm < 400 ? herzberg_scale : at_nm < 700 ? 1.0 : oh_scale));
      at_nm += 10;
    }
    for (const auto& [wavelength_nm, flux] : infrared) {
      curve.add(wavelength_nm * nm, flux);
    }
    return Spectrum{curve};
  }();
  return spectrum;
}

}  // namespace

Spectrum airglow_spectrum(double brighter) {
  Spectrum spectrum = usual_spectrum();
  Curve& curve = spectrum.irradiance;
  for (std::size_t i = 0; i < curve.value.size(); ++i)
    if (curve.wavelength_m[i] > 695 * nm) curve.value[i] /= brighter;
  return spectrum;
}

}  // namespace dmise
