#include "core/sky/thermal_sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/planck.h"
#include "core/sky/air/airmass.h"
#include "core/sky/air/gas_absorption.h"
#include "core/sky/air/infrared_gases.h"
#include "core/sky/sky_model.h"

namespace dmise {
namespace {

Band top_hat(const char* name, double low_nm, double high_nm) {
  return {name, 0.5 * (low_nm + high_nm) * nm, (high_nm - low_nm) * nm, {}};
}

struct LowtranRow {
  const char* band;
  double low_nm, high_nm, pwv_mm, pressure_hpa, temperature_k, airmass, transmission, photons;

  AirGases gases() const {
    return {.pwv_mm = pwv_mm, .pressure_hpa = pressure_hpa, .temperature_k = temperature_k};
  }
};
constexpr LowtranRow lowtran[] = {
#include "tests/sky/infrared_air_reference.inc"
};

double mean_transmission(const Band& band, const AirGases& gases, double airmass) {
  const Curve curve = gas_transmission(gases, airmass);
  constexpr int steps = 4000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i)
    sum += curve.at_or_end(band.low_m() + (i + 0.5) / steps * band.width_m);
  return sum / steps;
}

/// Sine of the altitude with that airmass.
double sine_of(double x) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (airmass(std::asin(middle)) > x ? low : high) = middle;
  }
  return high;
}

// Reference: LOWTRAN 7 itself, integrated by numpy (tests/reference/infrared_air.py).
TEST(GasAbsorption, IsThatOfLowtranInThermalBands) {
  for (const LowtranRow& row : lowtran)
    EXPECT_NEAR(
        mean_transmission(top_hat(row.band, row.low_nm, row.high_nm), row.gases(), row.airmass),
        row.transmission, 0.02 * row.transmission + 0.005)
        << row.band << " " << row.pwv_mm << " mm, " << row.pressure_hpa << " hPa, X "
        << row.airmass;
}

// Reference: LOWTRAN's own sums of the emission of layers, integrated by numpy.
TEST(ThermalSky, IsTheRadianceOfLowtran) {
  double sum = 0.0;
  for (const LowtranRow& row : lowtran) {
    const AirRadiance air(top_hat(row.band, row.low_nm, row.high_nm), row.gases());
    const double ratio = air.photons_per_s_m2_sr(sine_of(row.airmass)) / row.photons;
    EXPECT_NEAR(ratio, 1.0, 0.05) << row.band << " " << row.pwv_mm << " mm, " << row.pressure_hpa
                                  << " hPa, X " << row.airmass;
    sum += (ratio - 1.0) * (ratio - 1.0);
  }
  EXPECT_LT(std::sqrt(sum / std::size(lowtran)), 0.04);
}

TEST(ThermalSky, OfOpaqueAirIsABlackBodyOfTheSitesTemperature) {
  const Band band = top_hat("water", 6200, 6600);
  const AirGases humid{.pwv_mm = 20.0, .pressure_hpa = 1013.25, .temperature_k = 290.0};
  const double black = photons_of_radiance(
      band, [](double wavelength_m) { return planck_w_per_m2_sr_m(wavelength_m, 290.0); });
  EXPECT_NEAR(AirRadiance(band, humid).photons_per_s_m2_sr(0.1) / black, 1.0, 0.15);
}

TEST(ThermalSky, RisesToTheHorizonWithWaterAndWithTemperature) {
  const Band n = top_hat("N", 8000, 13000);
  const AirGases dry{.pwv_mm = 0.0, .pressure_hpa = 600.0, .temperature_k = 273.0};
  AirGases humid = dry, warm = dry;
  humid.pwv_mm = 3.0;
  warm.temperature_k = 283.0;
  double last = 1e30;
  for (const double sine : {-0.5, 0.0, 0.01, 0.1, 0.3, 0.5, 0.9, 1.0}) {
    const double light = AirRadiance(n, dry).photons_per_s_m2_sr(sine);
    EXPECT_TRUE(std::isfinite(light));
    EXPECT_LE(light, last);
    EXPECT_LT(light, AirRadiance(n, humid).photons_per_s_m2_sr(sine));
    EXPECT_LT(light, AirRadiance(n, warm).photons_per_s_m2_sr(sine));
    last = light;
  }
  const AirGases none{.pwv_mm = 0.0, .pressure_hpa = 0.0, .temperature_k = 273.0};
  EXPECT_TRUE(std::isfinite(AirRadiance(n, none).photons_per_s_m2_sr(0.2)));
}

TEST(ThermalSky, IsAPartOfTheSkyInThermalBandsAlone) {
  SkyParts parts;
  parts.thermal_sky = ThermalSky{};
  const SkyScene scene;
  EXPECT_EQ(SkyModel(parts, scene, johnson_v(), {}).photons_per_s_m2_sr({0, 0, 1}), 0.0);
  const Band n = top_hat("N", 8000, 13000);
  const double light = SkyModel(parts, scene, n, {}).photons_per_s_m2_sr({0, 0, 1});
  EXPECT_EQ(light, AirRadiance(n, scene.warm_air).photons_per_s_m2_sr(1.0));
  EXPECT_GT(light, 0.0);
  SkyScene space;
  space.in_air = false;
  EXPECT_EQ(SkyModel(parts, space, n, {}).photons_per_s_m2_sr({0, 0, 1}), 0.0);
}

struct BackgroundRow {
  const char* band;
  double low_nm, high_nm, vega_jy, mag, scatter_mag;
};

// Reference: sky and telescope measured with NSFCAM at the IRTF on Mauna Kea [mag/arcsec2], L' 4.3
// (March 1998) and 4.8 (later), M' 1.5, as the IRTF publishes them. One emissivity of the
// telescope, 0.18 at 275 K, must give both bands. Vega: Tokunaga & Vacca 2005, PASP 117, 421,
// table 1.
TEST(ThermalSky, WithAWarmTelescopeIsTheBackgroundMeasuredOnMaunaKea) {
  const AirGases mauna_kea{.pwv_mm = 1.6, .pressure_hpa = 616.0, .temperature_k = 274.0};
  constexpr BackgroundRow rows[] = {{"L'", 3424, 4124, 249.0, 4.55, 0.25},
                                    {"M'", 4571, 4812, 160.0, 1.5, 0.25}};
  constexpr double arcsec2_sr = arcsec * arcsec, emissivity = 0.18;
  for (const BackgroundRow& row : rows) {
    const Band band = top_hat(row.band, row.low_nm, row.high_nm);
    const double zero = ab_zero_point_photons_per_s_m2(band) * row.vega_jy / 3631.0;
    const double telescope = emissivity * photons_of_radiance(band, [](double wavelength_m) {
                               return planck_w_per_m2_sr_m(wavelength_m, 275.0);
                             });
    const double sky = AirRadiance(band, mauna_kea).photons_per_s_m2_sr(1.0);
    EXPECT_NEAR(magnitude_of_light((sky + telescope) * arcsec2_sr / zero), row.mag, row.scatter_mag)
        << row.band;
  }
}

}  // namespace
}  // namespace dmise
