#include <cmath>
#include <numeric>

#include "core/base/units.h"
#include "core/products/product_json.h"
#include "core/wcs/wcs.h"
#include "tests/pipeline/sky_targets.h"
#include "tests/pipeline/wiring.h"

// Frames of sensors that do not know where they point and what time it is: light falls where the
// camera truly looks when it truly does, and headers say what the sensor believes.
namespace dmise {
namespace {

/// Directions are those of the catalogue.
const std::string geometric =
    test::noiseless +
    ", annual_aberration: off, diurnal_aberration: off, light_deflection: off, light_time: off, "
    "refraction: off, extinction: off, clouds: off, earth_occultation: off, shadow: off";

const std::string platform =
    "objects:\n  - name: platform\n    motion: {fixed: {gcrs_m: [42000000, 1000000, 2000000]}}\n";
const std::string start = "2018-01-21T00:15:00Z";

/// A camera in space of 1e4 pixels of focal length that looks at (30, 40) deg, with `more` keys.
std::string among_stars(const std::string& more, double exposure_s = 2, double duration_s = 20) {
  return test::scenario(start, duration_s, "platform: platform", test::camera(1200, 1000, 0.1),
                        "{ra_deg: 30, dec_deg: 40}", exposure_s, 5,
                        more + ", effects: {" + geometric + "}", "", platform + test::with_stars);
}

struct Star {
  double ra_deg, dec_deg;
  PixelPosition told, truly;
};

std::string csv(const std::vector<Star>& stars) {
  std::string text = "ra_deg,dec_deg,mag_v,bv\n";
  for (const Star& star : stars) {
    char line[64];
    std::snprintf(line, sizeof line, "%.9f,%.9f,1,0.65\n", star.ra_deg, star.dec_deg);
    text += line;
  }
  return text;
}

const StarTruth* drawn_near(const FrameProducts& frame, PixelPosition at) {
  for (const StarTruth& star : frame.stars)
    if (std::hypot(star.middle.x_px - at.x_px, star.middle.y_px - at.y_px) < 3.0) return &star;
  return nullptr;
}

void expect_near(PixelPosition a, PixelPosition b, double tolerance_px) {
  EXPECT_NEAR(a.x_px, b.x_px, tolerance_px);
  EXPECT_NEAR(a.y_px, b.y_px, tolerance_px);
}

// Reference: astropy's spherical trigonometry, tests/reference/pointing_error.py.
TEST(InstrumentErrors, ABiasMovesTheStarsAndTheHeaderStays) {
  const std::pair<std::string, std::vector<Star>> cases[] = {
      {"[1.2, -0.7, 0]",
       {{30.0, 40.0, {599.50000, 499.50000}, {390.01944, 621.69700}},
        {31.2, 40.9, {441.16635, 341.32167}, {231.60281, 463.45871}},
        {28.9, 38.8, {749.16225, 708.06970}, {539.72305, 830.31220}},
        {32.4, 39.1, {274.31580, 652.29609}, {64.36607, 774.72386}}}},
      {"[0, 0, 5]",
       {{30.0, 40.0, {599.50000, 499.50000}, {599.50000, 499.50000}},
        {31.2, 40.9, {441.16635, 341.32167}, {427.98271, 355.72327}},
        {28.9, 38.8, {749.16225, 708.06970}, {766.77078, 694.23211}},
        {32.4, 39.1, {274.31580, 652.29609}, {288.87028, 680.05632}}}},
      {"[-1, 1.5, 5]",
       {{30.0, 40.0, {599.50000, 499.50000}, {750.60132, 223.39417}},
        {31.2, 40.9, {441.16635, 341.32167}, {578.98586, 79.50738}},
        {28.9, 38.8, {749.16225, 708.06970}, {917.88575, 418.20655}},
        {32.4, 39.1, {274.31580, 652.29609}, {440.04522, 403.99875}}}}};
  for (const auto& [bias, stars] : cases) {
    test::Stage stage(among_stars(", pointing_error: {bias_deg: " + bias + "}"), csv(stars));
    test::Stage unbiased(among_stars(""), csv(stars));
    const auto frame = stage.frame();
    EXPECT_TRUE(frame.header == unbiased.frame().header);
    for (const Star& star : stars) {
      const auto told =
          wcs_pixel(frame.header.wcs, from_spherical<Gcrs>(star.ra_deg * deg, star.dec_deg * deg));
      ASSERT_TRUE(told);
      expect_near(*told, star.told, 1e-3);
      const StarTruth* drawn = drawn_near(frame, star.truly);
      ASSERT_TRUE(drawn) << bias << " " << star.ra_deg;
      expect_near(drawn->middle, star.truly, 2e-5);
      expect_near(test::centroid(frame.counts, star.truly, 8), star.truly, 0.01);
    }
  }
}

// 20 and -10 arcsec/s over 5 s are 4.85 and 2.42 px: the light of an even line has a variance of
// length^2 / 12. The second frame is farther by another 5 s of it.
TEST(InstrumentErrors, ADriftSmearsByRateTimesExposure) {
  const std::string drift = ", pointing_error: {drift_arcsec_per_s: [20, -10, 0]}";
  const std::vector<Star> star{{30, 40, {}, {}}};
  test::Stage stage(among_stars(drift, 5), csv(star)), still(among_stars("", 5), csv(star));
  const double x_px = 100 * arcsec * 1e4, y_px = -50 * arcsec * 1e4;
  const auto variances = [](const CountImage& counts) {
    const PixelPosition at = test::centroid(counts, {597, 501}, 20);
    double sum = 0, xx = 0, yy = 0;
    for (int y = 480; y < 520; ++y)
      for (int x = 575; x < 620; ++x) {
        sum += counts.at(x, y);
        xx += counts.at(x, y) * std::pow(x - at.x_px, 2);
        yy += counts.at(x, y) * std::pow(y - at.y_px, 2);
      }
    return PixelPosition{xx / sum, yy / sum};
  };
  const auto frame = stage.frame();
  const auto line = variances(frame.counts), point = variances(still.frame().counts);
  EXPECT_NEAR(line.x_px - point.x_px, x_px * x_px / 12, 0.02);
  EXPECT_NEAR(line.y_px - point.y_px, y_px * y_px / 12, 0.02);
  ASSERT_EQ(frame.stars.size(), 1u);
  expect_near(frame.stars[0].end - frame.stars[0].start, {-x_px, -y_px}, 1e-3);
  EXPECT_TRUE(frame.header == still.frame().header);
  const auto second = stage.frame(2);
  expect_near(second.stars.at(0).middle - frame.stars[0].middle, {-x_px, -y_px}, 1e-3);
}

/// A camera at Atlanta of 1e4 pixels of focal length, and a satellite that is at its zenith when
/// the run begins.
std::string below_a_satellite(const std::string& pointing, double first_s,
                              const std::string& more) {
  const test::SkyTarget overhead{.elevation_rad = 89.9 * deg, .altitude_m = 550e3};
  const std::string satellite =
      "objects:\n" + test::own_objects({overhead}, {33.777, -84.398, 300}, start);
  return test::scenario(
      start, 20, "site: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}",
      test::camera(1200, 1000, 0.1), pointing, 0.2, 5,
      ", first_exposure_s: " + std::to_string(first_s) + more + ", effects: {" + geometric + "}",
      "", satellite + test::with_stars);
}

const std::string no_star = csv({{0, -89, {}, {}}});  // a catalogue without a star in the field

const Truth& truth_of(const FrameProducts& frame) {
  if (frame.truths.size() != 1) throw std::runtime_error("not one truth");
  return frame.truths[0];
}

// A clock that is 2 s behind has the shutter opened 2 s late. At the zenith the satellite is
// further along its track by its rate times 2 s, stars by 30.08 arcsec times cos(dec) to the west.
TEST(InstrumentErrors, AClockMovesSatellitesByTheirRateAndStarsByTheEarthsTurn) {
  const std::vector<Star> stars{{39.0, 33.9, {}, {}}};
  test::Stage wrong(below_a_satellite("zenith", 0, ", clock_error: {offset_ms: -2000}"),
                    csv(stars));
  test::Stage right(below_a_satellite("zenith", 0, ""), csv(stars));
  test::Stage later(below_a_satellite("zenith", 2, ""), csv(stars));
  const auto frame = wrong.frame(), on_time = right.frame(), late = later.frame();
  EXPECT_TRUE(frame.header == on_time.header);
  EXPECT_EQ(frame.report.start, sim_seconds(0));
  EXPECT_EQ(frame.counts.pixels, late.counts.pixels);

  const Truth &moved = truth_of(frame), &told = truth_of(on_time);
  EXPECT_EQ(moved.start, sim_seconds(2));
  EXPECT_EQ(moved.end, sim_seconds(2.2));
  const PixelPosition before{told.middle_x_px, told.middle_y_px};
  const PixelPosition rate_px_per_s{(told.end_x_px - told.start_x_px) / 0.2,
                                    (told.end_y_px - told.start_y_px) / 0.2};
  const PixelPosition shift = PixelPosition{moved.middle_x_px, moved.middle_y_px} - before;
  EXPECT_GT(std::hypot(shift.x_px, shift.y_px), 200.0);
  EXPECT_NEAR(shift.x_px, 2 * rate_px_per_s.x_px, 0.01 * std::abs(shift.x_px) + 1);
  EXPECT_NEAR(shift.y_px, 2 * rate_px_per_s.y_px, 0.01 * std::abs(shift.y_px) + 1);

  ASSERT_EQ(frame.stars.size(), 1u);
  ASSERT_EQ(on_time.stars.size(), 1u);
  const PixelPosition turned = frame.stars[0].middle - on_time.stars[0].middle;
  EXPECT_NEAR(std::hypot(turned.x_px, turned.y_px),
              2 * 15.0411 * arcsec * std::cos(33.9 * deg) * 1e4, 0.01);
  EXPECT_GT(turned.x_px, 0.0);  // to the west, which is on the right
}

// The mount of a telescope is told axes of the Earth by the clock: stars that it tracks are off by
// what the Earth turns in the clock's error, and stand still.
TEST(InstrumentErrors, AMountByAWrongClockMissesItsStarsByTheEarthsTurn) {
  const std::vector<Star> stars{{33, 34, {}, {}}};
  test::Stage wrong(
      below_a_satellite("{ra_deg: 33, dec_deg: 34}", 5, ", clock_error: {offset_ms: 3000}"),
      csv(stars));
  const auto frame = wrong.frame();
  ASSERT_EQ(frame.stars.size(), 1u);
  const PixelPosition off = frame.stars[0].middle - PixelPosition{599.5, 499.5};
  EXPECT_NEAR(std::hypot(off.x_px, off.y_px), 3 * 15.0411 * arcsec * std::cos(34 * deg) * 1e4,
              0.02);
  expect_near(frame.stars[0].start, frame.stars[0].end, 1e-3);
  const auto told = wcs_pixel(frame.header.wcs, from_spherical<Gcrs>(33 * deg, 34 * deg));
  ASSERT_TRUE(told);
  expect_near(*told, {599.5, 499.5}, 1e-3);
}

// It follows where the satellite is by its clock.
TEST(InstrumentErrors, ATrackedSatelliteIsOffByItsRate) {
  test::Stage wrong(below_a_satellite("{target: t0}", 0, ", clock_error: {offset_ms: -100}"),
                    no_star);
  test::Stage right(below_a_satellite("{target: t0}", 0, ""), no_star);
  const Truth off = truth_of(wrong.frame()), on = truth_of(right.frame());
  EXPECT_NEAR(std::hypot(on.middle_x_px - 599.5, on.middle_y_px - 499.5), 0.0, 1e-3);
  // 0.1 s of its way as a fixed camera sees it: about 7.2 km/s at 550 km.
  const double away_px = std::hypot(off.middle_x_px - 599.5, off.middle_y_px - 499.5);
  test::Stage still(below_a_satellite("zenith", 0, ""), no_star);
  const Truth passing = truth_of(still.frame());
  const double rate_px_per_s =
      std::hypot(passing.end_x_px - passing.start_x_px, passing.end_y_px - passing.start_y_px) /
      0.2;
  EXPECT_NEAR(away_px, 0.1 * rate_px_per_s, 0.02 * away_px);
}

// The true attitude is in the truth: through it the truth's direction falls on the truth's pixel.
TEST(InstrumentErrors, TruthHasTheTrueAttitude) {
  test::Stage stage(
      below_a_satellite(
          "zenith", 1,
          ", clock_error: {offset_ms: 500}, pointing_error: {bias_deg: [0.3, 0.2, 10]}"),
      no_star);
  const auto frame = stage.frame();
  const Truth& truth = truth_of(frame);
  ASSERT_TRUE(truth.camera_from_gcrs);
  const auto camera = rotation_of<CameraFrame, Gcrs>(*truth.camera_from_gcrs);
  const Vec<CameraFrame> line =
      camera * from_spherical<Gcrs>(truth.true_ra_rad, truth.true_dec_rad);
  // Light time is off in these frames, and in the truth's directions with it.
  expect_near({599.5 + 1e4 * line.x / line.z, 499.5 + 1e4 * line.y / line.z},
              {truth.middle_x_px, truth.middle_y_px}, 1e-3);
  const UtcText utc = [](SimTime) { return std::string(); };
  EXPECT_NE(to_json(truth, utc).find("\"camera_from_gcrs\":["), std::string::npos);
  test::Stage exact(below_a_satellite("zenith", 1, ""), no_star);
  EXPECT_EQ(to_json(truth_of(exact.frame()), utc).find("camera_from_gcrs"), std::string::npos);
}

// A vibration of 0.4 Hz displaces exposures of 0.5 s, one of 40 Hz blurs them; both are 6 arcsec
// rms, 0.29 px. The truth and the header do not know of it.
TEST(InstrumentErrors, VibrationDisplacesBySlowAndBlursByFastFrequencies) {
  const auto scene = [](const std::string& hz) {
    return among_stars(", vibration: {sine_hz: [" + hz + "], sine_rms_arcsec: [60]}", 0.5, 200);
  };
  const std::vector<Star> star{{30, 40, {}, {}}};
  test::Stage slow(scene("0.4"), csv(star)), fast(scene("40.3"), csv(star));
  test::Stage still(among_stars("", 0.5, 200), csv(star));
  const double whole_px = 60 * arcsec * 1e4;
  const auto width_px2 = [](const CountImage& counts) {
    const PixelPosition at = test::centroid(counts, {599.5, 499.5}, 40);
    double sum = 0, squares = 0;
    for (int y = 460; y < 540; ++y)
      for (int x = 560; x < 640; ++x) {
        sum += counts.at(x, y);
        squares += counts.at(x, y) * (std::pow(x - at.x_px, 2) + std::pow(y - at.y_px, 2)) / 2;
      }
    return squares / sum;
  };
  const auto sharp = still.frame();
  double squares[2] = {};
  constexpr int frames = 30;
  for (std::uint32_t k = 1; k <= frames; ++k) {
    const auto frame = slow.frame(k);
    EXPECT_TRUE(k > 1 || frame.header.wcs == sharp.header.wcs);
    const PixelPosition off = frame.stars.at(0).middle - PixelPosition{599.5, 499.5};
    squares[0] += off.x_px * off.x_px / frames;
    squares[1] += off.y_px * off.y_px / frames;
  }
  // A sine at every 5 s is in phase: its amplitude at a phase of its own. The mean of 0.2 of a turn
  // is 0.935 of it.
  EXPECT_LT(std::sqrt(squares[0]), 1.001 * std::sqrt(2.0) * 0.935 * whole_px);
  EXPECT_GT(squares[0] + squares[1], 0.01);
  const double sinc = std::sin(pi * 0.2) / (pi * 0.2);
  EXPECT_NEAR(width_px2(slow.frame().counts) - width_px2(sharp.counts),
              whole_px * whole_px * (1 - sinc * sinc), 0.02 * whole_px * whole_px);
  const auto blurred = fast.frame();
  EXPECT_NEAR(width_px2(blurred.counts) - width_px2(sharp.counts), whole_px * whole_px,
              0.03 * whole_px * whole_px);
  const PixelPosition off = blurred.stars.at(0).middle - PixelPosition{599.5, 499.5};
  EXPECT_LT(std::hypot(off.x_px, off.y_px), 0.05 * whole_px);
}

TEST(InstrumentErrors, VibrationOfNoPowerChangesNoByte) {
  const std::vector<Star> star{{30, 40, {}, {}}};
  test::Stage none(among_stars(", vibration: {psd_hz: [0.1, 10], psd_arcsec2_per_hz: [0, 0]}"),
                   csv(star));
  test::Stage still(among_stars(""), csv(star));
  EXPECT_EQ(none.frame().counts.pixels, still.frame().counts.pixels);
}

// 4000 exposures: rms within 4 sigma of 1 / sqrt(2 n), no mean, nothing common to two axes.
TEST(InstrumentErrors, JitterHasItsRms) {
  SensorConfig sensor;
  sensor.name = "a";
  sensor.exposure_s = 1;
  sensor.cadence_s = 10;
  sensor.instrument.pointing_rms_rad = {1e-5, 2e-5, 3e-5};
  sensor.instrument.clock_rms_s = 0.01;
  constexpr int count = 4000;
  double sums[4] = {}, squares[4] = {}, product = 0;
  for (std::uint32_t frame = 1; frame <= count; ++frame) {
    const ExposureErrors errors(sensor, frame_times(sensor, frame), 7);
    const auto by = errors.true_from_commanded(errors.exposed().middle);
    const double late_s = (errors.exposed().start - errors.commanded().start).seconds();
    const double values[4] = {-by.m[0][2] / 1e-5, -by.m[1][2] / 2e-5, by.m[0][1] / 3e-5,
                              late_s / 0.01};
    for (int k = 0; k < 4; ++k) sums[k] += values[k], squares[k] += values[k] * values[k];
    product += values[0] * values[1];
    EXPECT_NEAR((errors.exposed().end - errors.exposed().start).seconds(), 1.0, 1e-9);
  }
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(sums[k] / count, 0.0, 4 / std::sqrt(count)) << k;
    EXPECT_NEAR(std::sqrt(squares[k] / count), 1.0, 4 / std::sqrt(2.0 * count)) << k;
  }
  EXPECT_NEAR(product / count, 0.0, 4 / std::sqrt(count));
}

const std::string everything =
    ", clock_error: {offset_ms: -300, drift_ppm: 50, jitter_ms: 20}, pointing_error: {bias_arcsec: "
    "[90, -40, 3600], drift_arcsec_per_s: [1, 2, 3], jitter_arcsec: 30}";

TEST(InstrumentErrors, AreTheSameBytesForAnyNumberOfThreads) {
  const std::string yaml = among_stars(everything);
  test::Stage one(yaml, csv({{30, 40, {}, {}}})), three(yaml, csv({{30, 40, {}, {}}}), "", 3);
  EXPECT_EQ(one.frame(2).counts.pixels, three.frame(2).counts.pixels);
}

// Off, or all 0: the bytes of a scenario without the keys.
TEST(InstrumentErrors, SwitchedOffTheyAreNotThere) {
  const auto pixels = [](const std::string& yaml) {
    test::Stage stage(yaml, csv({{30, 40, {}, {}}}));
    const auto frame = stage.frame();
    EXPECT_FALSE(frame.stars.empty());
    return std::tuple(frame.counts.pixels, frame.header, frame.report);
  };
  const auto none = pixels(among_stars(""));
  std::string off = among_stars(everything);
  off.insert(off.find("effects: {") + 10, "clock_error: off, pointing_error: off, ");
  EXPECT_TRUE(pixels(off) == none);
  EXPECT_TRUE(pixels(among_stars(
                  ", clock_error: {offset_ms: 0}, pointing_error: {jitter_arcsec: 0}")) == none);
}

}  // namespace
}  // namespace dmise
