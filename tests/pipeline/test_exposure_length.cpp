#include <cmath>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "tests/pipeline/harness.h"

// An exposure holds the light of its length, wherever it lies in time.
namespace dmise {
namespace {

const std::string objects =
    "GOES 16\n"
    "1 41866U 16071A   18019.87773469 -.00000245  00000-0  00000-0 0  9992\n"
    "2 41866   0.0069 115.0916 0001074 269.6956 335.2025  1.00271237  4322\n";
const std::string stars = "ra_deg,dec_deg,mag_v,bv\n83.63,22.01,4,0.65\n";

std::string scenario(const std::string& start, double tick_s, double first_s, double exposure_s,
                     double duration_s) {
  const auto text = [](double v) { return std::to_string(v); };
  return "simulation: {start: " + start + ", duration_s: " + text(duration_s) +
         ", tick_s: " + text(tick_s) +
         ", seed: 1}\n"
         "objects: [{catalogue: objects.tle}]\nstars: {catalogue: stars.csv}\n"
         "effects: {extinction: off, scintillation: off}\n"
         "sensors:\n  - {name: s, site: savannah, camera: geo-watch, pointing: {ra_deg: 83.63,"
         " dec_deg: 22.01}, first_exposure_s: " +
         text(first_s) + ", exposure_s: " + text(exposure_s) +
         ", cadence_s: " + text(std::max(exposure_s, 1e-3)) + "}\n";
}

/// First frame of a small crop.
FrameProducts first_frame(const std::string& yaml) {
  test::Stage stage(yaml, stars, objects);
  auto& optics = stage.scenario.sensors[0].camera.optics;
  optics.columns = optics.rows = 128;
  return stage.frame();
}

double star_e_per_s() {
  static const double rate =
      first_frame(scenario("2018-01-21T02:00:00Z", 5, 0, 1, 10)).stars.at(0).signal_e;
  return rate;
}

TEST(ExposureLength, AMicrosecondAndAnHourHoldTheirShareOfLight) {
  for (const double exposure_s : {1e-6, 1.0, 3600.0}) {
    const auto frame = first_frame(scenario("2018-01-21T01:00:00Z", 60, 0, exposure_s, 7200));
    ASSERT_EQ(frame.stars.size(), 1u) << exposure_s;
    EXPECT_NEAR(frame.stars[0].signal_e / (star_e_per_s() * exposure_s), 1.0, 1e-6) << exposure_s;
    EXPECT_DOUBLE_EQ(frame.header.exposure_s, exposure_s);
  }
}

// 2016 ended with a leap second: 20 s from 23:59:50 end at 00:00:09.
TEST(ExposureLength, ALeapSecondIsASecondOfLight) {
  const auto frame = first_frame(scenario("2016-12-31T23:59:40Z", 5, 10, 20, 60));
  EXPECT_EQ(frame.header.start_utc.substr(0, 19), "2016-12-31T23:59:50");
  EXPECT_EQ(frame.header.middle_utc.substr(0, 19), "2016-12-31T23:59:60");
  EXPECT_EQ(frame.header.end_utc.substr(0, 19), "2017-01-01T00:00:09");
  EXPECT_EQ(frame.header.exposure_s, 20.0);
  EXPECT_NEAR(frame.stars.at(0).signal_e / (star_e_per_s() * 20), 1.0, 1e-6);
}

TEST(ExposureLength, ATickWithinItChangesNothing) {
  const auto within = first_frame(scenario("2018-01-21T02:00:00Z", 60, 7, 20, 60));
  const auto across = first_frame(scenario("2018-01-21T02:00:00Z", 5, 7, 20, 60));
  EXPECT_NEAR(within.stars.at(0).signal_e / across.stars.at(0).signal_e, 1.0, 1e-6);
  EXPECT_NEAR(within.stars[0].x_px, across.stars[0].x_px, 1e-3);
}

TEST(ExposureLength, ZeroOrBeyondTheEndOfTheRunIsRefusedAtLoad) {
  EXPECT_THROW(test::Stage(scenario("2018-01-21T02:00:00Z", 5, 0, 0, 60), stars, objects),
               ConfigError);
  EXPECT_THROW(test::Stage(scenario("2018-01-21T02:00:00Z", 5, 50, 20, 60), stars, objects),
               ConfigError);
  // The last one that ends in time is made, the next is not begun.
  test::Stage stage(scenario("2018-01-21T02:00:00Z", 5, 0, 20, 55), stars, objects);
  EXPECT_EQ(frames_within(stage.scenario.sensors[0], stage.scenario.duration), 2u);
}

}  // namespace
}  // namespace dmise
