#include <cmath>

#include "core/base/units.h"
#include "core/detection/detection_lines.h"
#include "core/wcs/wcs.h"
#include "tests/pipeline/wiring.h"

// Frames whose rows are exposed one after another.
namespace dmise {
namespace {

constexpr int columns = 200, rows = 160;

std::string detector(double row_time_us) {
  return "full_well_e: 1.0e+9, gain_e_per_dn: 1, row_time_us: " + std::to_string(row_time_us);
}

/// A camera that stands in space and looks north, and a thing 100 km before it: 0.1 px a metre.
std::string passing(double row_time_us, const Vec<Enu>& at_start, const Vec<Enu>& speed,
                    const std::string& effects = "", int height = rows) {
  const Vec<Enu> first = at_start - speed;  // the exposure begins at 1 s
  char objects[400];
  std::snprintf(objects, sizeof objects,
                "objects:\n"
                "  - {name: eye, motion: {enu: {position_m: [0, 0, 1e5]}}}\n"
                "  - {name: thing, radius_m: 20, motion: {enu: {position_m: [%.3f, 1e5, %.3f], "
                "velocity_m_per_s: [%.3f, 0, %.3f]}}}\n",
                first.x, 1e5 + first.z, speed.x, speed.z);
  return test::scenario(
      "2018-01-21T18:00:00Z", 10, "platform: eye",
      test::camera(columns, height, 0.1, detector(row_time_us), ", psf_fwhm_px: 2"),
      "{enu: {look: [0, 1, 0], up: [0, 0, 1]}}", 0.1, 5,
      ", first_exposure_s: 1, effects: {" + test::noiseless +
          ", annual_aberration: off, diurnal_aberration: off, light_time: off, shadow: off, "
          "earth_occultation: off" +
          effects + "}",
      ", origin: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}", objects);
}

struct Light {
  double sum = 0, x = 0, y = 0, rms_x = 0, rms_y = 0;
};

Light light_of(const CountImage& counts) {
  Light l;
  double xx = 0, yy = 0;
  for (int y = 0; y < counts.rows; ++y)
    for (int x = 0; x < counts.columns; ++x) {
      const double c = counts.at(x, y);
      l.sum += c;
      l.x += c * x;
      l.y += c * y;
      xx += c * x * x;
      yy += c * y * y;
    }
  l.x /= l.sum;
  l.y /= l.sum;
  l.rms_x = std::sqrt(xx / l.sum - l.x * l.x);
  l.rms_y = std::sqrt(yy / l.sum - l.y * l.y);
  return l;
}

double middle_of_row(const CountImage& counts, int y) {
  double sum = 0, x_sum = 0;
  for (int x = 0; x < counts.columns; ++x) {
    sum += counts.at(x, y);
    x_sum += double(counts.at(x, y)) * x;
  }
  return x_sum / sum;
}

struct Case {
  const char* name;
  double row_time_us;
  Vec<Enu> at_start, speed;
  double start_s, end_s;
  Light light;  // its sum over that of row time 0
  std::vector<std::pair<int, double>> middles;
};

// Reference: numpy, row by row, tests/reference/rolling_shutter.py.
TEST(RollingShutter, DrawsAMovingPointRowByRowLikeNumpy) {
  for (const Case& c : {Case{"down",
                             500,
                             {-595, 0, 595},
                             {5000, 0, -3000},
                             1.011764706,
                             1.129411765,
                             {1.17647, 75.2941, 41.1765, 17.0071, 10.2440},
                             {{28, 53.3334}, {35, 65.0000}, {42, 76.6667}, {49, 88.3333}}},
                        Case{"up",
                             500,
                             {-595, 0, 195},
                             {5000, 0, 3000},
                             1.026086957,
                             1.113043478,
                             {0.86957, 74.7826, 39.1304, 12.5852, 7.5717},
                             {{35, 81.6667}, {42, 70.0000}, {49, 58.3335}}},
                        // All rows take three times as long as the exposure.
                        Case{"slow",
                             2000,
                             {-595, 0, 595},
                             {2000, 0, -1000},
                             1.05,
                             1.175,
                             {1.25, 62.5, 31.25, 7.2875, 3.7816},
                             {{31, 62.0000}}}}) {
    SCOPED_TRACE(c.name);
    test::Stage stage(passing(c.row_time_us, c.at_start, c.speed));
    test::Stage at_once(passing(0, c.at_start, c.speed));
    const auto frame = stage.frame();
    ASSERT_EQ(frame.truths.size(), 1u);
    const Truth& truth = frame.truths[0];
    EXPECT_NEAR(truth.start.seconds(), c.start_s, 1e-7);
    EXPECT_NEAR(truth.end.seconds(), c.end_s, 1e-7);
    EXPECT_NEAR(truth.middle.seconds(), (c.start_s + c.end_s) / 2, 1e-7);
    const auto pixel = [&](double t) {
      return PixelPosition{99.5 + 0.1 * (c.at_start.x + c.speed.x * (t - 1)),
                           79.5 - 0.1 * (c.at_start.z + c.speed.z * (t - 1))};
    };
    EXPECT_NEAR(truth.start_x_px, pixel(c.start_s).x_px, 1e-3);
    EXPECT_NEAR(truth.start_y_px, pixel(c.start_s).y_px, 1e-3);
    EXPECT_NEAR(truth.end_x_px, pixel(c.end_s).x_px, 1e-3);
    EXPECT_NEAR(truth.end_y_px, pixel(c.end_s).y_px, 1e-3);
    const Light light = light_of(frame.counts), whole = light_of(at_once.frame().counts);
    EXPECT_NEAR(light.sum / whole.sum, c.light.sum, 5e-4 * c.light.sum);
    // Its phase changes by up to 0.3 deg: the light of a trail is off its middle by the square of
    // its length.
    const PixelPosition middle = pixel(1.05);
    const double longer = c.light.sum * c.light.sum;
    EXPECT_NEAR(light.x - longer * (whole.x - middle.x_px), c.light.x, 0.01);
    EXPECT_NEAR(light.y - longer * (whole.y - middle.y_px), c.light.y, 0.01);
    // The blur is exposed as its centre: it is not stretched by the rows' delays.
    EXPECT_NEAR(light.rms_x, c.light.rms_x, 0.01 * c.light.rms_x);
    EXPECT_NEAR(light.rms_y, c.light.rms_y, 0.02 * c.light.rms_y);
    for (const auto& [row, x] : c.middles)  // away from the ends
      EXPECT_NEAR(middle_of_row(frame.counts, row), x, 0.01) << row;
  }
}

// It comes from above the frame at 1.25 times the shutter's speed, is exposed until it has
// overtaken the edge that opens, and then is in rows that are not open yet. Its blur is exposed as
// its centre, which near the meeting is off by some pixels.
TEST(RollingShutter, AFasterPointOvertakesIt) {
  const Vec<Enu> at_start{-595, 0, 995}, speed{3000, 0, -25000};
  test::Stage stage(passing(500, at_start, speed)), at_once(passing(0, at_start, speed));
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  EXPECT_NEAR(frame.truths[0].end.seconds(), 1.04, 1e-6);  // where -20 + 2500 s is 2000 s
  const Light light = light_of(frame.counts), whole = light_of(at_once.frame().counts);
  EXPECT_NEAR(light.sum / whole.sum, 0.50312, 0.01);
  EXPECT_NEAR(light.x, 47.1847, 0.1);
  EXPECT_NEAR(light.y, 39.8319, 1.0);
  EXPECT_NEAR(middle_of_row(frame.counts, 42), 47.44, 0.01);
}

// One that runs along with the shutter's edge is not drawn forever.
TEST(RollingShutter, APointOfTheShuttersSpeedHasFiniteLight) {
  test::Stage stage(passing(500, {-595, 0, 695}, {3000, 0, -20000}));
  const auto frame = stage.frame();
  const Light light = light_of(frame.counts);
  EXPECT_TRUE(light.sum == 0.0 || std::isfinite(light.x));
  for (const Truth& truth : frame.truths) EXPECT_LT(truth.start, truth.end);
}

TEST(RollingShutter, OfNoRowTimeOrOneRowIsNone) {
  const Vec<Enu> at_start{-595, 0, 595}, speed{5000, 0, -3000};
  test::Stage zero(passing(0, at_start, speed)),
      off(passing(500, at_start, speed, ", rolling_shutter: off"));
  const auto frame = zero.frame(), switched_off = off.frame();
  EXPECT_EQ(frame.counts.pixels, switched_off.counts.pixels);
  EXPECT_EQ(frame.truths.at(0).start, sim_seconds(1));
  EXPECT_EQ(switched_off.truths.at(0).start, sim_seconds(1));
  EXPECT_EQ(switched_off.header.detector->row_time_us, 0.0);

  const Vec<Enu> along{5000, 0, 0};
  test::Stage rolls(passing(1e5, {-595, 0, 0}, along, "", 1));
  test::Stage still(passing(0, {-595, 0, 0}, along, "", 1));
  const auto row = rolls.frame(), same = still.frame();
  EXPECT_GT(light_of(row.counts).sum, 0.0);
  EXPECT_EQ(row.counts.pixels, same.counts.pixels);
}

// The last row must have been read before the run ends.
TEST(RollingShutter, FramesEndWithTheirLastRow) {
  const Vec<Enu> still{};
  const auto frames = [&](double row_time_us) {
    test::Stage stage(passing(row_time_us, {}, still));
    return frames_within(stage.scenario.sensors[0], sim_seconds(6.35));
  };
  EXPECT_EQ(frames(0), 2u);            // the second ends at 6.1 s
  EXPECT_EQ(frames(250e3 / 159), 2u);  // at 6.35 s
  EXPECT_EQ(frames(251e3 / 159), 1u);
}

TEST(RollingShutter, ThatOutlastsTheRunOrATurnIsRefused) {
  const auto complaint = [](const std::string& yaml) -> std::string {
    try {
      test::Stage stage(yaml);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  // 160 rows of 0.06 s end 9.6 s after the first one.
  EXPECT_NE(complaint(passing(6e4, {}, {}))
                .find("exposure_s: the first exposure of the last row ends after the run does"),
            std::string::npos);
  std::string turning = passing(5e4, {}, {});
  const std::string fixed = "{enu: {look: [0, 1, 0], up: [0, 0, 1]}}";
  turning.replace(turning.find(fixed), fixed.size(),
                  "{ra_deg: 30, dec_deg: 40, ra_rate_deg_per_s: 2}");
  EXPECT_NE(complaint(turning).find("exposure_s: the camera must turn by no more than 10 deg until "
                                    "the last row is exposed"),
            std::string::npos);
}

// A camera in space that turns by 0.05 deg/s down the image, 8.73 px/s of its 1e4: a star goes up.
// The world coordinates are of each row's own time.
TEST(RollingShutter, StarsAreInTheirRowsTimeAndTheWcsToo) {
  const std::string platform =
      "objects:\n  - name: platform\n    motion: {fixed: {gcrs_m: [42000000, 1000000, 2000000]}}\n";
  const auto scene = [&](double row_time_us, const std::string& more) {
    return test::scenario("2018-01-21T00:15:00Z", 20, "platform: platform",
                          test::camera(600, 1000, 0.1, detector(row_time_us)),
                          "{ra_deg: 30, dec_deg: 40, dec_rate_deg_per_s: -0.05}", 0.5, 5,
                          ", effects: {" + test::noiseless +
                              ", annual_aberration: off, diurnal_aberration: off, "
                              "light_deflection: off, earth_occultation: off" +
                              more + "}",
                          "", platform + test::with_stars);
  };
  const std::string stars =
      "ra_deg,dec_deg,mag_v,bv\n30,42,1,0.65\n30.5,40,1,0.65\n29.5,38,1,0.65\n";
  for (const char* drawn : {"", ", integration: snapshots, snapshots: 5"}) {
    test::Stage rolls(scene(1000, drawn), stars), at_once(scene(0, drawn), stars);
    const auto frame = rolls.frame(), whole = at_once.frame();
    ASSERT_EQ(frame.stars.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const StarTruth &star = frame.stars[i], &same = whole.stars[i];
      const double rate_px_per_s = (same.end.y_px - same.start.y_px) / 0.5;
      EXPECT_NEAR(rate_px_per_s, -8.73, 0.2);
      const double epsilon = rate_px_per_s * 1e-3;
      EXPECT_NEAR(star.start.y_px, same.start.y_px / (1 - epsilon), 0.01);
      EXPECT_NEAR(star.middle.y_px, same.middle.y_px / (1 - epsilon), 0.01);
      EXPECT_NEAR(star.end.y_px, same.end.y_px / (1 - epsilon), 0.01);
      EXPECT_NEAR(star.signal_e, same.signal_e / (1 - epsilon), 1e-3 * same.signal_e);
      EXPECT_GT(std::abs(star.middle.y_px - same.middle.y_px), 1.0);
      const PixelPosition at = test::centroid(frame.counts, star.middle, 20);
      EXPECT_NEAR(at.y_px, star.middle.y_px, 0.02);
    }
    for (const auto& [ra_deg, dec_deg] : {std::pair{30.0, 42.0}, {30.5, 40.0}, {29.5, 38.0}}) {
      const auto told =
          wcs_pixel(frame.header.wcs, from_spherical<Gcrs>(ra_deg * deg, dec_deg * deg));
      ASSERT_TRUE(told);
      double nearest_px = 1e9;
      for (const StarTruth& star : frame.stars)
        nearest_px = std::min(
            nearest_px, std::hypot(told->x_px - star.middle.x_px, told->y_px - star.middle.y_px));
      EXPECT_LT(nearest_px, 0.02);
    }
  }
}

// The clock of a detection is that of its row, from the frame and its header alone.
TEST(RollingShutter, DetectionsHaveTheTimeOfTheirRow) {
  std::string scene = passing(500, {-595, 0, -205}, {300, 0, -100});
  const auto replace = [&](const std::string& from, const std::string& to) {
    const auto at = scene.find(from);
    ASSERT_NE(at, std::string::npos);
    scene.replace(at, from.size(), to);
  };
  replace("gain_e_per_dn: 1,", "gain_e_per_dn: 20, bias_dn: 1000, read_noise_e: 5,");
  replace(", read_noise: off", "");
  replace(", quantisation: off", "");
  test::Stage stage(scene);
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  ASSERT_EQ(frame.detections.size(), 1u);
  const Detection& d = frame.detections[0];
  EXPECT_GT((d.time - frame.header.middle).seconds(), 0.04);
  EXPECT_NEAR((d.time - frame.truths[0].middle).seconds(), 0.0, 1e-3);
  EXPECT_EQ(utc_in_frame(frame.header, d.time).substr(0, 20), "2018-01-21T18:00:01.");
  EXPECT_EQ(utc_in_frame(frame.header, frame.header.middle + SimTime{12345000}).substr(19, 8),
            ".062345Z");
  EXPECT_THROW(utc_in_frame(frame.header, frame.header.middle + SimTime{12345001}), Error);
}

}  // namespace
}  // namespace dmise
