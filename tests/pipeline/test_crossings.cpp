#include "core/optics/projection.h"
#include "core/sky/bodies/shadow.h"
#include "core/wcs/wcs.h"
#include "sensors/scene/throughput.h"
#include "tests/pipeline/shape_scenes.h"

// Edges that an object crosses while the shutter is open: of the Earth's shadow, of the horizon, of
// the frame. The light is that of its time on the near side.
namespace dmise::test {
namespace {

const std::string point = "    radius_m: 0.5\n";
const std::string shape =
    "    attitude: sun_tracking\n    geometry: {model: sphere, radius_m: 20, facets: 720, "
    "material: "
    "white-paint}\n";

/// On the circular orbit at 90 deg from the last, at an angle from its node.
std::string on_orbit(double anomaly_deg) {
  return "    motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: "
         "98.6, raan_deg: 90, true_anomaly_deg: " +
         std::to_string(anomaly_deg) + "}}\n";
}

std::string in_orbit(double anomaly_deg, const std::string& target) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 24, tick_s: 2}\nobjects:\n  - "
         "name: platform\n" +
         on_orbit(anomaly_deg) + "  - name: target\n" + on_orbit(anomaly_deg + 0.16) + target +
         "sensors:\n  - name: eye\n    platform: platform\n    pointing: {target: target}\n    "
         "exposure_s: 20\n    cadence_s: 20\n    sky: space\n    effects: {sky: off, photon_noise: "
         "off, read_noise: off, dark_current: off}\n    camera:\n      optics: {columns: 128, "
         "rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 0.1, aperture_m: 0.02}\n      "
         "detector: "
         "{full_well_e: 1.0e+9, gain_e_per_dn: 10, adc_bits: 16}\n      band: {name: V, centre_m: "
         "0.55e-6, width_m: 0.1e-6}\n";
}

/// Mean of the Sun's free disc over the first exposure.
double mean_sunlit(const Stage& stage) {
  const auto& sensor = stage.scenario.sensors.at(0);
  const FrameTimes times = frame_times(sensor, 1);
  const View view(sensor, times, stage.states);
  const EarthShadow shadow(view.environment().sun_m, oblate_earth(view.earth()));
  const std::size_t target = object_index(stage.states.roster(), "target", "test");
  constexpr int steps = 4000;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum +=
        shadow.sunlit_fraction(stage.states.motion(target, times.at((i + 0.5) / steps)).position_m);
  return sum / steps;
}

TEST(Crossings, IntoTheShadowWithinAnExposureLeavesTheLightOfThePenumbra) {
  for (const std::string& target : {point, shape}) {
    // Where about half of the exposure is dark.
    double lit_deg = -1, dark_deg = -1, last = 0;
    for (double anomaly = 0; anomaly <= 720 && dark_deg < 0; anomaly += 20) {
      const double now = mean_sunlit(Stage(in_orbit(anomaly, point)));
      if (last >= 1 && now <= 0) {
        lit_deg = anomaly - 20;
        dark_deg = anomaly;
      }
      last = now;
    }
    ASSERT_GE(lit_deg, 0.0);
    double middle = 0, half = 1;
    for (int i = 0; i < 14 && !(half > 0.35 && half < 0.65); ++i) {
      middle = (lit_deg + dark_deg) / 2;
      half = mean_sunlit(Stage(in_orbit(middle, point)));
      (half > 0.5 ? lit_deg : dark_deg) = middle;
    }
    Stage stage(in_orbit(middle, target));
    const auto frame = stage.frame();
    const Truth& truth = truth_named(frame, "target");
    EXPECT_EQ(truth.resolved, target == shape);
    const double full_e = frame.header.exposure_s *
                          light_of_magnitude(truth.true_magnitude - frame.header.zero_point_mag);
    EXPECT_NEAR(truth.rendered_signal_e / full_e, mean_sunlit(stage), 0.01) << truth.resolved;
    EXPECT_NEAR(truth.sunlit, mean_sunlit(stage), 0.01);
  }
}

/// A camera on the ground that looks east along the horizon, and an object that stands among the
/// stars at `object_m`.
std::string on_ground(const Vec<Gcrs>& object_m, const std::string& target) {
  char place[160];
  std::snprintf(place, sizeof place, "    motion: {fixed: {gcrs_m: [%.6f, %.6f, %.6f]}}\n",
                object_m.x, object_m.y, object_m.z);
  return std::string(
             "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 5}\n"
             "objects:\n  - name: target\n") +
         place + target +
         "sensors:\n  - name: eye\n    site: atlanta\n    pointing: {azimuth_deg: 90, "
         "elevation_deg: 0}\n    exposure_s: 10\n    cadence_s: 10\n    effects: {sky: off, "
         "extinction: off, refraction: off, scintillation: off, shadow: off, light_time: off, "
         "diurnal_aberration: off, photon_noise: off, read_noise: off, dark_current: off}\n    "
         "camera:\n      optics: {columns: 256, rows: 256, pixel_pitch_m: 1.0e-5, focal_length_m: "
         "0.5, aperture_m: 0.02}\n      detector: {full_well_e: 1.0e+9, gain_e_per_dn: 10, "
         "adc_bits: 16}\n      band: {name: V, centre_m: 0.55e-6, width_m: 0.1e-6}\n";
}

/// Where an object 40,000 km away stands whose light falls on a pixel in mid exposure.
Vec<Gcrs> behind_pixel(PixelPosition pixel) {
  const Stage any(on_ground({4.2e7, 0, 0}, point));
  const auto& sensor = any.scenario.sensors.at(0);
  const FrameTimes times = frame_times(sensor, 1);
  const View view(sensor, times, any.states);
  const auto direction = unproject(sensor.camera.optics, pixel);
  return view.observer(times.middle).position_m +
         view.camera_from_gcrs(times.middle).inverse() * *direction * 4e7;
}

TEST(Crossings, RisingOverTheHorizonWithinAnExposureLeavesTheLightFromThen) {
  const std::string large =
      "    attitude: sun_tracking\n    geometry: {model: sphere, radius_m: 1000, facets: 720, "
      "material: white-paint}\n";
  for (const std::string& target : {point, large}) {
    const Vec<Gcrs> at = behind_pixel({127.5, 127.5});  // elevation 0 in mid exposure
    const auto frame = Stage(on_ground(at, target)).frame();
    const Truth& truth = truth_named(frame, "target");
    EXPECT_EQ(truth.resolved, target == large);
    const double full_e = frame.header.exposure_s *
                          light_of_magnitude(truth.true_magnitude - frame.header.zero_point_mag);
    EXPECT_NEAR(truth.rendered_signal_e / full_e, 0.5, 0.01) << truth.resolved;
  }
}

TEST(Crossings, TheFramesEdgeWithinAnExposureLeavesTheLightThatFellInside) {
  for (const double x_px : {-0.5, 255.5}) {
    const Vec<Gcrs> at = behind_pixel({x_px, 20});
    const auto frame = Stage(on_ground(at, point)).frame();
    const Truth& truth = truth_named(frame, "target");
    EXPECT_TRUE(truth.in_frame);
    EXPECT_FALSE(truth.whole);
    const double full_e = frame.header.exposure_s *
                          light_of_magnitude(truth.true_magnitude - frame.header.zero_point_mag);
    EXPECT_NEAR(truth.rendered_signal_e / full_e, 0.5, 0.02) << x_px;
  }
}

// In 10 s the object moves by 36 px along the columns: within 18 px of the edges one end is
// outside.
TEST(Crossings, WhatLeavesOrEntersTheFrameIsNotWhole) {
  for (const double x_px : {8.0, 100.0, 247.0}) {
    const auto frame = Stage(on_ground(behind_pixel({x_px, 20}), point)).frame();
    const Truth& truth = truth_named(frame, "target");
    EXPECT_TRUE(truth.in_frame) << x_px;
    EXPECT_EQ(truth.whole, x_px == 100.0) << x_px;
  }
}

/// Directions of a grid of pixels by the frame's own plate solution.
std::vector<Vec<Gcrs>> directions(const std::string& pointing) {
  std::string text = on_ground({4.2e7, 0, 0}, point);
  const std::string east = "{azimuth_deg: 90, elevation_deg: 0}";
  text.replace(text.find(east), east.size(), pointing);
  const auto frame = Stage(text).frame();
  std::vector<Vec<Gcrs>> all;
  for (const double x : {0.0, 128.0, 255.0})
    for (const double y : {0.0, 128.0, 255.0})
      all.push_back(wcs_direction(frame.header.wcs, {x, y}));
  return all;
}

// 1 mdeg on: through azimuth 360 deg, right ascension 24 h, the pole and the zenith every pixel
// turns by that, no more.
TEST(Crossings, PointingThroughWrapsPolesAndTheZenithIsContinuous) {
  const std::pair<std::string, std::string> steps[] = {
      {"{azimuth_deg: 359.9995, elevation_deg: 30}", "{azimuth_deg: 0.0005, elevation_deg: 30}"},
      {"{ra_deg: 359.9995, dec_deg: 20}", "{ra_deg: 0.0005, dec_deg: 20}"},
      {"{ra_deg: 40, dec_deg: 89.999}", "{ra_deg: 40, dec_deg: 90}"},
      {"{azimuth_deg: 77, elevation_deg: 89.999}", "{azimuth_deg: 77, elevation_deg: 90}"},
  };
  for (const auto& [before, after] : steps) {
    const auto a = directions(before), b = directions(after);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_LT(angle_rad(a[i], b[i]), 1.1e-3 * deg) << before << " " << i;
      EXPECT_GT(angle_rad(a[i], b[i]), 0.8e-3 * deg) << before << " " << i;
    }
  }
}

}  // namespace
}  // namespace dmise::test
