#include "core/detection/own_sightings.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

using testing::HasSubstr;

OwnSighting sighting() {
  return {.time = {1'500'000'000},
          .ra_rad = 1.0,
          .dec_rad = 0.5,
          .covariance_rad2 = {1e-10, 2e-11, 3e-10},
          .magnitude = {},
          .snr = 0.0,
          .range_m = {},
          .range_rate_m_per_s = {}};
}

std::string complaint(const Observed& observed) {
  try {
    check_observed(observed, {1'000'000'000}, {2'000'000'000});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string complaint(const OwnSighting& one) { return complaint(Observed{.sightings = {one}}); }

TEST(OwnSightings, WhatCannotHaveBeenSeenIsRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint(sighting()), "");
  EXPECT_EQ(complaint(Observed{}), "");
  const auto with = [](const auto& change) {
    OwnSighting one = sighting();
    change(one);
    return complaint(one);
  };
  EXPECT_THAT(with([](OwnSighting& s) { s.time = {999'999'999}; }),
              HasSubstr("sightings[0].time_ns: must be within the exposure, 1000000000 to"));
  EXPECT_THAT(with([](OwnSighting& s) { s.ra_rad = nan; }), HasSubstr("].ra_rad: must be finite"));
  EXPECT_THAT(with([](OwnSighting& s) { s.dec_rad = 1.6; }), HasSubstr("].dec_rad: must be from"));
  EXPECT_THAT(with([](OwnSighting& s) { s.covariance_rad2[0] = 0; }), HasSubstr("must be > 0"));
  EXPECT_THAT(with([](OwnSighting& s) { s.covariance_rad2[1] = nan; }),
              HasSubstr("must be positive"));
  EXPECT_THAT(with([](OwnSighting& s) { s.covariance_rad2[1] = 1e-9; }),
              HasSubstr("must be positive definite, got covariance 1e-09"));
  EXPECT_THAT(with([](OwnSighting& s) {
                s.magnitude = {nan, 0.1};
              }),
              HasSubstr("].magnitude: must"));
  EXPECT_THAT(with([](OwnSighting& s) { s.snr = -1; }), HasSubstr("].snr: must be from 0"));
  EXPECT_THAT(with([](OwnSighting& s) {
                s.range_m = {-1, 1};
              }),
              HasSubstr("].range_m: must be from"));
  EXPECT_THAT(with([](OwnSighting& s) { s.range_m = {1, 0}; }), HasSubstr("].range_sigma_m: must"));
  EXPECT_THAT(with([](OwnSighting& s) {
                s.range_rate_m_per_s = {3e8, 1};
              }),
              HasSubstr("].range_rate_m_per_s: must be from"));
  EXPECT_THAT(complaint(Observed{.boresight_dec_rad = nan}), HasSubstr("boresight_dec_rad: must"));
  EXPECT_THAT(complaint(Observed{.limiting_magnitude = nan}),
              HasSubstr("limiting_magnitude: must"));
}

// Pixels of a frame without an image are degrees about the boresight, east to the left as on a
// picture of the sky.
TEST(OwnSightings, BecomeDetections) {
  const double dec = 0.3;
  const FrameReport report{.sensor = "radar",
                           .frame = 7,
                           .start = {1'000'000'000},
                           .middle = {1'500'000'000},
                           .end = {2'000'000'000},
                           .boresight_ra_rad = 1.0,
                           .boresight_dec_rad = dec,
                           .wcs = wcs_without_image(1.0, dec)};
  OwnSighting one = sighting();
  one.dec_rad = dec + 2 * deg;
  one.range_m = {8e5, 3};
  const Detection d = detection_of(one, report, {1, 2, 3}, {4, 5, 6});
  EXPECT_NEAR(d.x_px, 0.0, 1e-9);
  EXPECT_NEAR(d.y_px, 2.0, 1e-9);
  EXPECT_EQ(d.corrected_dec_rad, one.dec_rad);
  EXPECT_EQ(d.magnitude, no_magnitude);
  EXPECT_EQ(d.range_m, 8e5);
  EXPECT_EQ(d.range_sigma_m, 3);
  EXPECT_FALSE(d.range_rate_m_per_s);
  EXPECT_EQ(d.epoch, ExposureEpoch::middle);
  EXPECT_TRUE(d.aberration_removed && d.refraction_removed && !d.light_time_removed);
  EXPECT_EQ(d.sensor_position_m, (Vec<Gcrs>{1, 2, 3}));
  // East, and behind the sensor: everything has a place.
  one.ra_rad = 1.0 + 90 * deg, one.dec_rad = 0.0;
  EXPECT_LT(detection_of(one, report, {}, {}).x_px, -80);
  one.ra_rad = 1.0 - pi, one.dec_rad = -dec;
  EXPECT_TRUE(std::isfinite(detection_of(one, report, {}, {}).x_px));
}

// Programs say what atan2 gives; products have right ascensions from 0 to 2 pi.
TEST(OwnSightings, RightAscensionsBeginAtZero) {
  OwnSighting one = sighting();
  one.ra_rad = -1.0;
  const FrameReport report{.wcs = wcs_without_image(-0.5, 0.0)};
  EXPECT_EQ(report.wcs.ra_rad, 2 * pi - 0.5);
  const Detection d = detection_of(one, report, {}, {});
  for (const double ra_rad : {d.ra_rad, d.corrected_ra_rad, d.end1_ra_rad, d.end2_ra_rad})
    EXPECT_EQ(ra_rad, 2 * pi - 1.0);
  for (const double zero : {0.0, -1e-18, 2 * pi, -2 * pi})
    EXPECT_EQ(right_ascension_rad(zero), 0.0);
}

}  // namespace
}  // namespace dmise
