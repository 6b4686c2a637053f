#include <gtest/gtest.h>

#include <cmath>

#include "core/frames/geodesy.h"
#include "core/orbit/two_body.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/reentry_light.h"
#include "tests/pipeline/harness.h"

namespace dmise::test {
namespace {

const Vec<Gcrs> eye_m{7.4e6, 25e3, 1.5e6};
const MotionState<Gcrs> entering{{6378137.0 + 105e3, 0, 0}, {-3000, 5000, 0}};

/// A body without light of the Sun that falls by 3 km a second from 105 km of height, seen from
/// 1800 km away.
std::string entry_scenario(const std::string& reentry, const std::string& motion = "two_body",
                           const std::string& forces = "", const std::string& exposure_s = "10") {
  return R"(
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 60, tick_s: 1, seed: 1}
objects:
  - {name: eye, motion: {fixed: {gcrs_m: [7.4e+6, 25.0e+3, 1.5e+6]}}}
  - {name: stage, radius_m: 0.001, motion: {)" +
         motion + R"(: {position_m: [6483137, 0, 0], velocity_m_per_s: [-3000, 5000, 0]})" +
         forces + R"(}, reentry: )" + reentry + R"(}
sensors:
  - name: watcher
    platform: eye
    pointing: {ra_deg: 180.0, dec_deg: -58.6}
    exposure_s: )" +
         exposure_s + R"(
    cadence_s: 10
    sky: space
    effects: {sky: off, photon_noise: off, read_noise: off, dark_current: off, earth_disc: off, limb_air: off}
    camera:
      optics: {columns: 512, rows: 512, pixel_pitch_m: 1.0e-5, focal_length_m: 0.03, aperture_m: 0.01}
      detector: {full_well_e: 1.0e+9, gain_e_per_dn: 10, adc_bits: 16}
      band: {name: V, centre_m: 0.55e-6, width_m: 0.1e-6}
)";
}

/// Seconds of light of magnitude 0 within a time of the run, by two bodies and the table.
double light_s(const ReentryLight& table, double from_s, double to_s) {
  constexpr int steps = 20000;
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double t = from_s + (k + 0.5) * (to_s - from_s) / steps;
    const TwoBodyState s = propagate_two_body({entering.position_m, entering.velocity_m_per_s}, t);
    // The pole is within 0.1 deg of z: some metres of height.
    const Vec<Itrs> place{s.position_m.x, s.position_m.y, s.position_m.z};
    const double ranges = table.range_m / norm(s.position_m - eye_m);
    sum += table.at(geodetic_from_itrs(place).height_m) * ranges * ranges * (to_s - from_s) / steps;
  }
  return sum;
}

void expect_integral(const std::string& reentry, const ReentryLight& table) {
  Stage stage(entry_scenario(reentry));
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  const Truth& truth = frame.truths[0];
  EXPECT_GT(std::hypot(truth.end_x_px - truth.start_x_px, truth.end_y_px - truth.start_y_px), 50);
  EXPECT_TRUE(truth.whole);
  const double zero_e = light_of_magnitude(-frame.header.zero_point_mag);
  EXPECT_NEAR(truth.rendered_signal_e /
                  (zero_e * light_s(table, truth.start.seconds(), truth.end.seconds())),
              1.0, 0.01);
}

TEST(Reentry, AStreakHasTheIntegralOfItsTable) {
  expect_integral("{height_m: [70.0e+3, 85.0e+3, 95.0e+3, 100.0e+3], magnitude: [-5, -8, -4, 2]}",
                  {{70e3, 85e3, 95e3, 100e3}, {-5, -8, -4, 2}});
  // Light that begins and ends at once.
  expect_integral("{height_m: [80.0e+3, 90.0e+3], magnitude: [4, 5], range_m: 1.0e+6}",
                  {{80e3, 90e3}, {4, 5}, 1e6});
}

// The light of a flight with drag is that of its height, above 30 km.
TEST(Reentry, AFlightThroughTheAirGlowsUntilTheTableEnds) {
  const ReentryLight table{{30e3, 100e3}, {3, -4}};
  Stage stage(entry_scenario("{height_m: [30.0e+3, 100.0e+3], magnitude: [3, -4]}", "numerical",
                             ", forces: {area_to_mass_m2_per_kg: 0.02}", "0.5"));
  const auto& object = stage.scenario.own_objects.back();
  ASSERT_TRUE(object.motion.flight);
  double lowest_m = 1e9;
  int lit = 0;
  for (std::uint32_t number = 1; number <= 5; ++number) {
    const auto frame = stage.frame(number);
    if (frame.truths.empty()) continue;
    const Truth& truth = frame.truths[0];
    const Vec<Itrs> place{truth.true_position_m.x, truth.true_position_m.y,
                          truth.true_position_m.z};
    const double height_m = geodetic_from_itrs(place).height_m;
    EXPECT_LT(height_m, lowest_m);
    lowest_m = height_m;
    const double light = table.at(height_m);
    if (light == 0.0) continue;
    ++lit;
    const double range_mag = 5 * std::log10(truth.true_range_m / 100e3);
    EXPECT_NEAR(truth.true_magnitude, magnitude_of_light(light) + range_mag, 0.01);
  }
  EXPECT_GE(lit, 2);
}

TEST(Reentry, MagnitudesAreLinearInHeightAndThereIsNoLightBeyond) {
  const ReentryLight light{{50e3, 80e3, 100e3}, {0, -5, 5}};
  EXPECT_EQ(light.at(49e3), 0.0);
  EXPECT_EQ(light.at(101e3), 0.0);
  EXPECT_NEAR(light.at(50e3), 1.0, 1e-12);
  EXPECT_NEAR(light.at(80e3), 100.0, 1e-10);
  EXPECT_NEAR(light.at(90e3), 1.0, 1e-12);
  EXPECT_NEAR(light.at(100e3), 0.01, 1e-12);
}

}  // namespace
}  // namespace dmise::test
