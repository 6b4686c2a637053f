// How a mount turns: along the great circle, or by its axes.
#include "core/fusion/mount.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

CueSettings altazimuth() {
  CueSettings cue{.slew_deg_per_s = 2.0};
  cue.mount = MountKind::altazimuth;
  cue.azimuth_deg_per_s = 4.0;
  return cue;
}

Vec<Enu> towards(double azimuth_deg, double elevation_deg) {
  return mount_position(azimuth_deg, elevation_deg).direction;
}

// Reference: uniform acceleration and speed. 10 deg at 5 deg/s: 2 s; with 2.5 deg/s^2 two seconds
// more. 1 deg at 4 deg/s^2 does not reach 5 deg/s: 2 sqrt(1 / 4).
TEST(Mount, TurnsWithItsAccelerationAndSpeed) {
  EXPECT_NEAR(turn_s(10 * deg, 5, 0), 2.0, 1e-12);
  EXPECT_NEAR(turn_s(10 * deg, 5, 2.5), 4.0, 1e-12);
  EXPECT_NEAR(turn_s(1 * deg, 5, 4), 1.0, 1e-12);
  EXPECT_EQ(turn_s(0.0, 5, 4), 0.0);
}

// Near the zenith a great circle is short where the azimuth has far to turn.
TEST(Mount, TurnsBothAxesAtOnceEachAtItsRate) {
  const MountPosition from = mount_position(90, 80);
  const auto ways = slews_to(altazimuth(), from, towards(270, 80));
  ASSERT_FALSE(ways.empty());
  EXPECT_NEAR(ways[0].seconds, 180.0 / 4.0, 1e-9);
  EXPECT_NEAR(ways[0].angle_rad, 180 * deg, 1e-9);
  const auto up = slews_to(altazimuth(), mount_position(90, 20), towards(100, 60));
  EXPECT_NEAR(up[0].seconds, 40.0 / 2.0, 1e-9);
  const auto circle = slews_to({.slew_deg_per_s = 2.0}, from, towards(270, 80));
  ASSERT_EQ(circle.size(), 1u);
  EXPECT_NEAR(circle[0].seconds, 20.0 / 2.0, 1e-9);
}

// -270 to 270 deg: east can be stood at as 90 and as -270, south as 180 and -180, north as 0 alone.
TEST(Mount, GoesRoundWithinTheRangeOfItsAzimuth) {
  const CueSettings cue = altazimuth();
  const auto east = slews_to(cue, mount_position(-200, 40), towards(90, 40));
  ASSERT_EQ(east.size(), 2u);
  EXPECT_NEAR(east[0].to.azimuth_rad, -270 * deg, 1e-9);
  EXPECT_NEAR(east[0].seconds, 70.0 / 4.0, 1e-9);
  EXPECT_NEAR(east[1].to.azimuth_rad, 90 * deg, 1e-9);
  // From -260 deg (which is 100) to 110 deg it may not go on to -250... but to -250 it may: 10 deg.
  const auto near = slews_to(cue, mount_position(-260, 40), towards(110, 40));
  EXPECT_NEAR(near[0].seconds, 10.0 / 4.0, 1e-9);
  // To 80 deg it would have to pass -270: round the other way.
  const auto far = slews_to(cue, mount_position(-260, 40), towards(80, 40));
  ASSERT_EQ(far.size(), 1u);
  EXPECT_NEAR(far[0].seconds, 340.0 / 4.0, 1e-9);
  CueSettings half = cue;
  half.azimuth_range_deg = {0, 180};
  EXPECT_TRUE(slews_to(half, mount_position(90, 40), towards(270, 40)).empty());
}

// At elevation e a target that moves across at w turns the azimuth by w / cos e: with 4 deg/s what
// moves by 0.5 deg/s can be followed up to acos(0.125) = 82.8 deg.
TEST(Mount, HasABlindSpotAtTheZenith) {
  const CueSettings cue = altazimuth();
  const double across = 0.5 * deg, step_s = 0.01;
  for (const double elevation_deg : {30.0, 80.0, 82.5, 83.1, 88.0}) {
    const MountPosition from = mount_position(180, elevation_deg);
    const Vec<Enu> to = unit(from.direction + Vec<Enu>{1, 0, 0} * (across * step_s));
    EXPECT_EQ(bool(followed(cue, from, to, step_s)), elevation_deg < 82.8) << elevation_deg;
  }
  const CueSettings circle{.slew_deg_per_s = 2.0};
  EXPECT_TRUE(followed(circle, mount_position(180, 89.9), towards(0, 89.9), 0.01));
}

TEST(Mount, FollowsOverNorthAndNoFurtherThanItsRange) {
  const CueSettings cue = altazimuth();
  const auto over = followed(cue, mount_position(-1, 40), towards(1, 40), 1.0);
  ASSERT_TRUE(over);
  EXPECT_NEAR(over->azimuth_rad, 1 * deg, 1e-9);
  EXPECT_FALSE(followed(cue, mount_position(269, 40), towards(271, 40), 1.0));
  EXPECT_FALSE(followed(cue, mount_position(10, 40), towards(10, 43), 1.0));  // 3 deg/s of 2
}

}  // namespace
}  // namespace dmise
