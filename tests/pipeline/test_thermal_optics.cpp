#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/sky/thermal_sky.h"
#include "tests/pipeline/body_scenes.h"

// Heat of telescope, window and air in frames.
namespace dmise::test {
namespace {

constexpr double low_m = 8e-6, high_m = 12e-6, aperture_m = 0.1, pixel_rad = 1e-5, efficiency = 0.5;

/// A black body's photons/s/m2/sr in the band, by Planck's law with CODATA's constants.
double black_body(double kelvin) {
  constexpr int steps = 4000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double x_m = low_m + (high_m - low_m) * (i + 0.5) / steps;
    sum += 2 * 299792458.0 / std::pow(x_m, 4) /
           std::expm1(6.62607015e-34 * 299792458.0 / (1.380649e-23 * x_m * kelvin));
  }
  return sum * (high_m - low_m) / steps;
}

std::string camera_with(const std::string& emission, const std::string& band = "10e-6") {
  return "    camera:\n      optics: {projection: gnomonic, columns: 512, rows: 512, "
         "pixel_pitch_m: "
         "1.0e-5, focal_length_m: 1, aperture_m: 0.1" +
         emission +
         "}\n      detector: {full_well_e: 1.0e+9, gain_e_per_dn: 10, adc_bits: 16, "
         "quantum_efficiency: 0.5}\n      band: {name: N, centre_m: " +
         band + ", width_m: 4e-6}\n";
}

std::string in_orbit(const std::string& emission, const std::string& effects = "") {
  return R"(simulation: {start: 2018-01-21T00:00:00Z, duration_s: 20, tick_s: 5, seed: 4}
objects:
  - name: platform
    motion: {fixed: {gcrs_m: [42000000, 1000000, 2000000]}}
sensors:
  - name: eye
    platform: platform
    pointing: {ra_deg: 30, dec_deg: 20}
    exposure_s: 0.005
    cadence_s: 5
    effects: {sky: off, read_noise: off, dark_current: off)" +
         effects + "}\n" + camera_with(emission);
}

std::string on_ground(const std::string& weather, const std::string& emission = "",
                      const std::string& band = "10e-6") {
  return R"(simulation: {start: 2018-01-21T10:00:00Z, duration_s: 20, tick_s: 5, seed: 4}
sensors:
  - name: eye
    site: {latitude_deg: 19.8, longitude_deg: -155.5, height_m: 4168}
    pointing: zenith
    exposure_s: 0.001
    cadence_s: 5
    weather: {pressure_hpa: 616, temperature_c: 1, humidity: 0.2)" +
         weather + "}\n" + camera_with(emission, band);
}

constexpr const char* warm =
    ", emission: {emissivity: 0.1, temperature_c: 6.85, window_emissivity: 0.05, "
    "window_temperature_c: -23.15}";
const double pixel_e_per_photon =
    pi / 4 * aperture_m * aperture_m * pixel_rad * pixel_rad * efficiency;

TEST(ThermalOptics, MeanAndVarianceOfAFrameAreThoseOfPlancksLaw) {
  const double expected_e =
      0.005 * pixel_e_per_photon * (0.1 * black_body(280.0) + 0.05 * black_body(250.0));
  Stage stage(in_orbit(warm));
  const auto light = light_of(stage);
  EXPECT_NEAR(light.at(256, 256) * 0.005 / expected_e, 1.0, 1e-3);  // a plane of e-/s
  const auto frame = stage.frame();
  double sum = 0.0, squares = 0.0;
  const auto& pixels = frame.counts.pixels;
  for (const auto dn : pixels) sum += dn;
  const double mean = sum / double(pixels.size());
  for (const auto dn : pixels) squares += (dn - mean) * (dn - mean);
  const Detector& detector = stage.scenario.sensors[0].camera.detector;
  EXPECT_NEAR((mean - detector.bias_dn) * 10.0 / expected_e, 1.0, 2e-3);
  EXPECT_NEAR(squares / double(pixels.size()) * 100.0 / expected_e, 1.0, 0.01);
}

TEST(ThermalOptics, IsNothingWhereItIsOffOrCold) {
  Stage off(in_orbit(warm, ", thermal_optics: off"));
  EXPECT_EQ(sum_of(light_of(off)), 0.0);
  Stage cold(in_orbit(", emission: {emissivity: 1, temperature_c: -273.15}"));
  EXPECT_EQ(sum_of(light_of(cold)), 0.0);
}

TEST(ThermalOptics, OfASensorOnTheGroundHasTheAirsTemperatureAndAddsToTheSky) {
  Stage sky(on_ground(", pwv_mm: 1.6")),
      both(on_ground(", pwv_mm: 1.6", ", emission: {emissivity: 0.1}"));
  const double air = light_of(sky).at(256, 256), all = light_of(both).at(256, 256);
  const double heat_e_per_s = pixel_e_per_photon * 0.1 * black_body(274.15);
  EXPECT_NEAR((all - air) / heat_e_per_s, 1.0, 2e-3);
  const AirRadiance radiance(sky.scenario.sensors[0].camera.band,
                             {.pwv_mm = 1.6, .pressure_hpa = 616, .temperature_k = 274.15});
  EXPECT_NEAR(air / (pixel_e_per_photon * radiance.photons_per_s_m2_sr(1.0)), 1.0, 0.01);
}

std::string refusal(const std::string& yaml) {
  try {
    Stage stage(yaml);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(ThermalOptics, WhatIsNotKnownIsRefused) {
  EXPECT_NE(refusal(on_ground("")).find("which weather: {pwv_mm: ..} gives"), std::string::npos);
  EXPECT_NE(refusal(on_ground(", pwv_mm: 2", "", "26e-6")).find("the air's heat is known to 25 um"),
            std::string::npos);
  EXPECT_EQ(refusal(on_ground(", pwv_mm: 2", "", "12e-6")), "");
  EXPECT_NE(refusal(in_orbit(", emission: {emissivity: 0.1}")).find("needs temperature_c"),
            std::string::npos);
  EXPECT_NE(refusal(in_orbit(", emission: {temperature_c: 3}")).find("above 0"), std::string::npos);
  EXPECT_NE(refusal(in_orbit(", emission: {emissivity: 1.1, temperature_c: 3}")).find("emissivity"),
            std::string::npos);
}

}  // namespace
}  // namespace dmise::test
