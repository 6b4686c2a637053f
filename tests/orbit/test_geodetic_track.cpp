#include "core/orbit/geodetic_track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/orbit/motion.h"

namespace dmise {
namespace {

const Tai start{2458138.5, 0.25};
const std::string header = "time_s,latitude_deg,longitude_deg,height_m\n";

MotionState<Itrs> at(const Trajectory& track, double seconds) {
  return std::get<MotionState<Itrs>>(path_at(track, Tai{start.jd1, start.jd2 + seconds / 86400.0}));
}

// By hand: on the equator at longitude 0 the height is x less the equatorial radius of WGS 84,
// 6378137 m; latitude 90 deg is on the polar axis, 6356752.314245 m from the centre.
TEST(GeodeticTrack, PointsAreOnTheEllipsoid) {
  const auto rising =
      parse_geodetic_track(header + "0,0,0,100\n60,0,0,400\n120,0,0,700\n", "t.csv", start, "b");
  EXPECT_NEAR(at(rising, 60).position_m.x, 6378137.0 + 400, 1e-4);
  EXPECT_NEAR(at(rising, 90).position_m.x, 6378137.0 + 550, 1e-4);
  EXPECT_NEAR(at(rising, 90).velocity_m_per_s.x, 5.0, 1e-6);
  const auto polar = parse_geodetic_track(header + "-5,90,0,50\n5,90,0,50\n", "t.csv", start, "b");
  EXPECT_NEAR(at(polar, 0).position_m.z, 6356752.314245 + 50, 1e-4);
  EXPECT_NEAR(norm(at(polar, 0).velocity_m_per_s), 0.0, 1e-9);
}

// Slopes are those of a parabola: what falls freely is met exactly, at unequal steps too.
TEST(GeodeticTrack, AParabolaIsMetExactly) {
  std::string rows = header;
  const auto height_m = [](double t) { return 5000.0 + 12.0 * t - 4.9 * t * t; };
  for (const double t : {0.0, 3.0, 4.0, 9.0, 15.0}) {
    char row[80];
    std::snprintf(row, sizeof row, "%g,0,0,%.6f\n", t, height_m(t));
    rows += row;
  }
  const auto track = parse_geodetic_track(rows, "t.csv", start, "b");
  for (const double t : {0.5, 3.5, 6.0, 11.0, 14.9}) {
    EXPECT_NEAR(at(track, t).position_m.x - 6378137.0, height_m(t), 1e-3) << t;
    EXPECT_NEAR(at(track, t).velocity_m_per_s.x, 12.0 - 9.8 * t, 1e-3) << t;
  }
}

// A level circle of 1 km around a place, a point a second at 10 m/s: the chord of an arc of angle a
// is off by r a^2 / 8, the cubic by less than r a^4 / 100.
TEST(GeodeticTrack, ACircleIsFollowed) {
  std::string rows = header;
  constexpr double rate = 0.01, east_m = 6378137.0;  // on the equator a radian east is the radius
  for (int t = 0; t <= 20; ++t) {
    char row[120];
    std::snprintf(row, sizeof row, "%d,0,%.12f,%.9f\n", t,
                  1000.0 * std::cos(rate * t) / east_m / deg, 3000.0 + 1000.0 * std::sin(rate * t));
    rows += row;
  }
  const auto track = parse_geodetic_track(rows, "t.csv", start, "b");
  for (const double t : {1.5, 9.5, 17.25}) {
    const auto state = at(track, t);
    const double radius = norm(state.position_m),
                 longitude = std::atan2(state.position_m.y, state.position_m.x);
    EXPECT_NEAR(std::hypot(longitude * east_m, radius - east_m - 3000.0), 1000.0, 1e-3) << t;
  }
}

TEST(GeodeticTrack, OutsideItsSpanIsNoState) {
  const auto track = parse_geodetic_track(header + "0,0,0,100\n9,0,0,100\n", "t.csv", start, "b");
  EXPECT_TRUE(covers(track, start));
  EXPECT_FALSE(covers(track, Tai{start.jd1, start.jd2 + 9.1 / 86400}));
  EXPECT_THROW(at(track, -1.0), Error);
}

TEST(GeodeticTrack, FaultsPointAtTheirLine) {
  const auto complaint = [](const std::string& text) -> std::string {
    try {
      parse_geodetic_track(text, "t.csv", start, "b");
      return "";
    } catch (const ConfigError& e) {
      return e.what();
    }
  };
  EXPECT_EQ(complaint("time_s,x\n0,1\n"),
            "t.csv:1: the header must be time_s,latitude_deg,longitude_deg,height_m, got "
            "\"time_s,x\"");
  EXPECT_EQ(complaint(header + "0,0,0\n"), "t.csv:2: expected a time and 3 numbers, got \"0,0,0\"");
  EXPECT_EQ(complaint(header + "0,91,0,9\n"),
            "t.csv:2: latitude must be in -90..90, longitude in -360..360 and height in 2..1e9 m, "
            "got \"0,91,0,9\"");
  EXPECT_EQ(complaint(header + "0,9,0,9\n0,9,0,9\n"), "t.csv:3: times must increase, got \"0\"");
  EXPECT_EQ(complaint(header + "0,9,0,9\n"), "t.csv:2: a table needs at least two lines, got \"\"");
}

}  // namespace
}  // namespace dmise
