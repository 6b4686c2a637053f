#include "core/photometry/star_spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"
#include "core/photometry/star_light.h"

namespace dmise {
namespace {

// Reference: tests/reference/star_colours.py (astropy's Planck law, scipy's quadrature).
TEST(StarSpectrum, BlackBodyAgreesWithPlancksLaw) {
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
TEST(StarSpectrum, ColourTemperature) {
  EXPECT_NEAR(colour_temperature(0.65).kelvin, 5772, 10);
  EXPECT_FALSE(colour_temperature(0.65).clamped);
  EXPECT_NEAR(colour_temperature(0.0).kelvin, 10125, 1);
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
TEST(StarSpectrum, HasTheColoursOfTheStarsOfCatalogues) {
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

/// Greatest difference [mag] of a known spectrum's colours to V from those of stars of one B-V, in
/// UBRI and griz.
double worst_colour(const Spectrum& known, double bv) {
  const StarSpectrum star = star_spectrum(bv);
  const double at_v = photon_rate_per_m2(known, johnson_v()) / photon_rate(star, johnson_v());
  double worst = 0.0;
  for (const char* name : {"bessell-U", "bessell-B", "bessell-R", "bessell-I", "sdss-g", "sdss-r",
                           "sdss-i", "sdss-z"}) {
    const Band band = *filter_named(name);
    const double ratio = photon_rate_per_m2(known, band) / photon_rate(star, band);
    worst = std::max(worst, std::abs(magnitude_of_light(ratio / at_v)));
  }
  return worst;
}

// ASTM E490.
TEST(StarSpectrum, TheSunAmongStars) { EXPECT_LT(worst_colour(solar_spectrum(), 0.65), 0.06); }

// CALSPEC.
TEST(StarSpectrum, VegaAmongStars) { EXPECT_LT(worst_colour(vega_spectrum(), 0.0), 0.07); }

}  // namespace
}  // namespace dmise
