#include "core/photometry/star_spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

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
  EXPECT_NEAR(colour_temperature_k(0.65), 5772, 10);
  EXPECT_NEAR(colour_temperature_k(0.0), 10125, 1);
}

double magnitude(const char* filter, const StarColour& colour) {
  const Band band = *filter_named(filter);
  return magnitude_of_light(StarLight(band).photons_per_s_m2(0, colour) /
                            zero_point_photons_per_s_m2(band));
}

// Medians of stars about a B-V, by tests/reference/star_spectra.py --check. U-B: the Yale Bright
// Star Catalogue, all classes (of 49 to 461 stars each); V-R and V-I: Landolt's standards, 1992, AJ
// 104, 340 (14 to 72 each; some reddened by dust, which moves V-I by 0.05 at a given B-V). Many
// stars of the Yale catalogue that are bluer than 0 are reddened or no dwarfs.
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

// Spectra of Pickles 1998, PASP 110, 863, through synphot (tests/reference/pickles_colours.py):
// stars of B-V as these have it.
struct PicklesStar {
  const char* type;
  double bv, ub, vr, vi;
};

TEST(StarSpectrum, HasTheColoursOfPicklesStars) {
  const PicklesStar stars[] = {
      {"B8V", -0.110, -0.286, -0.012, -0.025}, {"B9V", -0.045, -0.206, 0.005, -0.006},
      {"A0V", 0.014, -0.020, 0.009, 0.039},    {"A2V", 0.028, 0.032, 0.027, 0.080},
      {"A3V", 0.089, 0.019, 0.058, 0.131},     {"A5V", 0.153, 0.049, 0.075, 0.190},
      {"A7V", 0.202, 0.051, 0.131, 0.275},     {"F0V", 0.303, -0.002, 0.197, 0.408},
      {"F2V", 0.396, -0.056, 0.234, 0.497},    {"F5V", 0.458, -0.091, 0.263, 0.535},
      {"F6V", 0.470, -0.050, 0.293, 0.601},    {"F8V", 0.544, 0.007, 0.325, 0.657},
      {"G0V", 0.573, 0.070, 0.344, 0.712},     {"G2V", 0.637, 0.124, 0.377, 0.761},
      {"G5V", 0.690, 0.221, 0.386, 0.780},     {"G8V", 0.756, 0.308, 0.438, 0.857},
      {"K0V", 0.776, 0.377, 0.474, 0.911},     {"K2V", 0.930, 0.594, 0.543, 1.016},
      {"A0III", 0.036, -0.040, 0.021, 0.038},  {"A3III", 0.129, 0.080, 0.066, 0.107},
      {"A5III", 0.174, 0.071, 0.094, 0.200},   {"A7III", 0.210, 0.104, 0.138, 0.275},
      {"F0III", 0.271, 0.086, 0.163, 0.359},   {"F2III", 0.418, -0.005, 0.253, 0.484},
      {"F5III", 0.426, 0.023, 0.274, 0.542},   {"G0III", 0.665, 0.221, 0.392, 0.772},
      {"G5III", 0.891, 0.503, 0.474, 0.921},   {"G8III", 0.952, 0.638, 0.504, 0.978},
      {"K0III", 0.963, 0.795, 0.527, 1.027},   {"K1III", 1.043, 0.902, 0.569, 1.098},
      {"K2III", 1.113, 1.011, 0.612, 1.189},   {"K3III", 1.218, 1.199, 0.647, 1.226}};
  double sum_vr = 0.0, sum_vi = 0.0;
  for (const auto& s : stars) {
    const double v = magnitude("bessell-V", s.bv);
    EXPECT_NEAR(magnitude("bessell-B", s.bv) - v, s.bv, 0.005) << s.type;
    EXPECT_NEAR(magnitude("bessell-U", s.bv) - v, s.bv + s.ub, 0.095) << s.type;
    EXPECT_NEAR(v - magnitude("bessell-R", s.bv), s.vr, 0.05) << s.type;
    EXPECT_NEAR(v - magnitude("bessell-I", s.bv), s.vi, 0.09) << s.type;
    sum_vr += v - magnitude("bessell-R", s.bv) - s.vr;
    sum_vi += v - magnitude("bessell-I", s.bv) - s.vi;
  }
  EXPECT_NEAR(sum_vr / double(std::size(stars)), 0.0, 0.02);
  EXPECT_NEAR(sum_vi / double(std::size(stars)), 0.0, 0.045);
}

void expect_vri(const PicklesStar& star, StarKind kind, double max_ri_mag) {
  const StarColour colour{star.bv, kind};
  const double v = magnitude("bessell-V", colour);
  EXPECT_NEAR(v - magnitude("bessell-R", colour), star.vr, 0.15) << star.type;
  EXPECT_NEAR(v - magnitude("bessell-I", colour), star.vi, max_ri_mag) << star.type;
}

// In B and U these spectra have other colours than stars of the catalogues: B-V = 1.44 at M0 III,
// where 72 giants of the Yale catalogue have 1.58.
TEST(StarSpectrum, StarsOfTypeMHaveTheColoursOfPicklesStars) {
  const PicklesStar giants[] = {
      {"M0III", 1.441, 1.577, 0.837, 1.723}, {"M1III", 1.445, 1.567, 0.865, 1.835},
      {"M2III", 1.464, 1.587, 0.913, 1.946}, {"M3III", 1.440, 1.523, 0.958, 2.176},
      {"M4III", 1.401, 1.408, 1.054, 2.508}, {"M5III", 1.297, 1.112, 1.196, 2.914},
      {"M6III", 1.233, 0.873, 1.426, 3.395}, {"M7III", 1.090, 0.364, 1.773, 4.030}};
  for (const auto& star : giants) expect_vri(star, m_giant(star.type[1] - '0'), 0.15);
  const PicklesStar dwarfs[] = {
      {"M0V", 1.332, 1.158, 0.894, 1.780}, {"M1V", 1.386, 1.185, 0.919, 1.950},
      {"M2V", 1.447, 1.047, 0.999, 2.104}, {"M3V", 1.525, 1.056, 1.132, 2.535},
      {"M4V", 1.603, 1.411, 1.290, 2.887}, {"M5V", 1.673, 1.334, 1.453, 3.270}};
  for (const auto& star : dwarfs) expect_vri(star, m_dwarf(star.type[1] - '0'), 0.15);
}

TEST(StarSpectrum, RedDwarfsHaveTheColoursOfPicklesDwarfs) {
  const PicklesStar dwarfs[] = {{"K3V", 0.937, 0.752, 0.620, 1.158},
                                {"K4V", 1.093, 0.814, 0.687, 1.284},
                                {"K5V", 1.216, 1.089, 0.773, 1.412},
                                {"K7V", 1.380, 1.061, 0.855, 1.640}};
  for (const auto& star : dwarfs) expect_vri(star, StarKind::red_dwarf, 0.18);
}

constexpr std::array johnson_cousins{"bessell-U", "bessell-B", "bessell-R", "bessell-I"};
constexpr std::array sloan{"sdss-g", "sdss-r", "sdss-i", "sdss-z"};

/// Greatest difference [mag] of a known spectrum's colours to V from those of stars of one B-V.
double worst_colour(const Spectrum& known, double bv, std::span<const char* const> filters) {
  const StarSpectrum star = star_spectrum(bv);
  const double at_v = photon_rate_per_m2(known, johnson_v()) / photon_rate(star, johnson_v());
  double worst = 0.0;
  for (const char* name : filters) {
    const Band band = *filter_named(name);
    const double ratio = photon_rate_per_m2(known, band) / photon_rate(star, band);
    worst = std::max(worst, std::abs(magnitude_of_light(ratio / at_v)));
  }
  return worst;
}

// ASTM E490.
TEST(StarSpectrum, TheSunAmongStars) {
  EXPECT_LT(worst_colour(solar_spectrum(), 0.65, johnson_cousins), 0.02);
  EXPECT_LT(worst_colour(solar_spectrum(), 0.65, sloan), 0.02);
}

// CALSPEC.
TEST(StarSpectrum, VegaAmongStars) {
  EXPECT_LT(worst_colour(vega_spectrum(), 0.0, johnson_cousins), 0.01);
  EXPECT_LT(worst_colour(vega_spectrum(), 0.0, sloan), 0.065);
}

}  // namespace
}  // namespace dmise
