#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/bodies/limb_airglow.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

constexpr double radius_m = 6371e3;
const OblateEarth sphere{.ellipsoid = {radius_m, 0.0}};

Band between(double low_nm, double high_nm) {
  return {"band", 0.5 * (low_nm + high_nm) * nm, (high_nm - low_nm) * nm, {}};
}
const Band of_oh = between(800, 850), of_oxygen = between(540, 570);

LimbLine line_from(double height_m, double nadir_rad) {
  const LimbSight sight({radius_m + height_m, 0, 0}, sphere);
  return sight.line({-std::cos(nadir_rad), std::sin(nadir_rad), 0});
}
/// A line of a tangent height, seen from outside.
LimbLine tangent_line(double from_m, double height_m) {
  return line_from(from_m, std::asin((radius_m + height_m) / (radius_m + from_m)));
}

struct Row {
  double from_m, nadir_rad, middle_m, half_width_m, light;
};
constexpr Row rows[] = {
#include "tests/sky/limb_airglow_reference.inc"
};

// Reference: scipy's quad along every line (tests/reference/limb_light.py airglow): observers on
// the ground, in the layers, above them and in a geostationary orbit; lines to the zenith, over the
// limb and to the ground.
TEST(LimbAirglow, LinesThroughShellsAreThoseOfScipy) {
  double worst = 0.0;
  for (const Row& row : rows) {
    const AirglowShells shells({}, row.middle_m < 90e3 ? of_oh : of_oxygen);
    const auto& shell = shells.shells()[row.middle_m < 90e3 ? 0 : 1];
    ASSERT_NEAR(shell.middle_m, row.middle_m, 1.0);
    ASSERT_NEAR(shell.half_width_m, row.half_width_m, 10.0);
    const double light = shells.photons_per_s_m2_sr(line_from(row.from_m, row.nadir_rad)) /
                         shells.zenith_photons_per_s_m2_sr();
    EXPECT_NEAR(light, row.light, 3e-3 * row.light + 2e-3) << row.from_m << " " << row.nadir_rad;
    if (row.light > 0.1) worst = std::max(worst, std::abs(light / row.light - 1.0));
  }
  RecordProperty("worst", std::to_string(worst));
}

// Reference: van Rhijn's formula for a thin layer, which a shell of 8.6 km is to 0.1 %.
TEST(LimbAirglow, FromTheGroundItIsVanRhijns) {
  for (const Band& band : {of_oh, of_oxygen}) {
    const AirglowShells shells({}, band);
    const double middle_m = band == of_oh ? 87e3 : 95e3;
    for (const double altitude_deg : {90.0, 60.0, 30.0, 15.0, 5.0, 0.0}) {
      const LimbLine line = line_from(0.0, pi / 2 + altitude_deg * deg);
      const double over_zenith =
          shells.photons_per_s_m2_sr(line) / shells.zenith_photons_per_s_m2_sr();
      EXPECT_NEAR(over_zenith / van_rhijn(std::sin(altitude_deg * deg), middle_m), 1.0, 2e-3)
          << altitude_deg;
    }
  }
}

// What the sky's own part has at a site, above the air.
TEST(LimbAirglow, FromTheGroundItIsAsBrightAsTheSkysPart) {
  for (const char* filter : {"bessell-U", "bessell-B", "bessell-V", "bessell-R", "bessell-I"})
    for (const std::optional<double> sfu : {std::optional<double>{}, std::optional{200.0}}) {
      const Band band = *filter_named(filter);
      Airglow airglow;
      airglow.solar_flux_sfu = sfu;
      const AirglowShells shells(airglow, band);
      const double per_s10 =
          photons_per_s_m2_sr_of_s10(band, airglow_spectrum(airglow_by_solar_flux(sfu)));
      for (const double altitude_deg : {90.0, 30.0, 15.0, 0.0}) {
        const double here = shells.photons_per_s_m2_sr(line_from(0.0, pi / 2 + altitude_deg * deg));
        const double there = per_s10 * airglow_s10(airglow, std::sin(altitude_deg * deg), 0.0);
        // The sky has one layer for all light.
        EXPECT_NEAR(here / there, 1.0, altitude_deg < 10 ? 0.03 : 0.01) << filter << altitude_deg;
      }
      EXPECT_NEAR(shells.zenith_photons_per_s_m2_sr() / (per_s10 * airglow_s10(airglow, 1.0, 0.0)),
                  1.0, 1e-6);
    }
}

// The green line of oxygen over its continuum, towards the zenith: 150 to 250 R, about 100 R in
// years of a quiet Sun (Chamberlain 1961, Physics of the Aurora and Airglow;
// Roach & Gordon 1973, The Light of the Night Sky). A layer of 8.6 km seen at its side is fifty to
// seventy times as bright: 61 for a Gaussian of that width.
TEST(LimbAirglow, TheGreenLineHasThePublishedRayleighs) {
  const double rayleigh = 1e10 / (4 * pi);  // photons/s/m2/sr
  const auto line_r = [&](std::optional<double> sfu) {
    const auto light = [&](double low_nm, double high_nm) {
      Airglow airglow;
      airglow.solar_flux_sfu = sfu;
      return AirglowShells(airglow, between(low_nm, high_nm)).zenith_photons_per_s_m2_sr();
    };
    // From 540 to 575 nm, over the continuum beside it.
    return (light(540, 575) - 35.0 / 20.0 * light(520, 540)) / rayleigh;
  };
  EXPECT_NEAR(line_r(70.0), 100.0, 20.0);
  EXPECT_GT(line_r({}), 125.0);
  EXPECT_LT(line_r(220.0), 250.0);
  RecordProperty("zenith_r", std::to_string(line_r({})));
  const AirglowShells shells({}, of_oxygen);
  double most = 0.0, at_m = 0.0;
  for (double height_m = 60e3; height_m < 110e3; height_m += 100.0) {
    const double here = shells.photons_per_s_m2_sr(tangent_line(400e3, height_m));
    if (here > most) most = here, at_m = height_m;
  }
  RecordProperty("limb_over_zenith", std::to_string(most / shells.zenith_photons_per_s_m2_sr()));
  EXPECT_NEAR(most / shells.zenith_photons_per_s_m2_sr(), 60.0, 10.0);
  EXPECT_NEAR(at_m, 92e3, 2e3);  // below the middle, where the line stays long in the layer
}

TEST(LimbAirglow, BelowTheGroundTheNearCrossingAloneCounts) {
  const AirglowShells shells({}, of_oxygen);
  const double above = shells.photons_per_s_m2_sr(tangent_line(400e3, 1.0));
  const double below = shells.photons_per_s_m2_sr(tangent_line(400e3, -1.0));
  EXPECT_NEAR(below / above, 0.5, 1e-3);
  // Towards the nadir it is as bright as towards the zenith from below.
  EXPECT_NEAR(
      shells.photons_per_s_m2_sr(line_from(400e3, 0.0)) / shells.zenith_photons_per_s_m2_sr(), 1.0,
      1e-6);
  // Air at the limb takes of the far crossing alone.
  EXPECT_NEAR(shells.photons_per_s_m2_sr(tangent_line(400e3, 1.0), 0.0) / above, 0.5, 1e-3);
}

// Observers on the ground, in and above the layers, at all angles: finite, and without a step.
TEST(LimbAirglow, IsFiniteAndContinuousFromEverywhere) {
  const AirglowShells shells({}, johnson_v());
  const double zenith = shells.zenith_photons_per_s_m2_sr();
  for (const double from_m :
       {0.0, 50e3, 79e3, 87e3, 90e3, 95e3, 103.1e3, 110e3, 200e3, 400e3, 35786e3, 4e8, 1.5e11})
    for (int i = 0; i <= 1800; ++i) {
      const double here = shells.photons_per_s_m2_sr(line_from(from_m, i * pi / 1800));
      ASSERT_TRUE(std::isfinite(here) && here >= 0.0 && here < 130.0 * zenith)
          << from_m << " " << i;
    }
  double before = -1.0;
  for (double from_m = 60e3; from_m < 120e3; from_m += 50.0) {
    const double here = shells.photons_per_s_m2_sr(line_from(from_m, pi / 2));
    if (before >= 0.0) {
      EXPECT_NEAR(here, before, 1.5 * zenith) << from_m;
    }
    before = here;
  }
  EXPECT_EQ(shells.photons_per_s_m2_sr(line_from(120e3, pi / 2)), 0.0);
  EXPECT_EQ(shells.photons_per_s_m2_sr(line_from(400e3, pi)), 0.0);  // looks up
}

// The spectrum ends at 2.5 um and begins at 0.2 um; beyond it nothing is known, and nothing shines.
TEST(LimbAirglow, HasNoLightWhereItsSpectrumIsNotKnown) {
  for (const Band& band : {between(8000, 12000), between(3000, 5000), between(100, 190)})
    EXPECT_NEAR(AirglowShells({}, band).zenith_photons_per_s_m2_sr(), 0.0, 1.0) << band.centre_m;
  const double known = AirglowShells({}, between(2000, 2500)).zenith_photons_per_s_m2_sr();
  EXPECT_NEAR(AirglowShells({}, between(2000, 4000)).zenith_photons_per_s_m2_sr() / known, 1.0,
              1e-3);
}

}  // namespace
}  // namespace dmise
