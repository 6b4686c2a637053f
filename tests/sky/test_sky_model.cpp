#include "core/sky/sky_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"
#include "core/sky/air/extinction.h"
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

double v_mag_per_arcsec2(const SkyModel& sky, const Vec<Enu>& direction) {
  const auto s10 = sky.parts_s10(direction);
  return mag_per_arcsec2_of_s10(std::accumulate(s10.begin(), s10.end(), 0.0));
}

TEST(SkyModel, PresetsHaveTheirBrightnessAtTheZenith) {
  const Vec<Enu> zenith{0, 0, 1};
  EXPECT_NEAR(v_mag_per_arcsec2(model("dark", night()), zenith), 21.9, 0.2);
  EXPECT_NEAR(v_mag_per_arcsec2(model("suburban", night()), zenith), 20.0, 0.05);
  EXPECT_NEAR(v_mag_per_arcsec2(model("urban", night()), zenith), 18.0, 0.02);
  SkyScene space = night();
  space.in_air = false;
  EXPECT_EQ(model("space", space).parts_s10(zenith)[1], 0.0);  // airglow
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
  for (int i = 1; i < 7; ++i) EXPECT_GT(whole[i], 0.0) << i;
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
  for (double time = 0; time < 30; time += time < 14 ? 0.02 : 0.1) {  // each day has its own table
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

/// Vega, whose table ends at 2.195 um, to 2.5 um by the power -4 of a hot body.
Spectrum vega_to_k() {
  Spectrum vega = vega_spectrum();
  Curve& curve = vega.irradiance;
  const double last_m = curve.wavelength_m.back(), last = curve.value.back();
  for (double x = 2200 * nm; x < 2510 * nm; x += 25 * nm) {
    curve.wavelength_m.push_back(x);
    curve.value.push_back(last * std::pow(x / last_m, -4.0));
  }
  return vega;
}

/// Vega magnitude a square arc second of a dark zenith.
double dark_zenith_mag(const Band& band, const SkyParts& parts) {
  SkyScene paranal = night();  // by ESO's calculator; water: Kerber et al. 2014, MNRAS 439, 247
  paranal.warm_air.pwv_mm = 2.4;
  const SkyModel sky(parts, paranal, band, *extinction_of_site("lick"));
  const double vega = photon_rate_per_m2(vega_to_k(), band) / light_of_magnitude(0.03);
  return magnitude_of_light(sky.photons_per_s_m2_sr({0, 0, 1}) * arcsec * arcsec / vega);
}

Band top_hat(const char* name, double low_nm, double high_nm) {
  return {name, 0.5 * (low_nm + high_nm) * nm, (high_nm - low_nm) * nm, {}};
}

// ESO's sky calculator, dark sky in the zenith: J 16.9, H 14.4, K 15.2.
TEST(SkyModel, ADarkSkyIsBrightInTheInfrared) {
  const SkyParts dark = *sky_parts_named("dark");
  EXPECT_NEAR(dark_zenith_mag(top_hat("J", 1170, 1330), dark), 16.9, 0.5);
  EXPECT_NEAR(dark_zenith_mag(top_hat("H", 1490, 1780), dark), 14.4, 0.5);
  EXPECT_NEAR(dark_zenith_mag(top_hat("K", 2030, 2370), dark), 15.2, 0.5);
}

// Noll et al. 2012: the airglow's continuum goes as 0.2068 + 0.006139 S. Walker 1988 found the dark
// sky 0.5 mag brighter in V at the Sun's maximum (200) than at its minimum (70).
TEST(SkyModel, AirglowFollowsTheSunsCycle) {
  SkyParts parts = *sky_parts_named("dark");
  const auto mag = [&](const Band& band, double solar_flux_sfu) {
    parts.airglow->solar_flux_sfu = solar_flux_sfu;
    return dark_zenith_mag(band, parts);
  };
  EXPECT_EQ(mag(johnson_v(), 130), dark_zenith_mag(johnson_v(), *sky_parts_named("dark")));
  EXPECT_NEAR(mag(johnson_v(), 70) - mag(johnson_v(), 200), 0.5, 0.2);
  EXPECT_NEAR(airglow_by_solar_flux(200) / airglow_by_solar_flux(70),
              (0.2068 + 0.006139 * 200) / (0.2068 + 0.006139 * 70), 1e-12);
  // OH does not follow.
  const Band h = top_hat("H", 1490, 1780);
  EXPECT_NEAR(mag(h, 70), mag(h, 200), 0.01);
  // Both ends of the range.
  for (const double sfu : {50.0, 400.0})
    for (const Band& band : {top_hat("line", 557, 558), top_hat("all", 300, 2490)})
      EXPECT_TRUE(std::isfinite(mag(band, sfu))) << band.name << sfu;
  EXPECT_GT(mag(johnson_v(), 50), mag(johnson_v(), 400) + 0.8);
}

// Leinert et al. 1998, table 19: the zodiacal light 90 deg from the Sun over that at 0.5 um, two
// figures each (so 4 %), against their section 8.4.2 over the spectrum of the Sun. Sunlight alone
// is 35 % too faint at 2.2 um.
TEST(SkyModel, ZodiacalLightIsRedderThanTheSun) {
  SkyParts parts;
  parts.zodiacal_light = ZodiacalLight{};
  SkyScene space = night();
  space.in_air = false;
  space.sun = {1, 0, 0};
  const auto energy = [&](double um_) {
    const Band line{"line", um_ * um, 0.04 * um, {}};
    return SkyModel(parts, space, line, {}).photons_per_s_m2_sr({0, 0, 1}) / um_;
  };
  const struct {
    double um, over_500_nm;
  } table[] = {
      {0.7, 2.0 / 2.6}, {0.9, 1.3 / 2.6}, {1.0, 1.2 / 2.6}, {1.2, 0.81 / 2.6}, {2.2, 0.17 / 2.6}};
  for (const auto& [at, expected] : table)
    EXPECT_NEAR(energy(at) / energy(0.5) / expected, 1.0, 0.12) << at;
}

// Leinert et al. 1998, section 8.4.2: f = 1 + a log10(wavelength / 500 nm) with a = 1.2 (below 500
// nm) and 0.8 (above) 30 deg from the Sun, 0.9 and 0.6 at 90 deg.
TEST(ZodiacalLight, IsReddenedAsLeinertStates) {
  const auto factor = [](double wavelength_nm, double from_sun_deg) {
    const Band line{"line", wavelength_nm * nm, 1 * nm, {}};
    return 1.0 + zodiacal_slope(from_sun_deg * deg) * zodiacal_redness(line);
  };
  EXPECT_NEAR(factor(250, 30), 1 - 1.2 * 0.30103, 0.003);
  EXPECT_NEAR(factor(250, 90), 1 - 0.9 * 0.30103, 0.003);
  EXPECT_NEAR(factor(500, 60), 1.0, 0.001);
  EXPECT_NEAR(factor(1000, 30), 1 + 0.8 * 0.30103, 0.001);
  EXPECT_NEAR(factor(1000, 60), 1 + 0.7 * 0.30103, 0.001);
  EXPECT_NEAR(factor(1000, 150), 1 + 0.6 * 0.30103, 0.001);
  EXPECT_NEAR(factor(2400, 90), 1 + 0.6 * 0.68124, 0.001);
  EXPECT_EQ(zodiacal_slope(0.0), 0.8);
}

// Patat et al. 2006, table 1: zenith over Paranal in UBVRI; his night sky (Patat 2003) added to
// ours of twilight alone.
TEST(SkyModel, TwilightHasPatatsColoursAtEveryDepression) {
  SkyParts parts;
  parts.twilight = Twilight{};
  const struct {
    const char* band;
    double a0, a1, a2, night;
  } table[] = {{"bessell-U", 11.78, 1.376, -0.039, 22.28},
               {"bessell-B", 11.84, 1.411, -0.041, 22.64},
               {"bessell-V", 11.84, 1.518, -0.057, 21.61},
               {"bessell-R", 11.40, 1.567, -0.064, 20.87},
               {"bessell-I", 10.93, 1.470, -0.062, 19.71}};
  for (const auto& [name, a0, a1, a2, night_mag] : table)
    for (const double depression_deg : {5.0, 8.0, 11.0, 14.0}) {
      SkyScene scene = night();
      scene.sun = towards(80, -depression_deg);
      const Band band = *filter_named(name);
      const SkyModel sky(parts, scene, band, *extinction_of_site("paranal"));
      const double light =
          sky.photons_per_s_m2_sr({0, 0, 1}) * arcsec * arcsec / zero_point_photons_per_s_m2(band) +
          light_of_magnitude(night_mag);
      const double x = depression_deg - 5.0;
      EXPECT_NEAR(magnitude_of_light(light), a0 + a1 * x + a2 * x * x, 0.2)
          << name << " " << depression_deg;
    }
}

// Over the ends of the polynomials, too.
TEST(SkyModel, TwilightsColourIsContinuousInTime) {
  const auto b_over_i = [](double depression_deg) {
    const Spectrum spectrum = twilight_spectrum(-depression_deg * deg);
    return photon_rate_per_m2(spectrum, *filter_named("bessell-B")) /
           photon_rate_per_m2(spectrum, *filter_named("bessell-I"));
  };
  double last = b_over_i(-90.0);
  for (double depression_deg = -90; depression_deg <= 90; depression_deg += 0.05) {
    const double here = b_over_i(depression_deg);
    ASSERT_TRUE(std::isfinite(here) && here > 0.0) << depression_deg;
    EXPECT_NEAR(here / last, 1.0, 0.03) << depression_deg;
    last = here;
  }
}

// Water over the site takes light from above the air in its bands, and none of the airglow.
TEST(SkyModel, WaterDimsWhatIsAboveTheAir) {
  SkyParts parts;
  parts.zodiacal_light = ZodiacalLight{};
  SkyScene scene = night();
  const auto light = [&](const Band& band) {
    return SkyModel(parts, scene, band, *extinction_of_site("lick")).photons_per_s_m2_sr({0, 0, 1});
  };
  const Band water = top_hat("water", 1350, 1450), window = top_hat("window", 1600, 1650);
  const double dry[] = {light(water), light(window)};
  scene.gases = AirGases{10.0, 1013.25};
  EXPECT_LT(light(water) / dry[0], 0.4);
  EXPECT_GT(light(window) / dry[1], 0.9);
  scene.in_air = false;
  const double above = light(water);
  scene.gases.reset();
  EXPECT_EQ(above, light(water));
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
