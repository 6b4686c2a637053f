#include <cstdio>

#include "core/sky/bodies/shadow.h"
#include "sensors/render/resolution.h"
#include "tests/pipeline/shape_scenes.h"

namespace dmise::test {
namespace {

/// Objects on circular orbits before a camera on one.
std::string orbiting(const std::string& name, double true_anomaly_deg, const std::string& keys,
                     double semi_major_axis_m = 7178137, double raan_deg = 0) {
  return "  - name: " + name +
         "\n    motion: {two_body: {semi_major_axis_m: " + std::to_string(semi_major_axis_m) +
         ", eccentricity: 0, inclination_deg: 98.6, raan_deg: " + std::to_string(raan_deg) +
         ", true_anomaly_deg: " + std::to_string(true_anomaly_deg) + "}}\n" + keys;
}

std::string orbit_scenario(const std::string& objects, const std::string& sensor,
                           const std::string& optics, double gain_e_per_dn,
                           double platform_anomaly_deg = 0, const std::string& effects = "") {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 2, seed: "
         "1}\nobjects:\n" +
         orbiting("platform", platform_anomaly_deg, "") + objects +
         "sensors:\n  - name: eye\n    platform: platform\n    cadence_s: 15\n    sky: space\n"
         "    effects: {" +
         effects + "photon_noise: off, read_noise: off, dark_current: off, sky: off}\n" + sensor +
         "    camera:\n      optics: " + optics +
         "\n      detector: {full_well_e: 1.0e+9, gain_e_per_dn: " + std::to_string(gain_e_per_dn) +
         ", adc_bits: 16}\n      band: {name: V, centre_m: 0.55e-6, width_m: 0.1e-6}\n";
}

/// Counts in parts of the way from start to end, within 8 px of it.
std::vector<double> profile(const CountImage& counts, const Truth& truth, int parts) {
  const double dx = truth.end_x_px - truth.start_x_px, dy = truth.end_y_px - truth.start_y_px;
  const double length = std::hypot(dx, dy);
  std::vector<double> sum(std::size_t(parts), 0.0);
  for (int y = 0; y < counts.rows; ++y)
    for (int x = 0; x < counts.columns; ++x) {
      const double u = ((x - truth.start_x_px) * dx + (y - truth.start_y_px) * dy) / length;
      const double v = ((y - truth.start_y_px) * dx - (x - truth.start_x_px) * dy) / length;
      if (std::abs(v) < 8 && u >= 0 && u < length)
        sum[std::size_t(u / length * parts)] += counts.at(x, y);
    }
  return sum;
}

// A box of 0.3 pixels: as a point it is off by less than its radius, with the same light.
TEST(Resolved, FromWhichSizeOnAShapeIsNoPointIsALevel) {
  const auto truth_at = [](const std::string& level) {
    return Stage(orbit_scenario(
                     orbiting("target", 2.6,
                              "    attitude: sun_tracking\n    geometry: {model: box, size_m: "
                              "[2.8, 2.8, 2.8], material: white-paint}\n",
                              6978137),
                     "    pointing: {target: target}\n    exposure_s: 2\n",
                     "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 0.4, "
                     "aperture_m: 0.04, psf_fwhm_px: 1.5}",
                     0.1, 0, "resolved_shapes: " + level + ", "))
        .frame()
        .truths.at(0);
  };
  const Truth point = truth_at("0.5px"), shape = truth_at("0.2px"), usual = truth_at("0.05px");
  EXPECT_FALSE(point.resolved);
  EXPECT_TRUE(shape.resolved);
  EXPECT_EQ(shape.rendered_x_px, usual.rendered_x_px);
  const double off_px = std::hypot(point.rendered_x_px - shape.rendered_x_px,
                                   point.rendered_y_px - shape.rendered_y_px);
  EXPECT_GT(off_px, 0.01);
  EXPECT_LT(off_px, 0.3);
  EXPECT_NEAR(point.rendered_signal_e / shape.rendered_signal_e, 1.0, 5e-3);
}

// A box of 0.06 pixels, its lit half off its middle by 0.015, that moves over some hundred of them
// against the path of a point.
TEST(Resolved, AMovingObjectLeavesAStreakAsEvenAsAPointDoes) {
  const auto streak = [](const std::string& size, double gain) {
    return orbit_scenario(
        orbiting("target", 2.6,
                 "    attitude: sun_tracking\n    geometry: {model: box, size_m: [" + size +
                     "], material: white-paint}\n",
                 6978137),
        "    pointing: {target: target, tracking: sidereal}\n    exposure_s: 8\n",
        "{columns: 768, rows: 768, pixel_pitch_m: 1.0e-5, focal_length_m: 0.4, "
        "aperture_m: 0.04, psf_fwhm_px: 1.5}",
        gain);
  };
  Stage large(streak("0.6, 0.6, 0.6", 0.00625)), small(streak("0.24, 0.24, 0.24", 0.001));
  const auto a = large.frame(), b = small.frame();
  const Truth &box = a.truths.at(0), &point = b.truths.at(0);
  ASSERT_TRUE(box.resolved);
  ASSERT_FALSE(point.resolved);
  const double length_px = std::hypot(box.end_x_px - box.start_x_px, box.end_y_px - box.start_y_px);
  EXPECT_GT(length_px, 100.0);
  EXPECT_NEAR(box.rendered_signal_e / point.rendered_signal_e / 6.25, 1.0, 5e-3);
  EXPECT_NEAR(box.rendered_x_px, point.rendered_x_px, 0.02);
  EXPECT_NEAR(box.rendered_y_px, point.rendered_y_px, 0.02);
  const int parts = int(length_px / 3.0);
  const auto of_box = profile(a.counts, box, parts), of_point = profile(b.counts, point, parts);
  const double box_sum = std::accumulate(of_box.begin() + 1, of_box.end() - 1, 0.0);
  const double point_sum = std::accumulate(of_point.begin() + 1, of_point.end() - 1, 0.0);
  for (std::size_t i = 1; i + 1 < of_box.size(); ++i)
    EXPECT_NEAR(of_box[i] / box_sum / (of_point[i] / point_sum), 1.0, 0.03) << i;
}

// A small frame sees the middle of what a larger one does of a ball of some 800 pixels.
TEST(Resolved, OfAnObjectLargerThanTheFrameTheFrameSeesItsPart) {
  const Sight sight = lit_sight();
  const auto frame = [&](int side) {
    const std::string n = std::to_string(side);
    return Stage(text_of({.objects = shape_at("ball", sight, 2e4, 0, 0,
                                              "    attitude: nadir\n    geometry: {model: sphere, "
                                              "radius_m: 80, facets: 320, material: grey}\n"),
                          .pointing = "{target: ball}",
                          .optics = "{columns: " + n + ", rows: " + n +
                                    ", pixel_pitch_m: 1.0e-5, focal_length_m: 1, aperture_m: 0.05}",
                          .gain_e_per_dn = 30}))
        .frame();
  };
  const auto part = frame(64), whole = frame(256);
  EXPECT_GT(whole.counts.at(128, 128), 100);
  for (const int x : {0, 20, 32, 50, 63})
    for (const int y : {0, 31, 63})
      EXPECT_NEAR(part.counts.at(x, y) / double(whole.counts.at(x + 96, y + 96)), 1.0, 0.02)
          << x << " " << y;
}

long memory_kb(const char* what) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(what)) return std::stol(line.substr(line.find(':') + 1));
  return 0;
}

// A ball of 8,000 pixels before a frame of 512: what is drawn is bounded by the frame.
TEST(Resolved, AnObjectFarLargerThanTheFrameTakesNoMoreMemoryThanTheFrame) {
  const Sight sight = lit_sight();
  Stage stage(text_of({.objects = shape_at("ball", sight, 2e4, 0, 0,
                                           "    attitude: nadir\n    geometry: {model: sphere, "
                                           "radius_m: 800, facets: 2000, material: grey}\n"),
                       .pointing = "{target: ball}",
                       .optics = "{columns: 512, rows: 512, pixel_pitch_m: 1.0e-5, "
                                 "focal_length_m: 1, aperture_m: 0.05}",
                       .gain_e_per_dn = 30}));
  stage.frame();  // loads the renderer
  std::ofstream("/proc/self/clear_refs") << "5";
  const long before_kb = memory_kb("VmRSS");
  const auto frame = stage.frame();
  EXPECT_GT(frame.counts.at(256, 256), 100);
  EXPECT_GT(frame.counts.at(0, 0), 100);
  EXPECT_LT(memory_kb("VmHWM") - before_kb, 100 * 1024);
}

// On either side of the switch, 0.05 pixels of radius, both ways of drawing give the same light at
// the same place to the error that is stated for it.
TEST(Resolved, AtTheSwitchBothWaysGiveTheSameLightAtTheSamePlace) {
  const Sight sight = lit_sight();
  Truth truth[2];
  int k = 0;
  const double range_m = 1e4, limit_m = 0.05 * 1e-5 * range_m;  // half the diagonal of the box
  for (const double factor : {0.999, 1.001}) {
    const double side_m = factor * limit_m * 2 / std::sqrt(3.0);
    char size[96];
    std::snprintf(size, sizeof size, "[%.9f, %.9f, %.9f]", side_m, side_m, side_m);
    const auto frame =
        Stage(text_of({.objects = shape_at("box", sight, range_m, 0, 0,
                                           "    attitude: {inertial: {gcrs_from_body: [0.8, 0.2, "
                                           "-0.4, 0.4]}}\n    geometry: {model: box, size_m: " +
                                               std::string(size) + ", material: kapton}\n"),
                       .pointing = "{target: box}",
                       .optics = "{columns: 64, rows: 64, pixel_pitch_m: 1.0e-5, focal_length_m: "
                                 "1, aperture_m: 0.5, psf_fwhm_px: 1.2}"}))
            .frame();
    truth[k++] = truth_named(frame, "box");
  }
  ASSERT_FALSE(truth[0].resolved);
  ASSERT_TRUE(truth[1].resolved);
  const double growth = std::pow(1.001 / 0.999, 2);
  EXPECT_NEAR(truth[1].rendered_signal_e / truth[0].rendered_signal_e / growth, 1.0, 5e-3);
  EXPECT_NEAR(truth[1].rendered_x_px, truth[0].rendered_x_px, 0.05);
  EXPECT_NEAR(truth[1].rendered_y_px, truth[0].rendered_y_px, 0.05);
}

// Plates of 20 m and 2 cm beside each other: through the penumbra both dim alike, by the fraction
// of the Sun's disc that is told.
TEST(Resolved, ThePenumbraDimsAShapeAndAPointAlike) {
  const std::string facing_sun = "    attitude: sun_tracking\n    geometry: {model: box, size_m: ";
  const auto stage_at = [&](double anomaly_deg) {
    return orbit_scenario(
        orbiting("large", anomaly_deg + 0.16, facing_sun + "[2, 2, 2], material: white-paint}\n") +
            orbiting("small", anomaly_deg + 0.161,
                     facing_sun + "[0.002, 0.002, 0.002], material: white-paint}\n", 7178137,
                     0.0003),
        "    pointing: {target: large}\n    exposure_s: 0.01\n",
        "{columns: 256, rows: 256, pixel_pitch_m: 1.0e-5, focal_length_m: 0.5, aperture_m: 0.2}",
        10, anomaly_deg);
  };
  constexpr double penumbra_deg = 122.5;  // where on this orbit the light fades
  const auto lit = Stage(stage_at(penumbra_deg - 1)).frame();
  double last_sunlit = 2;
  for (const double step : {-0.3, -0.2, -0.1, 0.0, 0.1, 0.2}) {
    const auto frame = Stage(stage_at(penumbra_deg + step)).frame();
    const Truth &large = truth_named(frame, "large"), &small = truth_named(frame, "small");
    ASSERT_TRUE(large.resolved);
    ASSERT_FALSE(small.resolved);
    EXPECT_LE(large.sunlit, last_sunlit);
    last_sunlit = large.sunlit;
    if (large.sunlit < 0.01) break;
    EXPECT_NEAR(large.rendered_signal_e / magnitude_e(frame, "large"), 1.0, 1e-2) << step;
    EXPECT_NEAR(small.rendered_signal_e / magnitude_e(frame, "small"), 1.0, 1e-2) << step;
    EXPECT_NEAR(large.rendered_signal_e / truth_named(lit, "large").rendered_signal_e,
                small.rendered_signal_e / truth_named(lit, "small").rendered_signal_e, 0.02)
        << step;
  }
}

// A sheet of 1 mm from its edge, and a boom of 2 mm that no sample meets.
TEST(Resolved, AnObjectThinnerThanTheSamplesHasItsLight) {
  const Sight sight = lit_sight();
  for (const auto& [size, attitude] :
       {std::pair{"[0.001, 1.5, 1.5]", facing(sight)},
        {"[0.002, 3, 0.002]", facing(sight)},
        {"[0.002, 0.002, 3]",
         "    attitude: {inertial: {gcrs_from_body: [0.8, 0.2, -0.4, 0.4]}}\n"}})
    for (const double range_m : {250.0, 1250.0, 6000.0}) {
      const auto frame =
          Stage(text_of({.objects = shape_at("thin", sight, range_m, 0, 0,
                                             attitude + "    geometry: {model: box, size_m: " +
                                                 size + ", material: white-paint}\n"),
                         .pointing = "{target: thin}",
                         .optics = "{columns: 192, rows: 192, pixel_pitch_m: 1.0e-5, "
                                   "focal_length_m: 0.1, aperture_m: 0.01}"}))
              .frame();
      const Truth& truth = truth_named(frame, "thin");
      EXPECT_TRUE(truth.resolved);
      EXPECT_TRUE(truth.in_frame);
      // Its near end is nearer than its middle, of which the magnitude is.
      EXPECT_NEAR(truth.rendered_signal_e / magnitude_e(frame, "thin"), 1.0,
                  std::max(5e-3, 3.0 / range_m))
          << size << " at " << range_m << " m";
    }
}

// Half of it lies beside the frame: half of its light, no more.
TEST(Resolved, AnObjectAcrossTheFramesEdgeGivesTheFrameItsPart) {
  const Sight sight = lit_sight();
  const auto [ra, dec] = to_spherical(sight.line);
  char pointing[96];
  std::snprintf(pointing, sizeof pointing, "{ra_deg: %.9f, dec_deg: %.9f}", ra / deg, dec / deg);
  const auto signal_e = [&](double aside_px) {
    const auto frame =
        Stage(text_of({.objects = shape_at("plate", sight, 1e4, aside_px * 0.1, 0,
                                           facing(sight) + "    geometry: {model: plate, "
                                                           "size_m: [4, 4], front: "
                                                           "white-paint, back: white-paint}\n"),
                       .pointing = pointing,
                       .optics = "{columns: 127, rows: 127, pixel_pitch_m: 1.0e-5, "
                                 "focal_length_m: 1, aperture_m: 0.2, psf_fwhm_px: "
                                 "1}",
                       .effects = "sky: off, diurnal_aberration: off, light_time: "
                                  "off, "}))
            .frame();
    return frame.truths.empty() ? 0.0 : frame.truths[0].rendered_signal_e;
  };
  const double whole = signal_e(0);
  EXPECT_NEAR(signal_e(63.5) / whole, 0.5, 0.02);  // its middle on the edge
  EXPECT_NEAR(signal_e(-63.5) / whole, 0.5, 0.02);
  EXPECT_NEAR(signal_e(73.5) / whole, 0.25, 0.02);
  EXPECT_EQ(signal_e(95), 0.0);
}

TEST(Resolved, ACameraInsideAnObjectIsAnErrorThatNamesIt) {
  const Sight sight = lit_sight();
  Stage stage(text_of({.objects = shape_at("hall", sight, 5, 0, 0,
                                           "    attitude: nadir\n    geometry: {model: box, "
                                           "size_m: [20, 20, 20], material: grey}\n"),
                       .pointing = "{target: hall}"}));
  try {
    stage.frame();
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "object hall: camera is inside the object's bounding box");
  }
}

}  // namespace
}  // namespace dmise::test
