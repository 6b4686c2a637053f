#include "core/config/objects/sky_config.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/sensors/band_config.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

Surroundings read(const std::string& text, Surroundings known = {}) {
  static const Section section{"surroundings", "", surroundings_keys()};
  YamlMap map(YamlValue::parse(text, "s.yaml"), section);
  read_surroundings(map, known);
  map.done();
  return known;
}

std::string complaint(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(SkyConfig, ANameAFigureOrAMapping) {
  EXPECT_TRUE(read("sky: urban").sky->parts.light_pollution);
  EXPECT_FALSE(read("sky: dark").sky->parts.light_pollution);
  EXPECT_EQ(read("sky: 20.3").sky->parts.uniform->v_mag_per_arcsec2, 20.3);
  EXPECT_FALSE(read("sky: 20.3").sky->parts.airglow);
  EXPECT_EQ(read("sky: {zenith_mag_per_arcsec2: 20.3}").sky->parts.uniform->v_mag_per_arcsec2,
            20.3);
  const auto sky = *read(
                        "sky: {preset: urban, zenith_mag_per_arcsec2: 17.5,"
                        " parts: {scattered_moonlight: off}, lamps: {led: 1},"
                        " cities: [{azimuth_deg: 90}]}")
                        .sky;
  EXPECT_FALSE(sky.parts.scattered_moonlight);
  EXPECT_TRUE(sky.parts.twilight);
  EXPECT_EQ(sky.parts.light_pollution->lamps.hps, 0.0);
  EXPECT_NEAR(sky.parts.light_pollution->cities.at(0).azimuth_rad, pi / 2, 1e-12);
  // Lamps and the natural sky of 21.9 together make 17.5.
  const double lamps_s10 =
      s10_of_mag_per_arcsec2(sky.parts.light_pollution->zenith_v_mag_per_arcsec2);
  EXPECT_NEAR(mag_per_arcsec2_of_s10(lamps_s10 + s10_of_mag_per_arcsec2(21.9)), 17.5, 1e-9);
}

TEST(SkyConfig, AirAndWeather) {
  const auto air =
      *read("atmosphere: {extinction: la_palma, refraction: off, turbulence: hv57}").atmosphere;
  EXPECT_EQ(air.extinction, "la_palma");
  EXPECT_EQ(air.refraction, false);
  EXPECT_TRUE(air.turbulence);
  EXPECT_NEAR(read("atmosphere: {extinction: 0.3}")
                  .atmosphere->extinction_mag_per_airmass.at_or_end(550 * nm),
              0.3, 1e-12);
  // One key alone changes in a site's air.
  const auto changed = *read("atmosphere: {extinction: 0.3}", {.atmosphere = air}).atmosphere;
  EXPECT_NEAR(changed.extinction_mag_per_airmass.at_or_end(550 * nm), 0.3, 1e-12);
  EXPECT_EQ(changed.refraction, false);
  EXPECT_TRUE(changed.turbulence);
  const auto weather = *read("weather: {pressure_hpa: 980, clouds: {cover: 0.4, seed: 3}}").weather;
  EXPECT_EQ(weather.air->pressure_hpa, 980);
  EXPECT_EQ(std::get<PatchyClouds>(*weather.clouds).seed, 3u);
  EXPECT_EQ(std::get<UniformCloud>(*read("weather: {clouds: 0.7}").weather->clouds).transmission,
            0.7);
}

TEST(SkyConfig, WaterAndTheSunsFlux) {
  EXPECT_EQ(read("weather: {pwv_mm: 0}").weather->pwv_mm, 0.0);
  EXPECT_FALSE(read("weather: {clouds: 0.5}").weather->pwv_mm);
  EXPECT_EQ(read("sky: {preset: dark, solar_flux_sfu: 150}").sky->parts.airglow->solar_flux_sfu,
            150.0);
  EXPECT_NE(complaint("weather: {pwv_mm: 101}").find("s.yaml:1:19: weather.pwv_mm: must be"),
            std::string::npos)
      << complaint("weather: {pwv_mm: 101}");
  EXPECT_NE(complaint("sky: {preset: dark, solar_flux_sfu: 20}").find("s.yaml:1:37: sky.solar"),
            std::string::npos)
      << complaint("sky: {preset: dark, solar_flux_sfu: 20}");
  EXPECT_NE(complaint("sky: {preset: space, solar_flux_sfu: 70}").find("there is no airglow"),
            std::string::npos);
}

TEST(SkyConfig, SaysWhereAndWhy) {
  EXPECT_EQ(complaint("sky: urbn"),
            "s.yaml:1:6: sky: must be one of urban, suburban, dark, space, did you mean urban?, "
            "got urbn");
  EXPECT_EQ(complaint("sky: {preset: urban, part: {}}"),
            "s.yaml:1:22: sky.part: unknown key, did you mean parts?");
  EXPECT_EQ(complaint("sky: {preset: urban, parts: {moonlight: off}}"),
            "s.yaml:1:30: sky.parts.moonlight: unknown key");
  EXPECT_EQ(complaint("sky: {preset: dark, lamps: {led: 1}}"),
            "s.yaml:1:28: sky.lamps: there is no light pollution in this sky");
  EXPECT_EQ(complaint("sky: {preset: urban, lamps: {led: 0}}"),
            "s.yaml:1:29: sky.lamps: one share must be > 0");
  EXPECT_EQ(complaint("sky: {preset: urban, zenith_mag_per_arcsec2: 22}"),
            "s.yaml:1:46: sky.zenith_mag_per_arcsec2: must be brighter (less) than the natural "
            "sky's 21.9,"
            " or without preset, got 22");
  EXPECT_TRUE(complaint("atmosphere: {extinction: la_plama}")
                  .ends_with("did you mean la_palma?, got la_plama"));
  EXPECT_EQ(complaint("weather: {clouds: 1.5}"),
            "s.yaml:1:19: weather.clouds: must be <= 1, got 1.5");
  EXPECT_EQ(complaint("weather: {humidity: 0.5}"),
            "s.yaml:1:10: weather: temperature and humidity need pressure_hpa beside them");
}

// The 5/7 model at 0.5 um: 4.96 cm; towards 30 deg elevation X^(-3/5) of it.
TEST(SkyConfig, ASeeingOfAProfile) {
  const auto seeing =
      YamlMap(YamlValue::parse("seeing: {profile: hv57, outer_scale_m: 25}", "s.yaml"))
          .require("seeing");
  const SensorSeeing zenith = read_seeing(seeing, 1.0);
  EXPECT_NEAR(zenith.r0_m, 0.0496, 0.005 * 0.0496);
  EXPECT_EQ(zenith.outer_scale_m, 25);
  EXPECT_NEAR(read_seeing(seeing, 2.0).r0_m / zenith.r0_m, std::pow(2, -0.6), 1e-9);
}

class CurveFile : public testing::Test {
 protected:
  std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "curve.csv";
  void TearDown() override { std::filesystem::remove(path); }
  YamlValue naming(const std::string& content) {
    std::ofstream(path) << content;
    return YamlMap(YamlValue::parse("key: " + path.filename().string(), path.string()))
        .require("key");
  }
  std::string complaint_of(const std::string& content) {
    try {
      read_quantum_efficiency(naming(content));
    } catch (const ConfigError& e) {
      const std::string what = e.what();
      return what.substr(what.find(".csv:") + 5);
    }
    return "";
  }
};

TEST_F(CurveFile, AFilterAndAnEfficiencyAreOneSpectralIntegral) {
  const auto qe = read_quantum_efficiency(
      naming("# a made-up one\nwavelength_nm,efficiency_percent\n400,20\n550,60\n700,30\n"));
  EXPECT_NEAR(qe.peak, 0.6, 1e-12);
  const Band band = through(*filter_named("bessell-V"), qe.relative);
  // By hand: the sum over 0.1 nm of the Sun's photons x filter x efficiency.
  const Curve& sun = solar_spectrum().irradiance;
  double sum = 0;
  for (double x = 470.05; x < 700; x += 0.1) {
    const double efficiency = x < 550 ? 0.2 + 0.4 * (x - 400) / 150 : 0.6 - 0.3 * (x - 550) / 150;
    sum += sun.at_or_zero(x * nm) * filter_named("bessell-V")->response.at_or_zero(x * nm) *
           efficiency * x * nm * 0.1 * nm;
  }
  sum /= 6.62607015e-34 * 299792458.0;
  EXPECT_NEAR(photon_rate_per_m2(solar_spectrum(), band) * qe.peak / sum, 1.0, 1e-4);
}

TEST_F(CurveFile, SaysWhereAndWhy) {
  EXPECT_EQ(complaint_of("nm,qe\n400,1\n"),
            "1: the first column must be wavelength_nm, _um, _m or _angstrom, got nm");
  EXPECT_EQ(complaint_of("wavelength_nm,qe\n400,1\n390,1\n"),
            "3: wavelengths must ascend, got 390");
  EXPECT_EQ(complaint_of("wavelength_nm,qe\n400,1.2\n"), "2: value must be in [0, 1], got 1.2");
  EXPECT_EQ(complaint_of("wavelength_nm,qe\n400,nan\n"), "2: value must be in [0, 1], got nan");
  EXPECT_EQ(complaint_of("wavelength_nm,qe\n400\n"), "2: needs a wavelength and a value, got 400");
}

TEST_F(CurveFile, FiltersByName) {
  const auto band = [](const std::string& text) {
    return read_band(YamlMap(YamlValue::parse("band: " + text, "c.yaml")).require("band"));
  };
  EXPECT_EQ(band("bessell-B").name, "bessell-B");
  EXPECT_EQ(band("{filter: sdss-r, name: r}").name, "r");
  EXPECT_NEAR(band("{filter: sdss-r}").centre_m, 0.62e-6, 0.01e-6);
  EXPECT_EQ(band("{centre_m: 0.55e-6, width_m: 0.128e-6}").width_m, 0.128e-6);
  try {
    band("{filter: bessel-V}");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_TRUE(std::string(e.what()).starts_with(
        "c.yaml:1:16: band.filter: no such filter, did you mean bessell-V?"))
        << e.what();
  }
}

}  // namespace
}  // namespace dmise
