#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/extinction.h"
#include "core/sky/airglow.h"
#include "core/sky/faint_starlight.h"
#include "core/sky/light_pollution.h"
#include "core/sky/scattered_moonlight.h"
#include "core/sky/sky_model.h"
#include "core/sky/surface_brightness.h"
#include "core/sky/twilight.h"
#include "core/sky/zodiacal_light.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

// van Rhijn's factor of a layer at 90 km is 6.02 at the horizon; flat layers would give 2 at 30
// deg, this one 1.93.
TEST(Airglow, VanRhijn) {
  EXPECT_DOUBLE_EQ(van_rhijn(1.0, 90e3), 1.0);
  EXPECT_NEAR(van_rhijn(0.5, 90e3), 1.92, 0.01);
  EXPECT_NEAR(van_rhijn(0.0, 90e3), 6.02, 0.02);
  EXPECT_EQ(van_rhijn(-0.3, 90e3), van_rhijn(0.0, 90e3));
}

// Leinert et al. 1998, table 16 (S10): 60 at the ecliptic pole, 202 at 90 deg in the ecliptic, 180
// in the gegenschein, 1930 at 30 deg on the ecliptic, each to the table's rounding.
TEST(ZodiacalLight, LeinertsTable) {
  const struct {
    double longitude_deg, latitude_deg, s10;
  } table[] = {{0, 90, 60},   {137, 90, 60}, {90, 0, 202},  {-90, 0, 202}, {180, 0, 180},
               {540, 0, 180}, {30, 0, 1930}, {90, 30, 103}, {60, -60, 82}, {120, 15, 120}};
  for (const auto& [longitude_deg, latitude_deg, s10] : table)
    EXPECT_NEAR(zodiacal_light_s10(longitude_deg * deg, latitude_deg * deg), s10, 0.02 * s10)
        << longitude_deg << " " << latitude_deg;
}

// Leinert et al. 1998, table 17 as EXOSIMS keeps it (1e-8 W/m2/sr/um; 1e6 stands for no value): at
// all its nodes, to its own rounding.
TEST(ZodiacalLight, EveryValueOfLeinertsTable) {
  const std::string path = test::data_path("sky/Leinert98_table17.txt");
  DMISE_NEEDS_FILE(path);
  const double longitude[] = {0,  5,  10, 15,  20,  25,  30,  35,  40, 45,
                              60, 75, 90, 105, 120, 135, 150, 165, 180};
  const double latitude[] = {0, 5, 10, 15, 20, 25, 30, 45, 60, 75, 90};
  std::ifstream file(path);
  int compared = 0;
  for (const double l : longitude)
    for (const double b : latitude) {
      double value = 0;
      ASSERT_TRUE(file >> value);
      if (value > 9e5) continue;
      EXPECT_NEAR(zodiacal_light_s10(l * deg, b * deg) * 1.28, value, 1e-6 * value)
          << l << " " << b;
      ++compared;
    }
  EXPECT_EQ(compared, 201);
}

// Reference: scipy 1.10, PchipInterpolator through the logarithms of a row or a column of the
// table, which goes on beyond its ends as in a mirror.
TEST(ZodiacalLight, IsSmoothBetweenTheNodesOfTheTable) {
  const struct {
    double longitude_deg, latitude_deg, s10;
  } between[] = {{32.5, 0, 1569.742},  {52.5, 0, 515.929},   {97, 0, 182.5361},
                 {172, 0, 167.1046},   {32.5, 10, 818.8765}, {97, 10, 164.5099},
                 {52.5, 45, 115.8128}, {172, 45, 81.7861},   {30, 2, 1812.4062},
                 {30, 12.5, 787.8699}, {90, 37, 91.4559},    {150, 84, 58.7512}};
  for (const auto& [longitude_deg, latitude_deg, s10] : between)
    EXPECT_NEAR(zodiacal_light_s10(longitude_deg * deg, latitude_deg * deg), s10, 1e-6 * s10)
        << longitude_deg << " " << latitude_deg;
  constexpr double step = 1e-4;
  const auto log_at = [](double l, double b) {
    return std::log(zodiacal_light_s10(l * deg, b * deg));
  };
  for (double l = 0; l <= 180; l += 5)
    for (double b = 0; b <= 85; b += 2.5) {
      const double here = 2 * log_at(l, b);
      EXPECT_NEAR(log_at(l + step, b) + log_at(l - step, b), here, 1e-3 * step) << l << " " << b;
      EXPECT_NEAR(log_at(l, b + step) + log_at(l, b - step), here, 1e-3 * step) << l << " " << b;
    }
}

TEST(ZodiacalLight, ContinuousAndFiniteTowardsTheSun) {
  double last = zodiacal_light_s10(0, 0);
  EXPECT_TRUE(std::isfinite(last));
  for (double longitude = 0; longitude <= 360; longitude += 0.05) {
    const double here = zodiacal_light_s10(longitude * deg, 3 * deg);
    EXPECT_NEAR(here / zodiacal_light_s10((longitude - 0.05) * deg, 3 * deg), 1.0, 0.03);
  }
}

TEST(FaintStarlight, FallsWithLatitudeAndLimit) {
  EXPECT_NEAR(faint_starlight_s10({9.0}, 1.0), 20, 0.5);
  EXPECT_NEAR(faint_starlight_s10({9.0}, 0.0), 165, 1);
  // Counted in the catalogue: V = 6-9 gives 12.2 S10 at latitudes above 60 deg, 29.5 at 5 to 10
  // deg.
  EXPECT_NEAR(faint_starlight_s10({6.0}, std::sin(72 * deg)) -
                  faint_starlight_s10({9.0}, std::sin(72 * deg)),
              12.2, 0.8);
  EXPECT_NEAR(faint_starlight_s10({6.0}, std::sin(7.5 * deg)) -
                  faint_starlight_s10({9.0}, std::sin(7.5 * deg)),
              29.5, 4);
  EXPECT_LT(faint_starlight_s10({12.0}, 1.0), faint_starlight_s10({9.0}, 1.0));
}

// Reference: tests/reference/moonlight.py, and beyond 10 deg from the Moon the same magnitudes from
// specsim 1.0 (`krisciunas_schaefer`), whose documentation gives 19.855 for the fifth. {phase,
// angle from the Moon, zenith distance, the Moon's [deg], k, nL, mag}
TEST(ScatteredMoonlight, KrisciunasAndSchaefer) {
  const struct {
    double phase, angle, z, z_moon, k, nl, mag;
  } cases[] = {
      {0, 60, 0, 60, 0.172, 1089.86, 18.73774},  {30, 30, 45, 30, 0.172, 1549.26, 18.35586},
      {90, 100, 70, 80, 0.3, 119.273, 21.13979}, {0, 5, 40, 45, 0.172, 12718.2, 16.07012},
      {45, 50, 20, 70, 0.15, 0, 19.85484},       {135, 65, 60, 10, 0.2, 0, 22.78840},
      {18, 120, 75, 45, 0.12, 0, 18.45246},
  };
  for (const auto& c : cases) {
    const double s10 =
        scattered_moonlight_s10(c.angle * deg, std::cos(c.z * deg), std::cos(c.z_moon * deg),
                                moon_v_mag(c.phase * deg), {c.k});
    EXPECT_NEAR(mag_per_arcsec2_of_s10(s10), c.mag, 1e-4);
    if (c.nl > 0) {
      EXPECT_NEAR(s10 / s10_of_nanolambert(1.0), c.nl, 1e-4 * c.nl);
    }
  }
  EXPECT_NEAR(moon_v_mag(0), -12.73, 1e-12);
  EXPECT_NEAR(light_of_magnitude(opposition_surge_mag(0)), 1.35, 1e-12);
  EXPECT_EQ(opposition_surge_mag(7 * deg), 0.0);
}

// The whole Moon's colours, B-V 0.92 and V-R 0.85 (Johnson's R; 0.6 in Cousins') and U-B 0.46, by
// Allen's Astrophysical Quantities.
TEST(ScatteredMoonlight, AboveTheAirItHasTheColoursOfTheMoon) {
  const auto mag = [](const char* name) {
    const Band band = *filter_named(name);
    return magnitude_of_light(photon_rate_per_m2(moonlight_spectrum(), band) /
                              zero_point_photons_per_s_m2(band));
  };
  EXPECT_NEAR(mag("bessell-B") - mag("bessell-V"), 0.92, 0.06);
  EXPECT_NEAR(mag("bessell-U") - mag("bessell-B"), 0.46, 0.1);
}

// ESO's sky calculator, with the full Moon at an altitude of 45 deg, towards the zenith of Paranal:
// V 18.04, B-V 0.17, V-R -0.02, V-I -0.14.
TEST(ScatteredMoonlight, IsBluerThanTheSun) {
  const SkyScene scene{.moon = {std::sqrt(0.5), 0, std::sqrt(0.5)}, .moon_phase_rad = 0.0};
  SkyParts parts;
  parts.scattered_moonlight = ScatteredMoonlight{};
  const auto mag = [&](const char* name) {
    const Band band = *filter_named(name);
    const SkyModel sky(parts, scene, band, *extinction_of_site("paranal"));
    return magnitude_of_light(sky.photons_per_s_m2_sr({0, 0, 1}) * arcsec * arcsec /
                              zero_point_photons_per_s_m2(band));
  };
  const double v = mag("bessell-V");
  EXPECT_NEAR(v, 18.04, 0.3);
  EXPECT_NEAR(mag("bessell-B") - v, 0.17, 0.15);
  EXPECT_NEAR(v - mag("bessell-R"), -0.02, 0.15);
  EXPECT_NEAR(v - mag("bessell-I"), -0.14, 0.15);
}

TEST(ScatteredMoonlight, ContinuousThroughMoonriseAndTowardsTheMoon) {
  double last = 0;
  for (double altitude = -10; altitude <= 90; altitude += 0.02) {
    const double here = scattered_moonlight_s10(1.0, 0.7, std::sin(altitude * deg), -12.7, {0.17});
    EXPECT_GT(here, last);
    if (last > 0) {
      EXPECT_LT(here / last, 1.03);
    }
    last = here;
  }
  last = moonlight_scattering(0);
  for (double angle = 0; angle <= 180; angle += 0.001) {
    const double here = moonlight_scattering(angle * deg);
    EXPECT_NEAR(here / last, 1.0, 0.01) << angle;
    last = here;
  }
}

// Patat et al. 2006, table 1, V: 11.84 + 1.518 x - 0.057 x^2, with the dark sky in it.
TEST(Twilight, ZenithByPatat) {
  const double dark = s10_of_mag_per_arcsec2(21.7);
  EXPECT_NEAR(mag_per_arcsec2_of_s10(twilight_zenith_s10(-5 * deg) + dark), 11.84, 0.005);
  EXPECT_NEAR(mag_per_arcsec2_of_s10(twilight_zenith_s10(-10 * deg) + dark), 18.005, 0.005);
  EXPECT_NEAR(mag_per_arcsec2_of_s10(twilight_zenith_s10(-14 * deg) + dark), 20.885, 0.005);
  EXPECT_LT(twilight_zenith_s10(-18 * deg), 10);
}

TEST(Twilight, DawnIsContinuousAndMonotone) {
  double last = twilight_zenith_s10(-40 * deg);
  EXPECT_GE(last, 0.0);
  for (double altitude = -40; altitude <= 20; altitude += 0.01) {
    const double here = twilight_zenith_s10(altitude * deg);
    EXPECT_GE(here, last) << altitude;
    if (last > 0) {
      EXPECT_LT(here / last, 1.2) << altitude;
    }
    last = here;
  }
}

Vec<Enu> north_at(double azimuth_deg, double altitude_deg) {
  return from_spherical<Enu>((90 - azimuth_deg) * deg, altitude_deg * deg);
}

// tests/reference/twilight_light.py, all orders of scattering in spherical air.
TEST(TwilightPattern, IsThatOfScatteringInSphericalAir) {
  const struct {
    double depression_deg, over_zenith[5];  // 30 deg up, every 45 deg from the Sun's azimuth
  } rows[] = {{3, {3.47, 2.65, 1.74, 1.78, 1.95}},  {6, {5.44, 3.74, 1.80, 1.25, 1.18}},
              {9, {6.13, 4.14, 2.10, 1.88, 2.12}},  {12, {4.31, 3.30, 1.99, 1.94, 2.22}},
              {15, {4.03, 3.07, 1.89, 1.82, 2.02}}, {18, {4.26, 3.15, 1.85, 1.64, 1.73}}};
  for (const auto& [depression_deg, over_zenith] : rows) {
    const TwilightPattern pattern(north_at(80, -depression_deg));
    EXPECT_NEAR(pattern.over_zenith({0, 0, 1}), 1.0, 1e-12);
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(pattern.over_zenith(north_at(80 + 45 * i, 30)), over_zenith[i],
                  0.08 * over_zenith[i])
          << depression_deg << " " << 45 * i;
  }
}

TEST(TwilightPattern, IsContinuousAndFinite) {
  for (const double sun_deg : {89.0, 10.0, 0.0, -0.5, -7.5, -18.0, -18.1, -89.0}) {
    const TwilightPattern pattern(north_at(80, sun_deg)), later(north_at(80, sun_deg - 0.02));
    for (const double azimuth : {0.0, 80.0, 170.0, 261.0}) {
      double last = pattern.over_zenith(north_at(azimuth, -90));
      for (double altitude = -90; altitude <= 270; altitude += 0.1) {
        const double here = pattern.over_zenith(north_at(azimuth, altitude));
        ASSERT_TRUE(std::isfinite(here) && here > 0.0) << sun_deg << " " << altitude;
        EXPECT_NEAR(here / last, 1.0, 0.15) << sun_deg << " " << azimuth << " " << altitude;
        if (altitude >= 0.0 && altitude <= 180.0) {
          EXPECT_NEAR(later.over_zenith(north_at(azimuth, altitude)) / here, 1.0, 0.05)
              << sun_deg << " " << azimuth << " " << altitude;
        }
        last = here;
      }
    }
  }
}

// Patat et al. 2006: twilight 5 deg down has B-V 0.00, V-R 0.44, V-I 0.91.
TEST(Twilight, Colours) {
  const auto mag = [](const char* name) {
    const Band band = *filter_named(name);
    return magnitude_of_light(photons_per_s_m2_sr_of_s10(band, twilight_spectrum(-5 * deg)) /
                              zero_point_photons_per_s_m2(band));
  };
  EXPECT_NEAR(mag("bessell-B") - mag("bessell-V"), 0.00, 0.02);
  EXPECT_NEAR(mag("bessell-V") - mag("bessell-R"), 0.44, 0.02);
  EXPECT_NEAR(mag("bessell-V") - mag("bessell-I"), 0.91, 0.02);
}

// Photons in Bessell's B and R over V of three lamps measured for the Lamp Spectral Power
// Distribution Database.
TEST(LightPollution, LampsHaveTheColoursOfMeasuredOnes) {
  const struct {
    LampMix lamp;
    double b_over_v, r_over_v;
  } cases[] = {{{1, 0, 0}, 0.0, 2.331}, {{0, 1, 0}, 0.0985, 2.249}, {{0, 0, 1}, 0.3608, 1.356}};
  for (const auto& [lamp, b_over_v, r_over_v] : cases) {
    const Spectrum spectrum = lamp_spectrum(lamp);
    const double v = photon_rate_per_m2(spectrum, johnson_v());
    EXPECT_NEAR(photon_rate_per_m2(spectrum, *filter_named("bessell-B")) / v, b_over_v,
                0.1 * b_over_v + 1e-6);
    EXPECT_NEAR(photon_rate_per_m2(spectrum, *filter_named("bessell-R")) / v, r_over_v,
                0.1 * r_over_v);
  }
  EXPECT_THROW(lamp_spectrum({0, 0, 0}), Error);
  EXPECT_THROW(lamp_spectrum({1, -1, 0}), Error);
}

// Colours of the lamps, from the measured spectra themselves.
TEST(LightPollution, LampsAgreeWithTheMeasuredSpectra) {
  const struct {
    LampMix lamp;
    const char* file;
  } cases[] = {{{1, 0, 0}, "LPS_Dline.spct"},
               {{0, 1, 0}, "HPS_Helios.spct"},
               {{0, 0, 1}, "4LED_LED-4000K-Philips.spct"}};
  for (const auto& [lamp, name] : cases) {
    const std::string path = test::data_path(std::string("sky/lamps/") + name);
    DMISE_NEEDS_FILE(path);
    std::ifstream file(path);
    std::string header;
    std::getline(file, header);
    Spectrum measured;
    for (double at_nm, value; file >> at_nm >> value;) {
      measured.irradiance.wavelength_m.push_back(at_nm * nm);
      measured.irradiance.value.push_back(value);
    }
    // It ends before the red tail of R, where these lamps have next to nothing.
    measured.irradiance.wavelength_m.push_back(1000 * nm);
    measured.irradiance.value.push_back(0.0);
    for (const char* band : {"bessell-B", "bessell-R"}) {
      const auto over_v = [&](const Spectrum& s) {
        return photon_rate_per_m2(s, *filter_named(band)) / photon_rate_per_m2(s, johnson_v());
      };
      EXPECT_NEAR(over_v(lamp_spectrum(lamp)), over_v(measured), 0.1 * over_v(measured) + 1e-4)
          << name << " " << band;
    }
  }
}

TEST(LightPollution, ACityGlowsOnItsSideAndHasNoSeam) {
  LightPollution site{.zenith_v_mag_per_arcsec2 = 21.0, .cities = {{.azimuth_rad = pi / 2}}};
  const auto towards = [&](double azimuth_deg, double altitude_deg) {
    return light_pollution_s10(
        site, from_spherical<Enu>((90 - azimuth_deg) * deg, altitude_deg * deg), 0.17);
  };
  EXPECT_NEAR(mag_per_arcsec2_of_s10(towards(0, 90)), 21.0, 0.02);
  EXPECT_GT(towards(90, 5), 1.5 * towards(270, 5));
  for (double altitude = -5; altitude <= 90; altitude += 5) {
    EXPECT_NEAR(towards(270.001, altitude) / towards(269.999, altitude), 1.0, 1e-3);
    EXPECT_NEAR(towards(359.999, altitude) / towards(0.001, altitude), 1.0, 1e-3);
  }
}

}  // namespace
}  // namespace dmise
