#include "core/sky/sky_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/extinction.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

Vec<Enu> towards(double azimuth_deg, double altitude_deg) {
  return from_spherical<Enu>((90 - azimuth_deg) * deg, altitude_deg * deg);
}

/// A moonless night with the north galactic pole in the zenith and the Sun 40 deg down.
SkyScene night() {
  SkyScene scene;
  scene.sun = towards(0, -40);
  const double ra = 192.86 * deg, dec = 27.13 * deg;
  const Vec<Gcrs> up = from_spherical<Gcrs>(ra, dec);
  const Vec<Gcrs> east{-std::sin(ra), std::cos(ra), 0};
  const Vec<Gcrs> north = cross(up, east);
  scene.gcrs_from_enu.m = {
      {{east.x, north.x, up.x}, {east.y, north.y, up.y}, {east.z, north.z, up.z}}};
  return scene;
}

SkyModel model(const char* preset, const SkyScene& scene, const Band& band = johnson_v()) {
  return SkyModel(*sky_parts_named(preset), scene, band, *extinction_of_site("lick"));
}

TEST(SkyModel, PresetsHaveTheirBrightnessAtTheZenith) {
  const Vec<Enu> zenith{0, 0, 1};
  EXPECT_NEAR(model("dark", night()).v_mag_per_arcsec2(zenith), 21.9, 0.2);
  EXPECT_NEAR(model("suburban", night()).v_mag_per_arcsec2(zenith), 20.0, 0.05);
  EXPECT_NEAR(model("urban", night()).v_mag_per_arcsec2(zenith), 18.0, 0.02);
  SkyScene space = night();
  space.in_air = false;
  EXPECT_NEAR(model("space", space).v_mag_per_arcsec2(towards(10, -70)), 21.0, 1e-9);
  EXPECT_FALSE(sky_parts_named("party"));
}

TEST(SkyModel, EachPartHasItsOwnSwitch) {
  const Curve extinction = *extinction_of_site("lick");
  SkyScene scene = night();
  scene.moon = towards(120, 30);
  scene.moon_phase_rad = 0.5;
  scene.sun = towards(280, -12);
  const SkyParts all = *sky_parts_named("urban");
  const Vec<Enu> at = towards(100, 50);
  const auto whole = SkyModel(all, scene, johnson_v(), extinction).parts_s10(at);
  const auto only = [&](auto member) {
    SkyParts one;
    one.*member = all.*member;
    return SkyModel(one, scene, johnson_v(), extinction).parts_s10(at);
  };
  EXPECT_EQ(only(&SkyParts::airglow)[1], whole[1]);
  EXPECT_EQ(only(&SkyParts::zodiacal_light)[2], whole[2]);
  EXPECT_EQ(only(&SkyParts::faint_starlight)[3], whole[3]);
  EXPECT_EQ(only(&SkyParts::scattered_moonlight)[4], whole[4]);
  EXPECT_EQ(only(&SkyParts::twilight)[5], whole[5]);
  EXPECT_EQ(only(&SkyParts::light_pollution)[6], whole[6]);
  for (int i = 1; i < 7; ++i) EXPECT_GT(whole[i], 0.0) << sky_part_names[i];
  EXPECT_EQ(SkyModel({}, scene, johnson_v(), extinction).photons_per_s_m2_sr(at), 0.0);
}

// Over directions (through the zenith, along and through the horizon) and over time (moonrise,
// dawn).
TEST(SkyModel, ContinuousAndFiniteEverywhere) {
  SkyScene scene = night();
  scene.moon_phase_rad = 0.3;
  scene.moon = towards(100, 20);
  scene.sun = towards(80, -9);
  const SkyModel sky = model("urban", scene);
  const auto check = [](double& last, double here, double factor, double at) {
    ASSERT_TRUE(std::isfinite(here)) << at;
    ASSERT_GT(here, 0.0) << at;
    if (last > 0) {
      EXPECT_NEAR(std::log(here / last), 0.0, std::log(factor)) << at;
    }
    last = here;
  };
  for (const double azimuth : {0.0, 80.0, 100.0, 213.0}) {
    double last = 0;
    for (double altitude = -90; altitude <= 270; altitude += 0.02)
      check(last, sky.photons_per_s_m2_sr(towards(azimuth, altitude)), 1.2, altitude);
  }
  double last = 0;
  for (double time = 0; time < 30; time += 0.02) {
    scene.moon = towards(100, time - 10);
    scene.sun = towards(80, time - 20);
    check(last, model("dark", scene).photons_per_s_m2_sr(towards(120, 40)), 1.2, time);
  }
}

// ESO's sky calculator, dark sky in the zenith: U 22.1, B 22.8, V 21.8, R 21.1, I 19.7.
TEST(SkyModel, ADarkSkyIsReddish) {
  const double expected[] = {22.1, 22.8, 21.8, 21.1, 19.7};
  const char* names[] = {"bessell-U", "bessell-B", "bessell-V", "bessell-R", "bessell-I"};
  for (int i = 0; i < 5; ++i) {
    const Band band = *filter_named(names[i]);
    const double per_arcsec2 =
        model("dark", night(), band).photons_per_s_m2_sr({0, 0, 1}) * arcsec * arcsec;
    EXPECT_NEAR(magnitude_of_light(per_arcsec2 / zero_point_photons_per_s_m2(band)), expected[i],
                0.25)
        << names[i];
  }
}

// Lamps are brightest in G: a grey streak stands out most in B and least in G (the paper's figure
// 7).
TEST(SkyModel, UrbanSkyAgainstAStreakInBGR) {
  double contrast[3];
  const char* names[] = {"bessell-B", "bessell-V", "bessell-R"};
  for (int i = 0; i < 3; ++i) {
    const Band band = *filter_named(names[i]);
    contrast[i] = sunlight_photons_per_s_m2(4.0, band) /
                  model("urban", night(), band).photons_per_s_m2_sr({0, 0, 1});
  }
  EXPECT_GT(contrast[0], contrast[1]);
  EXPECT_GT(contrast[0], contrast[2]);
}

}  // namespace
}  // namespace dmise
