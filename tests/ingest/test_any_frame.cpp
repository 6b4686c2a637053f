#include "core/ingest/any_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <random>

#include "core/base/error.h"
#include "core/detection/known/star_motion.h"
#include "tests/image/sample_frame.h"
#include "tests/ingest/foreign_scene.h"

namespace dmise {
namespace {

using namespace test;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::string error_of(const std::string& bytes, const FrameChoice& choice = {}) {
  try {
    read(bytes, choice);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

/// Both have the same objects, with places and light within some of the errors of the fit.
void expect_same(const std::vector<Detection>& got, const std::vector<Detection>& expected,
                 double sigmas) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    const Detection &a = got[i], &b = expected[i];
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_LT(std::abs(a.x_px - b.x_px), sigmas * std::sqrt(b.covariance_px2[0])) << i;
    EXPECT_LT(std::abs(a.y_px - b.y_px), sigmas * std::sqrt(b.covariance_px2[2])) << i;
    EXPECT_LT(std::abs(a.signal_e / b.signal_e - 1), sigmas / b.snr) << i;
    EXPECT_LT(std::abs(a.ra_rad - b.ra_rad) * std::cos(b.dec_rad) * focal_px, 0.2) << i;
    EXPECT_LT(std::abs(a.dec_rad - b.dec_rad) * focal_px, 0.2) << i;
  }
}

TEST(AnyFrame, AnOwnFileIsReadByItsOwnKeywords) {
  const std::string bytes = encode_frame(test::sample_counts(), test::sample_header());
  const auto frames = read(bytes);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].header, decode_frame(bytes, "x").header);
  EXPECT_EQ(frames[0].notes, FrameNotes());
  EXPECT_EQ(error_of(bytes, {.plane = 2}), "frame.fits: plane: must be 1, got 2");
  EXPECT_THAT(error_of(bytes, {.stated = {{"GAIN", "1"}}}), HasSubstr("frame.fits: GAIN: "));
}

// The width of stars is measured: in 150 of them to a few parts in a hundred.
TEST(AnyFrame, TheSameSceneGivesTheSameDetections) {
  const Scene scene = draw(false, 4);
  const auto expected = detections_in({scene.counts, scene.header});
  ASSERT_EQ(expected.size(), 2u);
  const Frame frame = read_one(image_of(scene.counts, all_cards(scene.header)));
  EXPECT_EQ(frame.counts.pixels, scene.counts.pixels);
  EXPECT_NEAR(frame.header.psf_fwhm_px, 1.7, 0.05);
  EXPECT_EQ(frame.header.gain_e_per_dn, 0.5);
  EXPECT_EQ(frame.header.bias_dn, 100);
  expect_same(detections_in(frame), expected, 0.5);
}

TEST(AnyFrame, SoDoFloatsAndCompressedIntegers) {
  const Scene scene = draw(false, 4);
  const auto expected = detections_in({scene.counts, scene.header});
  ForeignImage floats = image_of(scene.counts, all_cards(scene.header));
  floats.bitpix = FLOAT_IMG;
  for (double& v : floats.values) v = v / 65535 - 0.01;
  for (std::string& text : floats.cards) {
    if (text.starts_with("EGAIN")) text = "COMMENT";
    if (text.starts_with("SATURATE")) text = card("SATURATE", number_text(64000 / 65535.0 - 0.01));
    if (text.starts_with("PEDESTAL")) text = card("BIASLVL", number_text(100 / 65535.0 - 0.01));
  }
  const Frame frame = read_one(floats, {.stated = {{"EGAIN", "32767.5"}}});
  expect_same(detections_in(frame), expected, 0.5);
  for (const std::size_t i : {0, 12345, columns * rows - 1})
    EXPECT_NEAR(frame.count_zero + frame.count_step * frame.counts.pixels[i], floats.values[i],
                0.51 * frame.count_step);
  const double step = frame.header.gain_e_per_dn / 32767.5;
  EXPECT_NEAR((frame.header.saturation_dn - frame.header.bias_dn) * step, 63900 / 65535.0, 1e-9);
  ForeignImage packed = image_of(scene.counts, all_cards(scene.header));
  packed.compression = RICE_1;
  expect_same(detections_in(read_one(packed)), expected, 0.5);
}

// Rows from the bottom up, as most cameras store them: a mirror image.
TEST(AnyFrame, MirroredFramesOfAMountAtRestKeepTheirStars) {
  Scene scene = draw(true, 20);
  const auto expected = detections_in({scene.counts, scene.header});
  CountImage flipped(columns, rows);
  for (int y = 0; y < rows; ++y)
    std::copy_n(scene.counts.row(y), columns, flipped.row(rows - 1 - y));
  FrameHeader h = scene.header;
  h.wcs.cd_deg[1] = -h.wcs.cd_deg[1];
  h.wcs.cd_deg[3] = -h.wcs.cd_deg[3];
  const Frame frame = read_one(image_of(flipped, all_cards(h)));
  EXPECT_TRUE(frame.header.mirrored);
  EXPECT_THAT(frame.notes.assumed, Contains(HasSubstr("mount: at rest: stars trail by")));
  const auto found = detections_in(frame);
  ASSERT_EQ(found.size(), 2u);  // both streaks that were drawn
  const std::array<PixelPosition, 2> drawn = {{{150, 300}, {330, 120}}};
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].x_px, drawn[i].x_px, 3 * std::sqrt(found[i].covariance_px2[0]));
    EXPECT_NEAR(found[i].y_px, rows - 1 - drawn[i].y_px, 3 * std::sqrt(found[i].covariance_px2[2]));
  }
  ASSERT_FALSE(expected.empty());
  EXPECT_NEAR(found[0].x_px, expected[0].x_px, 0.2);
  EXPECT_NEAR(found[0].y_px, rows - 1 - expected[0].y_px, 0.2);
  EXPECT_NEAR(found[0].dec_rad, expected[0].dec_rad, 1 / focal_px);
}

TEST(AnyFrame, TrailsAreMeasuredWithoutAPointing) {
  const Scene scene = draw(true, 20);
  const Frame frame = read_one(image_of(scene.counts, {}));
  EXPECT_THAT(frame.notes.assumed, Contains(HasSubstr("mount: drifts evenly: stars trail by")));
  const PixelPosition middle{columns / 2.0, rows / 2.0};
  const auto truth = StarMotion(scene.header, columns, rows).trail_at(middle);
  const auto got = StarMotion(frame.header, columns, rows).trail_at(middle);
  const double sign = truth.x_px * got.x_px + truth.y_px * got.y_px < 0 ? -1 : 1;
  EXPECT_NEAR(sign * got.x_px, truth.x_px, 0.3);
  EXPECT_NEAR(sign * got.y_px, truth.y_px, 0.3);
  EXPECT_EQ(detections_in(frame).size(), 2u);  // both streaks that were drawn
}

// Nothing is invented: what follows from a fact that the header does not say is null.
TEST(AnyFrame, FieldsThatCannotBeKnownAreNull) {
  const Scene scene = draw(false, 4);
  const Frame bare = read_one(image_of(scene.counts, {}));
  Threads one(1);
  const DetectionLines found = test::detect_frame(bare, one);
  ASSERT_EQ(found.lines.size(), 2u);
  const auto line = nlohmann::json::parse(found.lines[0]);
  for (const char* key :
       {"ra_deg", "corrected_dec_deg", "covariance_arcsec2", "sensor_position_gcrs_m", "magnitude",
        "magnitude_sigma", "time_utc", "time_ns", "end1_time_utc", "rate_arcsec_per_s", "band",
        "position_angle_deg", "refraction_offset_gcrs_m", "end2_ra_deg"})
    EXPECT_TRUE(line.at(key).is_null()) << key;
  for (const char* key : {"x_px", "snr", "signal_e", "length_px", "end1_px", "covariance_px2"})
    EXPECT_FALSE(line.at(key).is_null()) << key;
  const auto report = nlohmann::json::parse(found.report);
  for (const char* key : {"wcs", "limiting_magnitude", "zero_point_mag", "background_e", "end_utc",
                          "middle_ns", "boresight_ra_deg", "sensor_velocity_gcrs_m_per_s"})
    EXPECT_TRUE(report.at(key).is_null()) << key;
  EXPECT_FALSE(report.at("noise_e").is_null());
  const auto missing = report.at("missing").get<std::vector<std::string>>();
  for (const char* what : {"exposure time: ", "time: ", "site: ", "pointing: ", "gain: ", "bias: ",
                           "band: ", "zero point: ", "saturation: ", "sensor: "})
    EXPECT_THAT(missing, Contains(HasSubstr(what))) << what;
}

TEST(AnyFrame, WhatIsUnknownIsKeptInASolvedFile) {
  const Frame bare = read_one(image_of(draw(false, 4).counts, {}));
  const Frame back = decode_frame(encode_frame(bare.counts, bare.header), "back.fits");
  EXPECT_EQ(back.header.unknown, bare.header.unknown);
  EXPECT_TRUE(back.header.unknown.has(FrameFact::site));
}

// A program has divided the counts by 65,535 and left the camera's gain in the header.
TEST(AnyFrame, AGainThatCannotBeIsRejected) {
  const Scene scene = draw(false, 4);
  ForeignImage image = image_of(scene.counts, {card("EGAIN", "0.5")});
  image.bitpix = DOUBLE_IMG;
  for (double& v : image.values) v /= 65535;
  const Frame frame = read_one(image);
  EXPECT_TRUE(frame.header.unknown.has(FrameFact::gain));
  EXPECT_THAT(frame.notes.missing, Contains(HasSubstr("EGAIN: gain: makes the sky's noise")));
  EXPECT_EQ(detections_in(frame).size(), 2u);
}

// A distortion that leaves no number of a direction.
TEST(AnyFrame, AWcsThatImagesNoSkyIsRejected) {
  const Scene scene = draw(false, 4);
  auto cards = all_cards(scene.header);
  for (std::string& c : cards)
    if (c.starts_with("CTYPE"))
      c = card(c.substr(0, 6), c[5] == '1' ? "'RA---TAN-SIP'" : "'DEC--TAN-SIP'");
  cards.push_back(card("A_ORDER", "2"));
  cards.push_back(card("A_2_0", "1E94"));
  const Frame frame = read_one(image_of(scene.counts, cards));
  EXPECT_TRUE(frame.header.unknown.has(FrameFact::pointing));
  EXPECT_THAT(frame.notes.missing, Contains(HasSubstr("images no sky")));
  EXPECT_EQ(detections_in(frame).size(), 2u);
}

TEST(AnyFrame, FactsCanBeStated) {
  const Scene scene = draw(false, 4);
  const Frame frame = read_one(image_of(scene.counts, {card("GAIN", "139")}),
                               {.stated = {{"EGAIN", "0.5"}, {"EXPTIME", "4"}}});
  EXPECT_EQ(frame.header.gain_e_per_dn, 0.5);
  EXPECT_EQ(frame.header.exposure_s, 4);
  EXPECT_FALSE(frame.header.unknown.has(FrameFact::gain));
  const Frame setting = read_one(image_of(scene.counts, {card("GAIN", "139")}));
  EXPECT_TRUE(setting.header.unknown.has(FrameFact::gain));
  EXPECT_THAT(setting.notes.missing, Contains(HasSubstr("got 139")));
  const Frame misspelt = read_one(image_of(scene.counts, {}), {.stated = {{"EXPTME", "4"}}});
  EXPECT_THAT(misspelt.notes.missing, Contains("EXPTME: is stated, but nothing reads it here"));
  const Frame colours = read_one(image_of(scene.counts, {}), {.stated = {{"CTYPE3", "RGB"}}});
  EXPECT_THAT(colours.notes.missing, Not(Contains(HasSubstr("CTYPE3"))));
  EXPECT_THAT(error_of(encoded(image_of(scene.counts, {})), {.stated = {{"EXPTIME", "abc"}}}),
              HasSubstr("EXPTIME: is not a finite number, got abc"));
}

// A bad column and a hole are no sources, and hide no others.
TEST(AnyFrame, PixelsWithoutAValueAreNotUsed) {
  const Scene scene = draw(false, 4);
  const auto expected = detections_in({scene.counts, scene.header});
  ForeignImage image = image_of(scene.counts, all_cards(scene.header));
  image.bitpix = FLOAT_IMG;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      if (x == 155 || (x > 400 && y > 300)) image.values[std::size_t(y * columns + x)] = NAN;
  const Frame frame = read_one(image);
  EXPECT_THAT(frame.notes.missing, Contains(HasSubstr("have no value, and are not used")));
  const auto found = detections_in(frame);
  ASSERT_EQ(found.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(found[i].x_px, expected[i].x_px, 0.5);
    EXPECT_NEAR(found[i].signal_e, expected[i].signal_e, 0.03 * expected[i].signal_e);
  }
}

TEST(AnyFrame, ColoursAreAddedAndCubesAreFrames) {
  const Scene scene = draw(false, 4);
  ForeignImage cube = image_of(scene.counts, all_cards(scene.header));
  const auto plane = cube.values;
  for (int i = 0; i < 2; ++i) cube.values.insert(cube.values.end(), plane.begin(), plane.end());
  cube.bitpix = LONG_IMG;
  cube.shape = {columns, rows, 3};
  const Frame sum = read_one(cube);
  const double step = sum.header.gain_e_per_dn / 0.5;
  EXPECT_NEAR((sum.counts.at(7, 9) - sum.header.bias_dn) * step + 300, 3 * scene.counts.at(7, 9),
              0.51 * step);
  EXPECT_NEAR((sum.header.saturation_dn - sum.header.bias_dn) * step + 300, 64000 + 200, 1e-6);

  EXPECT_EQ(read_one(cube, {.plane = 2}).counts.pixels, scene.counts.pixels);
  EXPECT_EQ(error_of(encoded(cube), {.plane = 4}), "frame.fits: plane: must be in 1..3, got 4");

  cube.cards.push_back(card("CTYPE3", "'TIME'"));
  cube.cards.push_back(card("CDELT3", "5.0"));
  auto frames = read(encoded(cube));
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[2].header.frame, 3u);
  EXPECT_EQ(frames[2].header.start_utc.substr(0, 19), "2018-01-20T23:40:10");
  cube.cards.back() = card("CDELT3", "0.0");
  frames = read(encoded(cube));
  EXPECT_FALSE(frames[0].header.unknown.has(FrameFact::time));
  EXPECT_TRUE(frames[1].header.unknown.has(FrameFact::time));
}

// Poisson noise of a sky that is brighter on one side: the gain is that of the simulation.
TEST(AnyFrame, MeasuresTheGainWhereLevelsSpanEnough) {
  FrameHeader h = simulated::camera_header(1000, 1000, focal_px, 0.4, 4, false);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  CountImage counts(1000, 1000);
  for (int y = 0; y < 1000; ++y)
    for (int x = 0; x < 1000; ++x) {
      const double e = 400 + 4 * x;
      counts.at(x, y) = std::uint16_t(
          std::lround(100 + (e + std::hypot(std::sqrt(e), 5) * normal(random)) / 0.5));
    }
  const Frame frame = read_one(image_of(counts, {}));
  EXPECT_FALSE(frame.header.unknown.has(FrameFact::gain));
  EXPECT_NEAR(frame.header.gain_e_per_dn, 0.5, 0.02);
  EXPECT_THAT(frame.notes.assumed, Contains(HasSubstr("gain: ")));
}

// A camera's setting in GAIN is no gain: the sky's noise says what is.
TEST(AnyFrame, ASettingInGainIsNoGain) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  CountImage counts(1000, 1000);
  for (int y = 0; y < 1000; ++y)
    for (int x = 0; x < 1000; ++x) {
      const double e = 400 + 4 * x;
      counts.at(x, y) = std::uint16_t(
          std::lround(100 + (e + std::hypot(std::sqrt(e), 5) * normal(random)) / 0.5));
    }
  for (const char* setting : {"1", "10", "20"}) {
    const Frame frame = read_one(image_of(counts, {card("GAIN", setting)}));
    EXPECT_NEAR(frame.header.gain_e_per_dn, 0.5, 0.02) << setting;
    EXPECT_THAT(frame.notes.assumed, Contains(HasSubstr("gain: "))) << setting;
    EXPECT_THAT(frame.notes.missing, Contains(HasSubstr(std::string("got ") + setting)));
  }
  const Frame stated = read_one(image_of(counts, {card("GAIN", "0.5")}));
  EXPECT_EQ(stated.header.gain_e_per_dn, 0.5);
  EXPECT_THAT(stated.notes.assumed, Contains(HasSubstr("gain: GAIN = 0.5 is taken for")));
}

// No text claims a time within the 86 s of an MJD with three decimals.
TEST(AnyFrame, TimesHaveNoDigitsThatNobodyKnows) {
  const Scene scene = draw(false, 4);
  const Frame frame =
      read_one(image_of(scene.counts, {card("MJD-OBS", "58139.043"), card("EXPTIME", "4.0")}));
  EXPECT_EQ(frame.header.start_utc, "2018-01-21T01:01:55Z");
  EXPECT_THAT(frame.notes.assumed, Contains(HasSubstr("the last digit of MJD-OBS is 86.4 s")));
  EXPECT_EQ(detections_in(frame).size(), 2u);
}

/// Noise, slopes, waves, clipped and single bright pixels, lines of light, pixels without a value.
ForeignImage small_frame(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const int wide = int(uniform(1, 65)), high = int(uniform(1, 65)), kind = int(uniform(0, 9));
  const double sigma = std::pow(10, uniform(-1, 2)), by_x = uniform(-20, 20),
               by_y = uniform(-20, 20), turn = uniform(0, 3.14), off = uniform(-20, 20),
               width = uniform(0.5, 3), light = std::pow(10, uniform(1.5, 4.5));
  std::normal_distribution<double> normal(1000, sigma);
  ForeignImage image{.bitpix = FLOAT_IMG,
                     .shape = {wide, high},
                     .values = {},
                     .cards = {card("DATE-OBS", "'2021-05-01T04:00:00'"), card("EXPTIME", "2.0")}};
  for (int y = 0; y < high; ++y)
    for (int x = 0; x < wide; ++x) {
      const double across =
          (y - high / 2.0) * std::cos(turn) - (x - wide / 2.0) * std::sin(turn) - off;
      double v = kind == 0 ? 1000.0 : normal(random);
      if (kind == 1) v += by_x * x + by_y * y;
      if (kind == 2) v = 65535.0;
      if (kind == 3 && uniform(0, 1) < 0.3) v = NAN;
      if (kind == 4 && uniform(0, 1) < 0.2) v = 65535.0;
      if (kind == 5 && uniform(0, 1) < 0.01) v += light;
      if (kind == 6) v += 500 * std::sin(0.02 * by_x * x + 0.02 * by_y * y);
      if (kind == 7) v += light * std::exp(-0.5 * across * across / (width * width));
      image.values.push_back(v);
    }
  image.values[0] = 1000.0;
  if (kind == 8) image.values[image.values.size() / 2] = 60000.0;
  return image;
}

/// Lines of light that cross, some of them clipped, some with pixels without a value.
ForeignImage crossed_lines(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const int wide = int(uniform(8, 65)), high = int(uniform(8, 65));
  const double sigma = std::pow(10, uniform(0, 1.5)),
               holes = uniform(0, 1) < 0.5 ? std::pow(10, uniform(-3, -0.5)) : 0.0,
               clip = uniform(0, 1) < 0.3 ? 1100 + uniform(0, 500) : 65535.0;
  const int lines = int(uniform(1, 6));
  std::normal_distribution<double> normal(1000, sigma);
  std::vector<double> values(std::size_t(wide * high));
  for (double& v : values) v = normal(random);
  for (int k = 0; k < lines; ++k) {
    const double turn = uniform(0, 3.14), mid_x = uniform(0, wide), mid_y = uniform(0, high),
                 width = uniform(0.5, 2.5), light = sigma * std::pow(10, uniform(0, 2)),
                 half = uniform(0, 1) < 0.5 ? HUGE_VAL : uniform(1, 40);
    for (int y = 0; y < high; ++y)
      for (int x = 0; x < wide; ++x) {
        const double across = (y - mid_y) * std::cos(turn) - (x - mid_x) * std::sin(turn),
                     along = (x - mid_x) * std::cos(turn) + (y - mid_y) * std::sin(turn);
        if (std::abs(along) < half)
          values[std::size_t(y * wide + x)] +=
              light * std::exp(-0.5 * across * across / (width * width));
      }
  }
  for (double& v : values) {
    v = std::min(v, clip);
    if (uniform(0, 1) < holes) v = NAN;
  }
  values[0] = 1000.0;
  return {.bitpix = FLOAT_IMG,
          .shape = {wide, high},
          .values = values,
          .cards = {card("DATE-OBS", "'2021-05-01T04:00:00'"), card("EXPTIME", "2.0")}};
}

/// Seconds of processor time, so that a busy machine does not count.
double seconds_of_search(const ForeignImage& image) {
  const std::clock_t begin = std::clock();
  detections_in(read_one(image));
  return double(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// Most that a small frame may cost, in searches of a megapixel of noise.
constexpr double max_searches = 5.0;

double seconds_of_a_megapixel() {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(1000, 10);
  ForeignImage image{.bitpix = FLOAT_IMG,
                     .shape = {1000, 1000},
                     .values = {},
                     .cards = {card("DATE-OBS", "'2021-05-01T04:00:00'"), card("EXPTIME", "2.0")}};
  for (int i = 0; i < 1'000'000; ++i) image.values.push_back(normal(random));
  return seconds_of_search(image);
}

TEST(AnyFrame, SmallFramesOfAnyKindAreSearchedInAMoment) {
  const double max_s = max_searches * seconds_of_a_megapixel();
  double worst_s = 0.0;
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    const ForeignImage image = small_frame(random);
    const double spent_s = seconds_of_search(image);
    EXPECT_LT(spent_s, max_s) << i << ": " << image.shape[0] << " x " << image.shape[1];
    worst_s = std::max(worst_s, spent_s);
  }
  RecordProperty("worst_share", std::to_string(worst_s / max_s));
}

// Without a bound on fitted lengths this frame of 35 x 58 px took 3.4 s.
TEST(AnyFrame, CrossedLinesAreSearchedInAMoment) {
  std::mt19937_64 random(21);
  for (int i = 0; i < 154; ++i) crossed_lines(random);
  EXPECT_LT(seconds_of_search(crossed_lines(random)), max_searches * seconds_of_a_megapixel());
}

TEST(AnyFrame, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = draw(true, 20);
  const std::string bytes = encoded(image_of(scene.counts, all_cards(scene.header)));
  Threads three(3);
  decode_frames(bytes, "x", {}, three, [&](const Frame& frame) {
    const Frame alone = read(bytes)[0];
    EXPECT_EQ(frame.header, alone.header);
    EXPECT_EQ(frame.counts.pixels, alone.counts.pixels);
  });
}

TEST(AnyFrame, RefusesAFrameWithoutAnyValue) {
  ForeignImage image{
      .bitpix = FLOAT_IMG, .shape = {20, 20}, .values = std::vector<double>(400, NAN)};
  EXPECT_EQ(error_of(encoded(image)), "frame.fits: no pixel has a value");
}

}  // namespace
}  // namespace dmise
