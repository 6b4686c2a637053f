#include <cmath>

#include "tests/pipeline/wiring.h"

namespace dmise {
namespace {

/// Looks at the celestial equator from a fixed mount; a star of V = 4 in the middle at the first
/// exposure drifts west.
std::string equator(const std::string& detector, const std::string& effects, double exposure_s,
                    double cadence_s) {
  return test::scenario("2018-01-21T03:00:00Z", 5 * cadence_s, "site: atlanta",
                        test::camera(96, 64, 0.0344, detector),
                        "{azimuth_deg: 180, elevation_deg: 56.22}", exposure_s, cadence_s,
                        ", effects: {" + effects + "}", "", test::with_stars);
}

double sum_around(const CountImage& counts, PixelPosition at, int radius_px) {
  double sum = 0;
  for (int y = -radius_px; y <= radius_px; ++y)
    for (int x = -radius_px; x <= radius_px; ++x)
      sum += counts.at(int(std::lround(at.x_px)) + x, int(std::lround(at.y_px)) + y);
  return sum;
}

PixelPosition brightest(const CountImage& counts) {
  const auto most = std::max_element(counts.pixels.begin(), counts.pixels.end());
  const auto i = int(most - counts.pixels.begin());
  return {double(i % counts.columns), double(i / counts.columns)};
}

// Closed form: well / gain + bias.
TEST(DetectorInRun, AFullWellIsAPlateauAtItsCount) {
  test::Stage stage(
      equator("full_well_e: 90000, gain_e_per_dn: 1.5, bias_dn: 200, adc_bits: 16",
              "sky: off, photon_noise: off, dark_current: off, read_noise: off", 1, 2),
      "ra_deg,dec_deg,mag_v,bv\n81,0,-8,0.65\n");
  auto& optics = stage.scenario.sensors[0].camera.optics;
  optics.focal_length_m /= 20;  // the star is in the frame, wherever
  const auto frame = stage.frame();
  const auto highest = *std::max_element(frame.counts.pixels.begin(), frame.counts.pixels.end());
  EXPECT_EQ(highest, 60200);
  EXPECT_GE(std::count(frame.counts.pixels.begin(), frame.counts.pixels.end(), 60200), 5);
}

// Closed form: a full pixel gives each of its four neighbours 2 % of its charge, and at full well
// the response is down by 5 %; warmed by 12 K with a doubling in 6 K, dark current is four times
// that of the reference.
TEST(DetectorInRun, TheHeaderHasTheFiguresInEffect) {
  test::Stage stage(equator("full_well_e: 90000, gain_e_per_dn: 1.5, bias_dn: 200, adc_bits: 16, "
                            "interpixel_coupling: 0.02, nonlinearity: 0.05, dark_e_per_s: 3, "
                            "dark_reference_c: -20, temperature_c: -8, dark_doubling_k: 6",
                            "sky: off", 1, 2),
                    "ra_deg,dec_deg,mag_v,bv\n0,-80,6,0.65\n");
  const auto header = stage.frame().header;
  EXPECT_NEAR(header.saturation_dn, 90000 * 0.92 * 0.95 / 1.5 + 200, 1e-6);
  EXPECT_NEAR(header.dark_e_per_s, 12.0, 1e-9);
}

// Closed form: rate x exposure; the detector is emptied before each exposure.
TEST(DetectorInRun, DarkCurrentGathersWhileTheShutterIsOpenAlone) {
  test::Stage stage(equator("full_well_e: 1.0e+6, gain_e_per_dn: 1, dark_e_per_s: 50",
                            "sky: off, photon_noise: off, read_noise: off", 2, 20),
                    "ra_deg,dec_deg,mag_v,bv\n0,-80,6,0.65\n");
  const auto frame = stage.frame(2);
  double sum = 0;
  for (const auto c : frame.counts.pixels) sum += c;
  const double pixels = double(frame.counts.pixels.size());
  EXPECT_NEAR(sum / pixels, 100.0, 5 * 10.0 / std::sqrt(pixels));
}

// Closed form: what is trapped of a star's charge in the first exposure leaves as exp(-t / tau),
// from one exposure to the next by exp(-cadence / tau).
TEST(DetectorInRun, TrappedChargeLeavesByTheCadence) {
  constexpr double exposure_s = 5, cadence_s = 30, tau_s = 60, share = 0.3;
  test::Stage stage(
      equator("full_well_e: 1.0e+7, gain_e_per_dn: 1, persistence_fraction: 0.3, persistence_s: 60",
              "sky: off, photon_noise: off, dark_current: off, read_noise: off, scintillation: off",
              exposure_s, cadence_s),
      "ra_deg,dec_deg,mag_v,bv\n81.1,0,-0.5,0.65\n");
  const auto first = stage.frame(1), second = stage.frame(2), third = stage.frame(3);
  const PixelPosition at = brightest(first.counts);
  ASSERT_GT(at.x_px, 4);
  ASSERT_LT(at.x_px, 91);
  const double charge = sum_around(first.counts, at, 3) / (1.0 - share);  // with what is trapped
  const double after = sum_around(second.counts, at, 3), later = sum_around(third.counts, at, 3);
  ASSERT_GT(after, 500.0);
  EXPECT_NEAR(
      after / charge,
      share * std::exp(-(cadence_s - exposure_s) / tau_s) * -std::expm1(-exposure_s / tau_s),
      0.02 * after / charge);
  EXPECT_NEAR(later / after, std::exp(-cadence_s / tau_s), 0.01);
}

}  // namespace
}  // namespace dmise
