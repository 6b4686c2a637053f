#include "core/photometry/star_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

// Reference: tests/reference/star_colours.py (astropy's Planck law, scipy's quadrature).
TEST(StarLight, BlackBodyAgreesWithPlancksLaw) {
  const auto band = [](double low, double high) {
    return Band{"hat", (low + high) / 2 * um, (high - low) * um, {}};
  };
  const struct {
    double kelvin, v, i;
  } expected[] = {{3500, 13.860061750734648, 34.07831860609958},
                  {5778, 10.611573149804277, 9.664532313840363},
                  {20000, 8.381646996266502, 2.9679040412997155}};
  for (const auto& [kelvin, v, i] : expected) {
    const double reference = black_body_photon_rate(kelvin, band(0.5, 0.51));
    EXPECT_NEAR(black_body_photon_rate(kelvin, band(0.5, 0.6)) / reference, v, 1e-6 * v);
    EXPECT_NEAR(black_body_photon_rate(kelvin, band(0.8, 0.9)) / reference, i, 1e-6 * i);
  }
}

// Ballesteros 2012: the Sun's B-V of 0.65 gives its effective temperature, 5772 K, to 10 K.
TEST(StarLight, ColourTemperature) {
  EXPECT_NEAR(colour_temperature(0.65).kelvin, 5772, 10);
  EXPECT_FALSE(colour_temperature(0.65).clamped);
  EXPECT_NEAR(colour_temperature(0.0).kelvin, 10125, 1);
}

TEST(StarLight, ColoursOutsideTheFormulaAreClampedAndFlagged) {
  for (const double bv : {-0.674, -5.0, -0.41, 2.01, 5.46, double(NAN), double(INFINITY)}) {
    const ColourTemperature t = colour_temperature(bv);
    EXPECT_TRUE(t.clamped) << bv;
    EXPECT_GT(t.kelvin, 3000) << bv;
    EXPECT_LT(t.kelvin, 22000) << bv;
    EXPECT_TRUE(std::isfinite(StarLight(Band{}).photons_per_s_m2(3.0, bv))) << bv;
  }
}

TEST(StarLight, AStarHasItsVMagnitudeInV) {
  const StarLight light(johnson_v());
  EXPECT_NEAR(light.photons_per_s_m2(0.0, 0.0), 8.75e9, 0.01 * 8.75e9);
  EXPECT_NEAR(light.photons_per_s_m2(5.0, 1.5), 8.75e7, 0.01 * 8.75e7);
}

double magnitude(const char* filter, double bv) {
  const Band band = *filter_named(filter);
  return magnitude_of_light(StarLight(band).photons_per_s_m2(0, bv) /
                            zero_point_photons_per_s_m2(band));
}

// Medians of stars about a B-V, by tests/reference/star_spectra.py --check. U-B: the Yale Bright
// Star Catalogue, all classes (of 49 to 461 stars each); V-R and V-I: Landolt's standards, 1992, AJ
// 104, 340 (14 to 72 each; some reddened by dust, which moves V-I by 0.05 at a given B-V). Of the
// stars of the Yale catalogue that are bluer than 0 many are reddened or no dwarfs.
TEST(StarLight, HasTheColoursOfTheStarsOfCatalogues) {
  const double u[][2] = {{-0.2, -0.82}, {-0.1, -0.45}, {0.0, -0.05}, {0.1, 0.09}, {0.2, 0.11},
                         {0.3, 0.07},   {0.4, -0.01},  {0.5, 0.01},  {0.6, 0.10}, {0.7, 0.24},
                         {0.8, 0.45},   {0.9, 0.59},   {1.0, 0.79},  {1.1, 1.01}, {1.2, 1.21},
                         {1.3, 1.42},   {1.4, 1.60},   {1.5, 1.79},  {1.6, 1.92}, {1.7, 1.94}};
  for (const auto& [bv, ub] : u) {
    EXPECT_NEAR(magnitude("bessell-B", bv), bv, 0.005) << bv;
    EXPECT_NEAR(magnitude("bessell-U", bv), bv + ub, bv < -0.05 ? 0.13 : 0.05) << bv;
  }
  const double ri[][3] = {{-0.25, -0.120, -0.280}, {-0.15, -0.062, -0.156}, {0.2, 0.104, 0.215},
                          {0.4, 0.262, 0.545},     {0.5, 0.313, 0.626},     {0.6, 0.358, 0.714},
                          {0.7, 0.406, 0.808},     {0.8, 0.464, 0.890},     {1.0, 0.563, 1.087}};
  for (const auto& [bv, vr, vi] : ri) {
    EXPECT_NEAR(magnitude("bessell-R", bv), -vr, 0.04) << bv;
    EXPECT_NEAR(magnitude("bessell-I", bv), -vi, 0.09) << bv;
  }
}

// The Sun, whose spectrum is known (ASTM E490), as a star of its B-V of 0.65.
TEST(StarLight, TheSunAmongStars) {
  const Band v = johnson_v();
  for (const char* name : {"bessell-U", "bessell-B", "bessell-R", "bessell-I", "sdss-g", "sdss-r",
                           "sdss-i", "sdss-z"}) {
    const Band band = *filter_named(name);
    const double sun =
        photon_rate_per_m2(solar_spectrum(), band) / photon_rate_per_m2(solar_spectrum(), v);
    const double star =
        StarLight(band).photons_per_s_m2(0, 0.65) / StarLight(v).photons_per_s_m2(0, 0.65);
    EXPECT_NEAR(magnitude_of_light(star / sun), 0.0, 0.06) << name;
  }
}

// Vega, whose spectrum is known (CALSPEC), as a star of B-V = 0.
TEST(StarLight, VegaAmongStars) {
  const Band v = johnson_v();
  for (const char* name : {"bessell-U", "bessell-B", "bessell-R", "bessell-I", "sdss-g", "sdss-r",
                           "sdss-i", "sdss-z"}) {
    const Band band = *filter_named(name);
    const double vega =
        photon_rate_per_m2(vega_spectrum(), band) / photon_rate_per_m2(vega_spectrum(), v);
    const double star =
        StarLight(band).photons_per_s_m2(0, 0.0) / StarLight(v).photons_per_s_m2(0, 0.0);
    EXPECT_NEAR(magnitude_of_light(star / vega), 0.0, 0.07) << name;
  }
}

TEST(StarLight, TheTableIsTheIntegralTo1e4) {
  const Band band = *filter_named("sdss-z");
  const StarLight light(band);
  for (double bv = -0.4; bv <= 2.0; bv += 0.0137) {
    const StarSpectrum star = star_spectrum(bv);
    const double rate = zero_point_photons_per_s_m2(johnson_v()) * photon_rate(star, band) /
                        photon_rate(star, johnson_v());
    EXPECT_NEAR(light.photons_per_s_m2(0.0, bv), rate, 1e-4 * rate) << bv;
  }
}

}  // namespace
}  // namespace dmise
