#include <cmath>

#include "core/base/units.h"
#include "tests/pipeline/harness.h"

namespace dmise::test {
namespace {

/// A plate that faces the camera 20 km away, dark to the Sun, at 300 K, seen from 8 to 12 um.
std::string scenario(const std::string& side_m, const std::string& sky) {
  return R"(
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5}
objects:
  - name: platform
    motion: {fixed: {gcrs_m: [42000000, 1000000, 2000000]}}
  - name: panel
    motion: {fixed: {gcrs_m: [42020000, 1000000, 2000000]}}
    attitude: {inertial: {gcrs_from_body: [0.7071067811865476, 0, -0.7071067811865476, 0]}}
    geometry: {materials: warm.yaml, model: plate, size_m: [)" +
         side_m + ", " + side_m + R"(], front: warm, back: warm}
sensors:
  - name: eye
    platform: platform
    pointing: {target: panel}
    exposure_s: 0.5
    cadence_s: 5
    effects: {)" +
         sky + R"(photon_noise: off, read_noise: off, dark_current: off}
    camera:
      optics: {columns: 64, rows: 64, pixel_pitch_m: 1.0e-5, focal_length_m: 1, aperture_m: 0.1}
      detector: {full_well_e: 1.0e+9, gain_e_per_dn: 10, adc_bits: 16, quantum_efficiency: 0.5}
      band: {name: N, centre_m: 10e-6, width_m: 4e-6}
)";
}

std::filesystem::path with_material() {
  const auto folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("warm-") + testing::UnitTest::GetInstance()->current_test_info()->name());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "warm.yaml")
      << "materials:\n  warm: {source: test, model: lambert, reflectance: 0, temperature_k: 300, "
         "thermal_emissivity: 0.9}\n";
  return folder / "warm.yaml";
}

std::string with(std::string text, const std::string& material) {
  text.replace(text.find("warm.yaml"), 9, material);
  return text;
}

// Planck's law summed here over the band: photons of a plate as a point and with a shape.
TEST(ThermalShapes, AWarmPlateShinesByPlancksLawAlsoBeyondTheSolarTable) {
  const std::string material = with_material().string();
  double photons_per_s_m2_sr = 0;
  constexpr int steps = 4000;
  for (int i = 0; i < steps; ++i) {
    const double x_m = 8e-6 + 4e-6 * (i + 0.5) / steps;
    photons_per_s_m2_sr +=
        2 * 299792458.0 / std::pow(x_m, 4) /
        (std::exp(6.62607015e-34 * 299792458.0 / (x_m * 1.380649e-23 * 300)) - 1) * 4e-6 / steps;
  }
  for (const double side_m : {0.005, 0.5}) {
    Stage stage(with(scenario(std::to_string(side_m), "sky: off, "), material));
    const auto frame = stage.frame();
    const Truth& truth = frame.truths.at(0);
    EXPECT_EQ(truth.resolved, side_m > 0.1);
    const double expected_e =
        0.9 * photons_per_s_m2_sr * side_m * side_m / (2e4 * 2e4) * pi / 4 * 0.1 * 0.1 * 0.5 * 0.5;
    EXPECT_NEAR(truth.rendered_signal_e / expected_e, 1.0, 5e-3) << side_m;
  }
}

// A plate that reflects nothing has no light at all without its warmth, as a point and with a
// shape.
TEST(ThermalShapes, OffTheEffectLeavesAWarmBlackPlateDark) {
  const std::string material = with_material().string();
  for (const char* side_m : {"0.005", "0.5"}) {
    Stage stage(with(scenario(side_m, "sky: off, thermal_emission: off, "), material));
    EXPECT_EQ(stage.frame().truths.at(0).rendered_signal_e, 0.0) << side_m;
  }
}

TEST(ThermalShapes, InSpaceASkyOfOneBrightnessIsDrawnInThermalBands) {
  const std::string material = with_material().string();
  EXPECT_NO_THROW(Stage(with(scenario("1", "sky: off, "), material)));
  EXPECT_NO_THROW(Stage(with(scenario("1", ""), material)));
}

}  // namespace
}  // namespace dmise::test
