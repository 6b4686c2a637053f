// What the instruments of an observatory say of the air.
#include "sensors/observatory/site_conditions.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

SkyModel even_sky(double v_mag_per_arcsec2) {
  SkyParts parts;
  parts.uniform = UniformSky{v_mag_per_arcsec2};
  return SkyModel(parts, SkyScene{}, Band{}, standard_atmosphere(0.17).extinction_mag_per_airmass);
}

// Reference: psychrometric tables (Smithsonian Meteorological Tables, 6th edition, table 94 ff.).
TEST(SiteConditions, DewPointsAreThoseOfTables) {
  EXPECT_NEAR(dew_point_c({.temperature_c = 20.0, .humidity = 0.5}), 9.3, 0.1);
  EXPECT_NEAR(dew_point_c({.temperature_c = 30.0, .humidity = 0.8}), 26.2, 0.1);
  EXPECT_NEAR(dew_point_c({.temperature_c = 5.0, .humidity = 1.0}), 5.0, 1e-9);
  EXPECT_TRUE(std::isfinite(dew_point_c({.temperature_c = 20.0, .humidity = 0.0})));
}

// Reference: 22 mag/arcsec2 are 0.174 mcd/m2 (Falchi et al. 2016, Science Advances 2, e1600377).
TEST(SiteConditions, LightOfAnEvenSky) {
  EXPECT_NEAR(sky_lux(even_sky(22.0)), pi * 0.174e-3, 0.03 * pi * 0.174e-3);
  EXPECT_NEAR(sky_lux(even_sky(19.5)) / sky_lux(even_sky(22.0)), 10.0, 1e-6);
}

TEST(SiteConditions, CloudsKeepLightOut) {
  EXPECT_EQ(cloud_cover_percent(UniformCloud{1.0}, 0.0), 0.0);
  EXPECT_NEAR(cloud_cover_percent(PatchyClouds{.cover = 1.0, .transmission = 0.0}, 0.0), 100.0,
              1e-9);
  EXPECT_EQ(cloud_cover_percent(PatchyClouds{.cover = 0.0, .transmission = 0.0}, 0.0), 0.0);
  const double half =
      cloud_cover_percent(PatchyClouds{.cover = 0.5, .transmission = 0.0, .patch_m = 300.0}, 0.0);
  EXPECT_NEAR(half, 50.0, 15.0);
}

// Reference: 0.976 x 0.5 um / 0.1 m = 1.007 arcsec.
TEST(SiteConditions, TellWhatTheScenarioSays) {
  SensorConfig sensor;
  SiteConditions c = site_conditions(sensor, {.temperature_c = 3.0}, even_sky(20.0), 0.0);
  EXPECT_EQ(c.air.temperature_c, 3.0);
  EXPECT_NEAR(c.sky_mag_per_arcsec2.value(), 20.0, 1e-9);
  EXPECT_EQ(c.star_fwhm_arcsec, std::nullopt);
  EXPECT_EQ(c.wind_m_per_s, std::nullopt);
  sensor.seeing = SensorSeeing{.r0_m = 0.1};
  sensor.atmosphere.turbulence = TurbulenceConfig{};
  c = site_conditions(sensor, {}, even_sky(20.0), 0.0);
  EXPECT_NEAR(c.star_fwhm_arcsec.value(), 1.007, 0.001);
  EXPECT_EQ(c.wind_m_per_s, 5.0);
}

TEST(WeatherStation, MeasuresEveryTenSeconds) {
  int count = 0;
  WeatherStation station([&](SimTime t) {
    ++count;
    return SiteConditions{.air = {.temperature_c = t.seconds()}};
  });
  EXPECT_EQ(station.conditions(sim_seconds(1)).air.temperature_c, 1.0);
  EXPECT_EQ(station.conditions(sim_seconds(10)).air.temperature_c, 1.0);
  EXPECT_EQ(station.age_s(sim_seconds(10)), 9.0);
  EXPECT_EQ(station.conditions(sim_seconds(11)).air.temperature_c, 11.0);
  station.refresh(sim_seconds(12));
  EXPECT_EQ(station.age_s(sim_seconds(12)), 0.0);
  EXPECT_EQ(count, 3);
}

}  // namespace
}  // namespace dmise
