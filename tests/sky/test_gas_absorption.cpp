#include "core/sky/air/gas_absorption.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/star_spectrum.h"
#include "core/sky/air/extinction.h"

namespace dmise {
namespace {

constexpr double sea_level_hpa = 1013.25;

Band top_hat(const char* name, double low_nm, double high_nm) {
  return {name, 0.5 * (low_nm + high_nm) * nm, (high_nm - low_nm) * nm, {}};
}

/// What is absorbed of sunlight.
double absorption_mag(const Band& band, const AirGases& gases, double airmass) {
  return magnitude_of_light(BandGases(band, {}, gases).of_star(airmass, sun_bv));
}

struct Row {
  const char* band;
  double low_nm, high_nm, pwv_mm, airmass, mag;
};
constexpr Row spectrl2[] = {
#include "tests/sky/gas_absorption_reference.inc"
};

// Reference: SPECTRL2 as pvlib computes it (tests/reference/molecular_bands.py).
TEST(GasAbsorption, IsSpectrl2InEveryBand) {
  for (const Row& row : spectrl2)
    EXPECT_NEAR(absorption_mag(top_hat(row.band, row.low_nm, row.high_nm),
                               {row.pwv_mm, sea_level_hpa}, row.airmass),
                row.mag, 0.004)
        << row.band << " " << row.pwv_mm << " mm, X " << row.airmass;
}

// Reference: ASTM G173-03, the standard's direct light over the extraterrestrial, scattering and
// ozone divided out (tests/reference/molecular_bands.py): 14.16 mm, airmass 1.5.
TEST(GasAbsorption, BesideTheStandardSpectrumOfTheGround) {
  constexpr Row standard[] = {
      {"R", 610, 720, 14.16, 1.5, 0.0381},   {"I", 730, 880, 14.16, 1.5, 0.0719},
      {"Y", 970, 1070, 14.16, 1.5, 0.0363},  {"J", 1170, 1330, 14.16, 1.5, 0.1223},
      {"H", 1490, 1780, 14.16, 1.5, 0.0847}, {"K", 2030, 2370, 14.16, 1.5, 0.1389}};
  for (const Row& row : standard)
    EXPECT_NEAR(absorption_mag(top_hat(row.band, row.low_nm, row.high_nm),
                               {row.pwv_mm, sea_level_hpa}, row.airmass),
                row.mag, 0.025)
        << row.band;
}

// Against the integral itself, with the air's extinction in it, also between the nodes.
TEST(GasAbsorption, TheTableIsTheIntegral) {
  const Curve extinction = with_haze_beyond(*extinction_of_site("mauna_kea"));
  const AirGases gases{3.0, 620.0};
  for (const Band& band : {top_hat("J", 1170, 1330), top_hat("SWIR", 900, 1700)}) {
    const BandGases table(band, extinction, gases);
    for (const double x : {1.0, 1.7, 3.0})
      for (const double bv : {0.0, 0.65, 1.7}) {
        const StarSpectrum star = star_spectrum(bv);
        const Band scattered = through(band, air_transmission(extinction, x));
        const double expected = photon_rate(star, through(scattered, gas_transmission(gases, x))) /
                                photon_rate(star, scattered);
        EXPECT_NEAR(table.of_star(x, bv), expected, 0.002) << band.name << x;
      }
  }
}

// Without water oxygen and carbon dioxide are left; in a vacuum nothing.
TEST(GasAbsorption, WithoutWaterTheMixedGasesAreLeft) {
  const AirGases dry{0.0, sea_level_hpa};
  const auto mag = [&](double low_nm, double high_nm) {
    return absorption_mag(top_hat("b", low_nm, high_nm), dry, 1.0);
  };
  EXPECT_GT(mag(759, 769), 0.15);  // the A band of oxygen
  EXPECT_EQ(mag(900, 960), 0.0);   // water alone
  EXPECT_NEAR(mag(400, 590), 0.0, 1e-9);
  EXPECT_EQ(absorption_mag(top_hat("all", 300, 2500), {0.0, 0.0}, 38.0), 0.0);
}

TEST(GasAbsorption, IsFiniteInEveryBandDownToTheHorizon) {
  for (const Band& band : {top_hat("line", 1395, 1396), top_hat("all", 300, 2500),
                           top_hat("beyond", 4500, 4900), top_hat("water", 2690, 2710)})
    for (const double pwv_mm : {0.0, 0.3, 100.0}) {
      const BandGases table(band, with_haze_beyond(*extinction_of_site("lick")),
                            {pwv_mm, sea_level_hpa});
      double last = 1.0;
      for (const double x : {0.0, 1.0, 5.0, 37.9, 1e9}) {
        const double t = table.of_star(x, NAN);
        EXPECT_GT(t, 0.0);
        EXPECT_LE(t, last + 1e-12) << band.name << " " << pwv_mm << " " << x;
        last = t;
      }
    }
  EXPECT_THROW(gas_transmission({-1.0, 1000.0}, 1.0), Error);
  EXPECT_THROW(gas_transmission({NAN, 1000.0}, 1.0), Error);
  EXPECT_FALSE(GasAbsorption::applies({.on_ground = false, .gases = true}));
  EXPECT_FALSE(GasAbsorption::applies({.on_ground = true}));
}

// Haze goes on from the end of a site's curve.
TEST(Extinction, GoesOnBeyondTheCurveAsHaze) {
  const Curve curve = with_haze_beyond(*extinction_of_site("paranal"));
  EXPECT_EQ(curve.at_or_end(1100 * nm), 0.022);
  EXPECT_NEAR(curve.at_or_end(2200 * nm), 0.022 * std::pow(2.0, -1.3), 1e-5);
  EXPECT_GT(curve.wavelength_m.back(), 3.9 * um);
}

}  // namespace
}  // namespace dmise
