#include "core/fusion/sensor_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/units.h"

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

}  // namespace
}  // namespace dmise
