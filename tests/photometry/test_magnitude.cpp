#include "core/photometry/magnitude.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

// CALSPEC's Vega through Bessell's curves divided by wavelength, both at full resolution, Vega V =
// 0.03 and U = 0.024: tests/reference/star_spectra.py --check.
TEST(Magnitude, PhotonRatesOfMagnitudeZero) {
  const struct {
    const char* band;
    double photons_per_s_m2;
  } expected[] = {{"bessell-U", 4.813e9},
                  {"bessell-B", 1.289e10},
                  {"bessell-V", 8.748e9},
                  {"bessell-R", 1.059e10},
                  {"bessell-I", 6.781e9}};
  for (const auto& [band, rate] : expected)
    EXPECT_NEAR(zero_point_photons_per_s_m2(*filter_named(band)), rate, 0.005 * rate) << band;
}

// Bessell, Castelli & Plez 1998, A&A 333, 231, table A2: the flux of magnitude 0, 1790, 4063, 3636,
// 3064 and 2416 Jy in UBVRI, from another model of Vega and averaged over energy.
TEST(Magnitude, FluxOfMagnitudeZero) {
  const struct {
    const char* band;
    double jansky;
  } expected[] = {{"bessell-U", 1790},
                  {"bessell-B", 4063},
                  {"bessell-V", 3636},
                  {"bessell-R", 3064},
                  {"bessell-I", 2416}};
  for (const auto& [name, jansky] : expected) {
    const Band band = *filter_named(name);
    EXPECT_NEAR(3631 * zero_point_photons_per_s_m2(band) / ab_zero_point_photons_per_s_m2(band),
                jansky, 0.03 * jansky)
        << name;
  }
}

// Willmer 2018, ApJS 236, 47: the Sun's Vega magnitudes B -26.13, V -26.76, R -27.15, I -27.47
// (their V is -26.76 by definition, the others by other spectra of the Sun: 0.05 mag).
TEST(Magnitude, TheSun) {
  const auto sun_magnitude = [](const char* filter) {
    const Band band = *filter_named(filter);
    return magnitude_of_light(photon_rate_per_m2(solar_spectrum(), band) /
                              zero_point_photons_per_s_m2(band));
  };
  EXPECT_NEAR(sun_magnitude("bessell-V"), -26.76, 0.02);
  EXPECT_NEAR(sun_magnitude("bessell-B"), -26.13, 0.05);
  EXPECT_NEAR(sun_magnitude("bessell-R"), -27.15, 0.05);
  EXPECT_NEAR(sun_magnitude("bessell-I"), -27.47, 0.05);
}

// Blanton & Roweis 2007, AJ 133, 734, table 1: AB - Vega is 0.79, -0.09, 0.02, 0.21, 0.45 in UBVRI.
TEST(Magnitude, AbAgainstVega) {
  const double expected[] = {0.79, -0.09, 0.02, 0.21, 0.45};
  const char* names[] = {"bessell-U", "bessell-B", "bessell-V", "bessell-R", "bessell-I"};
  for (int i = 0; i < 5; ++i) {
    const Band band = *filter_named(names[i]);
    EXPECT_NEAR(magnitude_of_light(zero_point_photons_per_s_m2(band) /
                                   ab_zero_point_photons_per_s_m2(band)),
                expected[i], 0.05)
        << names[i];
  }
}

// Willmer 2018, ApJS 236, 47, table 3: the Sun's absolute magnitudes in BVRI,
// Vega 5.44, 4.81, 4.43, 4.10 and AB 5.31, 4.80, 4.60, 4.51, less its V of 4.81; 0.05 mag as above.
TEST(Magnitude, TheSunsColourInEachSystem) {
  const struct {
    const char* band;
    double vega, ab;
  } expected[] = {{"bessell-B", 0.63, 0.50},
                  {"bessell-V", 0.00, -0.01},
                  {"bessell-R", -0.38, -0.21},
                  {"bessell-I", -0.71, -0.30}};
  for (const auto& [name, vega, ab] : expected) {
    const Band band = *filter_named(name);
    EXPECT_NEAR(magnitude_scale(MagnitudeSystem::vega, band).solar_colour_mag, vega, 0.05) << name;
    EXPECT_NEAR(magnitude_scale(MagnitudeSystem::ab, band).solar_colour_mag, ab, 0.05) << name;
    EXPECT_EQ(magnitude_scale(MagnitudeSystem::v_solar, band), MagnitudeScale());
  }
}

TEST(Magnitude, VegaEndsWhereItsSpectrumDoes) {
  Band band;
  band.name = "L";
  band.centre_m = 3.5 * um;
  band.width_m = 0.5 * um;
  EXPECT_THROW(magnitude_scale(MagnitudeSystem::vega, band), Error);
  EXPECT_TRUE(std::isfinite(magnitude_scale(MagnitudeSystem::ab, band).solar_colour_mag));
}

// ASTM E490-00a: the solar constant is 1366.1 W/m2, of which 0.2 to 5 um hold all but about 0.5 %.
TEST(Magnitude, SolarConstantIsKeptByTheShortTable) {
  const Curve& sun = solar_spectrum().irradiance;
  double sum = 0.0;
  for (std::size_t i = 1; i < sun.value.size(); ++i)
    sum += (sun.wavelength_m[i] - sun.wavelength_m[i - 1]) * (sun.value[i] + sun.value[i - 1]) / 2;
  EXPECT_NEAR(sum, 1366.1 * 0.995, 1366.1 * 0.004);
}

TEST(Magnitude, SunlightGoesOnBeyondTheSolarTable) {
  const Curve& sun = sunlight_spectrum().irradiance;
  const auto of_sun = [](double wavelength_m) {  // a black body of 5050 K as large as the Sun
    const double x =
        planck_j_s * speed_of_light_m_per_s / (wavelength_m * boltzmann_j_per_k * 5050.0);
    const double radius_au = 6.957e8 / au_m;
    return 2 * pi * radius_au * radius_au * planck_j_s * speed_of_light_m_per_s *
           speed_of_light_m_per_s / std::pow(wavelength_m, 5) / std::expm1(x);
  };
  for (const double wavelength_m : {10 * um, 20 * um})
    EXPECT_NEAR(sun.at_or_zero(wavelength_m) / of_sun(wavelength_m), 1.0, 0.13);
  EXPECT_EQ(sun.at_or_zero(2 * um), solar_spectrum().irradiance.at_or_zero(2 * um));
  EXPECT_GT(sunlight_photons_per_s_m2(0.0, {.name = "N", .centre_m = 10 * um, .width_m = 4 * um}),
            0.0);
}

TEST(Magnitude, SunlightOfAMagnitudeHasItInV) {
  EXPECT_NEAR(sunlight_photons_per_s_m2(5.0, johnson_v()),
              0.01 * zero_point_photons_per_s_m2(johnson_v()), 1e-3);
}

TEST(Magnitude, BandsBeyondTheSpectrumAreRefused) {
  EXPECT_THROW(zero_point_photons_per_s_m2({"L", 3.5 * um, 0.5 * um, {}}), Error);
}

}  // namespace
}  // namespace dmise
