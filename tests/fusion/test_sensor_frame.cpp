#include "core/fusion/sensor_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/units.h"
#include "core/products/frame_report.h"

namespace dmise {
namespace {

FrameReport towards_aries() {
  FrameReport report{.sensor = "eye", .frame = 3, .middle = {5}};
  report.sensor_position_m = {6.4e6, 0, 0};
  report.wcs.crpix_x = report.wcs.crpix_y = 499.5;
  report.wcs.cd_deg = {-0.01, 0, 0, 0.01};  // 10 deg across
  report.limiting_magnitude = 12;
  return report;
}

TEST(SensorFrame, ShowsWhatIsAwayFromItsEdges) {
  const SensorFrame frame = sensor_frame(towards_aries(), {}, 1000, 1000, 7.1 * deg);
  const auto at = [](double ra_deg, double dec_deg) {
    return from_spherical<Gcrs>(ra_deg * deg, dec_deg * deg);
  };
  EXPECT_TRUE(frame.shows(at(4.9, 0)));
  EXPECT_FALSE(frame.shows(at(4.9, 0), 20));
  EXPECT_FALSE(frame.shows(at(5.1, 0)));
  EXPECT_TRUE(frame.shows(at(-4.9, -4.8)));
  EXPECT_FALSE(frame.shows(at(180, 0)));
}

// A direction is known to 0.2 arcsec at best, in each direction on the sky.
TEST(SensorFrame, NoDirectionIsBetterThanWhatDetectionsDoNotKnow) {
  const auto taken = [](double large_arcsec, double small_arcsec, double turn_rad) {
    const double l = large_arcsec * large_arcsec, s = small_arcsec * small_arcsec;
    const double c = std::cos(turn_rad), t = std::sin(turn_rad), unit = arcsec * arcsec;
    Detection d;
    d.id = "eye/3/1";
    d.covariance_rad2 = {(l * c * c + s * t * t) * unit, (l - s) * c * t * unit,
                         (l * t * t + s * c * c) * unit};
    d.sensor_position_m = {6.4e6, 0, 0};
    const SensorFrame frame = sensor_frame(towards_aries(), {d}, 1000, 1000, 7.1 * deg);
    return std::pair(d.covariance_rad2, frame.sources.at(0).observation.covariance_rad2);
  };
  const auto [wide, same] = taken(2, 0.3, 0.7);
  EXPECT_EQ(wide, same);
  for (const double turn_rad : {0.0, 0.7, 2.5}) {
    const auto [narrow, widened] = taken(2, 0.006, turn_rad);
    const auto expected = taken(2, 0.2000001, turn_rad).second;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(widened[k], expected[k], 1e-5 * arcsec * arcsec);
  }
  const auto [point, disc] = taken(0.006, 0.006, 0);
  EXPECT_NEAR(disc[0], 0.04 * arcsec * arcsec, 1e-9 * arcsec * arcsec);
  EXPECT_NEAR(disc[1], 0, 1e-9 * arcsec * arcsec);
  EXPECT_NEAR(disc[2], 0.04 * arcsec * arcsec, 1e-9 * arcsec * arcsec);
}

// Errors that detections do not know of add to theirs on every axis.
TEST(SensorFrame, AStatedErrorOfPointingAddsToEveryDirection) {
  const double unit = arcsec * arcsec;
  Detection d;
  d.id = "eye/3/1";
  d.covariance_rad2 = {0.09 * unit, 0.02 * unit, 0.16 * unit};
  d.sensor_position_m = {6.4e6, 0, 0};
  const auto taken =
      sensor_frame(towards_aries(), {d}, 1000, 1000, 7.1 * deg, 2 * arcsec).sources.at(0);
  EXPECT_NEAR(taken.observation.covariance_rad2[0], 4.09 * unit, 1e-9 * unit);
  EXPECT_NEAR(taken.observation.covariance_rad2[1], 0.02 * unit, 1e-9 * unit);
  EXPECT_NEAR(taken.observation.covariance_rad2[2], 4.16 * unit, 1e-9 * unit);
}

// Half of the best at the limit; one standard deviation of the normal distribution beside it.
TEST(SensorFrame, FindsLessBeyondItsLimit) {
  SensorFrame frame = sensor_frame(towards_aries(), {}, 1000, 1000, 7.1 * deg);
  EXPECT_NEAR(frame.detection_probability(12.0, 0.8), 0.4, 1e-12);
  EXPECT_NEAR(frame.detection_probability(11.5, 1.0), 0.841344746, 1e-9);
  EXPECT_LT(frame.detection_probability(15.0, 1.0), 1e-6);
  frame.searched = false;
  EXPECT_EQ(frame.detection_probability(5.0, 1.0), 0.0);
  frame.half_angle_rad = pi / 2;
  EXPECT_NEAR(frame.solid_angle_sr(), 2 * pi, 1e-12);
}

TEST(SensorFrame, LeavesOutDetectionsThatAreNotUsable) {
  Detection good;
  good.id = "eye/3/0", good.sensor = "eye", good.frame = 3;
  good.covariance_rad2 = {1e-12, 0, 1e-12};
  good.sensor_position_m = {6.4e6, 0, 0};
  good.star_like = true;
  Detection flat = good, lost = good;
  flat.covariance_rad2 = {};
  lost.corrected_ra_rad = std::numeric_limits<double>::quiet_NaN();
  const SensorFrame frame =
      sensor_frame(towards_aries(), {flat, good, lost}, 1000, 1000, 7.1 * deg);
  ASSERT_EQ(frame.sources.size(), 1u);
  EXPECT_EQ(frame.sources[0].observation.detection_id, "eye/3/0");
  EXPECT_TRUE(frame.sources[0].star_like);
}

// A sensor of the user's: what it does not see says something only if it states how deep it sees.
TEST(SensorFrame, WithoutAnImageHasAConeAlone) {
  FrameReport report = towards_aries();
  Detection d;
  d.covariance_rad2 = {1e-10, 0, 1e-10};
  d.sensor_position_m = report.sensor_position_m;
  d.magnitude = no_magnitude;
  d.range_m = 7e5, d.range_sigma_m = 2;
  const SensorFrame frame = sensor_frame(report, {d}, 0, 0, 30 * deg);
  EXPECT_FALSE(frame.wcs);
  EXPECT_FALSE(frame.needs_sunlight);
  EXPECT_TRUE(frame.searched);
  EXPECT_TRUE(frame.shows(from_spherical<Gcrs>(29 * deg, 0.0)));
  EXPECT_FALSE(frame.shows(from_spherical<Gcrs>(31 * deg, 0.0)));
  EXPECT_EQ(frame.sources.at(0).magnitude, no_magnitude);
  EXPECT_EQ(frame.sources[0].observation.range_m->value, 7e5);
  report.limiting_magnitude = 0;
  EXPECT_FALSE(sensor_frame(report, {d}, 0, 0, 30 * deg).searched);
}

}  // namespace
}  // namespace dmise
