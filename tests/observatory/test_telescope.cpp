// A telescope under commands: spherical astronomy by hand, and what ASCOM's ITelescope says.
#include "sensors/observatory/telescope.h"

#include <gtest/gtest.h>

#include "core/visibility/pointing.h"
#include "tests/observatory/turning_sky.h"

namespace dmise {
namespace {

constexpr double arcsec_in_deg = 1.0 / 3600.0;

DeviceFault fault_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const DeviceError& error) {
    return error.fault();
  }
  return DeviceFault{};
}

SimTime at_s(double s) { return sim_seconds(s); }

double apart_deg(const Equatorial& a, const Equatorial& b) {
  return angle_rad(direction_of<Gcrs>(a), direction_of<Gcrs>(b)) / deg;
}

struct Mount {
  TurningSky sky;
  Telescope telescope{{.latitude_deg = 40.0,
                       .slew_rate_deg_per_s = 3.0,
                       .settle_s = 1.0,
                       .min_elevation_deg = 10.0},
                      sky};

  /// Tracks a place on the sky, at rest, from the returned time on.
  SimTime go_to(const Equatorial& place, SimTime now) {
    telescope.set_tracking(true, now);
    telescope.slew_to(place, now);
    const SimTime there = now + at_s(200);
    EXPECT_FALSE(telescope.is_slewing(there));
    return there;
  }
};

TEST(Telescope, BeginsAtItsHomeAtThePole) {
  Mount m;
  EXPECT_TRUE(m.telescope.is_at_home({}));
  EXPECT_FALSE(m.telescope.is_parked({}));
  EXPECT_FALSE(m.telescope.is_tracking({}));
  EXPECT_NEAR(m.telescope.horizontal_place({}).elevation_rad / deg, 40.0, 1e-9);
  EXPECT_NEAR(m.telescope.place({}).dec_deg, 90.0, 1e-6);
}

// 30 deg at 3 deg/s take 10 s, and 1 s to settle.
TEST(Telescope, SlewsAlongTheGreatCircleAtItsRate) {
  Mount m;
  const Equatorial from = at_hour_angle(m.sky, 0.0, 30.0, at_s(0));
  SimTime now = m.go_to(from, at_s(0));
  const Equatorial to{from.ra_deg, 60.0};
  m.telescope.slew_to(to, now);
  EXPECT_TRUE(m.telescope.is_slewing(now + at_s(10.9)));
  EXPECT_FALSE(m.telescope.is_at_home(now));
  EXPECT_NEAR(m.telescope.place(now + at_s(5)).dec_deg, 45.0, 0.02);
  EXPECT_FALSE(m.telescope.is_slewing(now + at_s(11.1)));
  EXPECT_LT(apart_deg(m.telescope.place(now + at_s(11.1)), to), 1e-9);
  EXPECT_LT(apart_deg(m.telescope.place(now + at_s(1000)), to), 1e-9);  // it tracks
}

TEST(Telescope, NeedsTrackingForPlacesOfTheSkyAndNoneForThoseOfTheHorizon) {
  Mount m;
  const Equatorial place = at_hour_angle(m.sky, 10.0, 30.0, {});
  const Horizontal south{pi, 50 * deg};
  EXPECT_EQ(fault_of([&] { m.telescope.slew_to(place, {}); }), DeviceFault::invalid_operation);
  m.telescope.slew_to(south, {});
  const SimTime there = at_s(100);
  EXPECT_NEAR(m.telescope.horizontal_place(there).azimuth_rad, pi, 1e-12);
  m.telescope.set_tracking(true, there);
  EXPECT_EQ(fault_of([&] { m.telescope.slew_to(south, there); }), DeviceFault::invalid_operation);
}

TEST(Telescope, GoesToAPlaceAndTracksItOrStandsThere) {
  Mount m;
  const Equatorial place = at_hour_angle(m.sky, 10.0, 30.0, {});
  m.telescope.go_to(place, true, {});
  EXPECT_TRUE(m.telescope.is_tracking(at_s(200)));
  EXPECT_LT(apart_deg(m.telescope.place(at_s(200)), place), 1e-9);
  const Equatorial next = at_hour_angle(m.sky, 10.0, 60.0, {});  // 30 deg: there after 11 s
  m.telescope.go_to(next, false, at_s(200));
  EXPECT_TRUE(m.telescope.is_slewing(at_s(210.9)));
  EXPECT_FALSE(m.telescope.is_tracking(at_s(300)));
  const Horizontal there = horizontal(m.sky.seen(next, at_s(211)));
  EXPECT_NEAR(m.telescope.horizontal_place(at_s(400)).azimuth_rad, there.azimuth_rad, 1e-6);
  EXPECT_NEAR(m.telescope.horizontal_place(at_s(400)).elevation_rad, there.elevation_rad, 1e-6);
  EXPECT_EQ(fault_of([&] {
              m.telescope.go_to({place.ra_deg, -80.0}, true, at_s(400));
            }),
            DeviceFault::invalid_value);
  EXPECT_FALSE(m.telescope.is_tracking(at_s(400)));  // nothing has changed
}

TEST(Telescope, RefusesPlacesBelowItsLeastElevation) {
  Mount m;
  m.telescope.set_tracking(true, {});
  const Equatorial low = at_hour_angle(m.sky, 100.0, -20.0, {});
  EXPECT_EQ(fault_of([&] { m.telescope.slew_to(low, {}); }), DeviceFault::invalid_value);
  m.telescope.set_tracking(false, {});
  EXPECT_EQ(fault_of([&] {
              m.telescope.slew_to(Horizontal{1.0, 9.9 * deg}, {});
            }),
            DeviceFault::invalid_value);
}

// Fixed to the ground it sees other stars: right ascension grows by 15.041 arcsec a second.
TEST(Telescope, StandsStillWithoutTracking) {
  Mount m;
  m.telescope.slew_to(Horizontal{2.0, 0.8}, {});
  const double from = m.telescope.place(at_s(100)).ra_deg;
  EXPECT_NEAR(m.telescope.place(at_s(1100)).ra_deg - from, 15041.07 * arcsec_in_deg, 1e-4);
  EXPECT_NEAR(m.telescope.horizontal_place(at_s(1100)).elevation_rad, 0.8, 1e-12);
}

TEST(Telescope, StopsWhereItsLimitIs) {
  Mount m;
  const Equatorial setting = at_hour_angle(m.sky, 60.0, 0.0, {});  // 22.5 deg high
  const SimTime now = m.go_to(setting, {});
  const SimTime late = now + at_s(2 * 3600);
  EXPECT_TRUE(m.telescope.is_tracking(now));
  EXPECT_FALSE(m.telescope.is_tracking(late));
  EXPECT_NEAR(m.telescope.horizontal_place(late + at_s(60)).elevation_rad / deg, 10.0, 1e-9);
  EXPECT_EQ(fault_of([&] { m.telescope.pointing_during(now, late); }), DeviceFault{});
}

TEST(Telescope, ParksAndRefusesCommandsUntilUnparked) {
  Mount m;
  SimTime now = m.go_to(at_hour_angle(m.sky, -20.0, 30.0, {}), {});
  m.telescope.set_park(now);
  const Horizontal place = m.telescope.horizontal_place(now);
  m.telescope.slew_to(at_hour_angle(m.sky, 40.0, 30.0, {}), now);
  now = now + at_s(100);
  m.telescope.park(now);
  EXPECT_FALSE(m.telescope.is_parked(now));
  EXPECT_TRUE(m.telescope.is_slewing(now));
  now = now + at_s(100);
  EXPECT_TRUE(m.telescope.is_parked(now));
  EXPECT_FALSE(m.telescope.is_tracking(now));
  EXPECT_NEAR(m.telescope.horizontal_place(now).elevation_rad, place.elevation_rad, 1e-9);
  const auto parked = DeviceFault::invalid_while_parked;
  EXPECT_EQ(fault_of([&] { m.telescope.set_tracking(true, now); }), parked);
  EXPECT_EQ(fault_of([&] { m.telescope.slew_to(Equatorial{10, 50}, now); }), parked);
  EXPECT_EQ(fault_of([&] { m.telescope.slew_to(Horizontal{1, 1}, now); }), parked);
  EXPECT_EQ(fault_of([&] { m.telescope.abort_slew(now); }), parked);
  EXPECT_EQ(fault_of([&] { m.telescope.move_axis(0, 1.0, now); }), parked);
  EXPECT_EQ(fault_of([&] { m.telescope.find_home(now); }), parked);
  EXPECT_EQ(fault_of([&] { m.telescope.sync_to(Equatorial{10, 50}, now); }), parked);
  EXPECT_EQ(fault_of([&] { m.telescope.pulse_guide(GuideDirection::east, {}, now); }), parked);
  m.telescope.park(now);  // which it is
  m.telescope.unpark(now);
  EXPECT_FALSE(m.telescope.is_parked(now));
  m.telescope.find_home(now);
  EXPECT_TRUE(m.telescope.is_at_home(now + at_s(100)));
}

TEST(Telescope, AbortsASlewWhereItIs) {
  Mount m;
  const Equatorial from = at_hour_angle(m.sky, 0.0, 30.0, {});
  const SimTime now = m.go_to(from, {});
  m.telescope.slew_to(Equatorial{from.ra_deg, 60.0}, now);
  m.telescope.abort_slew(now + at_s(5));
  EXPECT_FALSE(m.telescope.is_slewing(now + at_s(5)));
  EXPECT_TRUE(m.telescope.is_tracking(now + at_s(5)));
  EXPECT_NEAR(m.telescope.place(now + at_s(50)).dec_deg, 45.0, 0.02);
  EXPECT_LT(m.telescope.horizontal_place(now + at_s(50)).elevation_rad, pi / 2);
}

TEST(Telescope, SyncMovesWhatItTellsAndIsToldAlike) {
  Mount m;
  const Equatorial place = at_hour_angle(m.sky, -10.0, 30.0, {});
  SimTime now = m.go_to(place, {});
  const Equatorial solved{place.ra_deg + 0.5, place.dec_deg - 0.25};  // by the frame's stars
  m.telescope.sync_to(solved, now);
  EXPECT_LT(apart_deg(m.telescope.place(now), solved), 1e-9);
  const Horizontal before = m.telescope.horizontal_place(now);
  m.telescope.slew_to(place, now);
  now = now + at_s(20);
  EXPECT_LT(apart_deg(m.telescope.place(now), place), 1e-9);
  const auto axis = m.telescope.pointing_during(now, now + at_s(1));
  EXPECT_NEAR(axis.longitude_deg, place.ra_deg - 0.5, 1e-9);
  EXPECT_NEAR(axis.latitude_deg, place.dec_deg + 0.25, 1e-9);
  EXPECT_GT(std::abs(before.elevation_rad - m.telescope.horizontal_place(now).elevation_rad), 1e-3);
}

TEST(Telescope, MovesAnAxisUntilTheRateIsZero) {
  Mount m;
  const Equatorial place = at_hour_angle(m.sky, -10.0, 30.0, {});
  const SimTime now = m.go_to(place, {});
  m.telescope.move_axis(1, 0.5, now);
  EXPECT_TRUE(m.telescope.is_slewing(now + at_s(4)));
  m.telescope.move_axis(1, 0.0, now + at_s(4));
  EXPECT_FALSE(m.telescope.is_slewing(now + at_s(4)));
  EXPECT_NEAR(m.telescope.place(now + at_s(10)).dec_deg, 32.0, 1e-9);
  EXPECT_EQ(fault_of([&] { m.telescope.move_axis(0, 3.1, now + at_s(10)); }),
            DeviceFault::invalid_value);
  EXPECT_EQ(fault_of([&] { m.telescope.move_axis(2, 1.0, now + at_s(10)); }),
            DeviceFault::invalid_value);
  // Without tracking the axes are those of the ground.
  m.telescope.set_tracking(false, now + at_s(10));
  const Equatorial from = m.telescope.place(now + at_s(10));
  m.telescope.move_axis(0, 1.0, now + at_s(10));
  const Equatorial to = m.telescope.place(now + at_s(15));
  EXPECT_NEAR(to.ra_deg - from.ra_deg, 5.0 + 5 * 15.041 * arcsec_in_deg, 1e-5);
  EXPECT_NEAR(to.dec_deg, from.dec_deg, 1e-9);
}

TEST(Telescope, RatesMoveItAmongTheStars) {
  Mount m;
  const Equatorial place = at_hour_angle(m.sky, -10.0, 30.0, {});
  const SimTime now = m.go_to(place, {});
  m.telescope.set_rates(0.01, -0.02, now);
  EXPECT_NEAR(m.telescope.place(now + at_s(100)).ra_deg, place.ra_deg + 1.0, 1e-9);
  EXPECT_NEAR(m.telescope.place(now + at_s(100)).dec_deg, place.dec_deg - 2.0, 1e-9);
  const CommandedPointing p = m.telescope.pointing_during(now + at_s(100), now + at_s(104));
  EXPECT_TRUE(p.follows);
  EXPECT_EQ(p.reference, now + at_s(102));
  EXPECT_NEAR(p.longitude_deg, place.ra_deg + 1.02, 1e-9);
  EXPECT_EQ(p.longitude_rate_deg_per_s, 0.01);
  EXPECT_EQ(p.latitude_rate_deg_per_s, -0.02);
}

TEST(Telescope, PulsesGuideItByTheirLength) {
  Mount m;
  const Equatorial place = at_hour_angle(m.sky, -10.0, 30.0, {});
  const SimTime now = m.go_to(place, {});
  m.telescope.set_guide_rates(0.002, 0.001, now);
  m.telescope.pulse_guide(GuideDirection::west, at_s(3), now);
  m.telescope.pulse_guide(GuideDirection::north, at_s(5), now);
  EXPECT_TRUE(m.telescope.is_pulse_guiding(now + at_s(4)));
  EXPECT_EQ(fault_of([&] { m.telescope.pointing_during(now + at_s(4), now + at_s(9)); }),
            DeviceFault::invalid_operation);
  EXPECT_FALSE(m.telescope.is_pulse_guiding(now + at_s(5)));
  EXPECT_NEAR(m.telescope.place(now + at_s(60)).ra_deg, place.ra_deg - 0.006, 1e-9);
  EXPECT_NEAR(m.telescope.place(now + at_s(60)).dec_deg, place.dec_deg + 0.005, 1e-9);
}

TEST(Telescope, NothingMovesItWhileAShutterIsOpen) {
  Mount m;
  const Equatorial place = at_hour_angle(m.sky, -10.0, 30.0, {});
  const SimTime now = m.go_to(place, {}), during = now + at_s(1);
  m.telescope.hold_until(now + at_s(5));
  const auto refused = DeviceFault::invalid_operation;
  EXPECT_EQ(fault_of([&] { m.telescope.slew_to(place, during); }), refused);
  EXPECT_EQ(fault_of([&] { m.telescope.set_tracking(false, during); }), refused);
  EXPECT_EQ(fault_of([&] { m.telescope.set_rates(0.1, 0.0, during); }), refused);
  EXPECT_EQ(fault_of([&] { m.telescope.move_axis(0, 1.0, during); }), refused);
  EXPECT_EQ(fault_of([&] { m.telescope.park(during); }), refused);
  EXPECT_EQ(fault_of([&] { m.telescope.find_home(during); }), refused);
  EXPECT_EQ(fault_of([&] { m.telescope.pulse_guide(GuideDirection::east, at_s(1), during); }),
            refused);
  m.telescope.slew_to(place, now + at_s(5));
}

// A German mount looks west from the pier's east.
TEST(Telescope, TheSideOfThePierIsThatOfTheHourAngle) {
  Mount m;
  const Equatorial west = at_hour_angle(m.sky, 30.0, 30.0, {});
  const Equatorial east = at_hour_angle(m.sky, -30.0, 30.0, {});
  EXPECT_EQ(m.telescope.destination_side(west, {}), PierSide::east);
  EXPECT_EQ(m.telescope.destination_side(east, {}), PierSide::west);
  const SimTime now = m.go_to(east, {});
  EXPECT_EQ(m.telescope.side(now), PierSide::west);
  EXPECT_EQ(m.telescope.side(now + at_s(4 * 3600)), PierSide::west);  // until the next slew
  m.telescope.slew_to(east, now + at_s(4 * 3600));
  EXPECT_EQ(m.telescope.side(now + at_s(4 * 3600)), PierSide::east);
}

// Whether it tracks or stands, an exposure's image has the same axes: those of the mount.
TEST(Telescope, ImagesKeepTheirAxesWhenTrackingEnds) {
  Mount m;
  for (const double hour_angle_deg : {-50.0, 3.0, 35.0}) {
    for (const double dec_deg : {-10.0, 30.0, 70.0}) {
      const Equatorial place = at_hour_angle(m.sky, hour_angle_deg, dec_deg, at_s(0));
      Mount mount;
      const SimTime now = mount.go_to(place, {});
      const auto axes = [&](SimTime t) {
        CommandedExposure e{.start = t, .length = {2'000'000}};
        e.pointing = mount.telescope.pointing_during(t, t + e.length);
        const Vec<Itrs> place_m = itrs_from_geodetic(mount.sky.site);
        PointingScene scene{.time = t, .itrs_from_gcrs = mount.sky.itrs_from_gcrs(t)};
        scene.site = &mount.sky.site;
        scene.observer.position_m = scene.itrs_from_gcrs.inverse() * place_m;
        return aim(commanded_sensor(SensorConfig{}, e), scene);
      };
      const auto tracked = axes(now);
      mount.telescope.set_tracking(false, now);
      const auto fixed = axes(now);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(tracked.m[i][j], fixed.m[i][j], 1e-6);
    }
  }
}

// What crosses the south from west to east at 0.5 deg/s, 50 deg high.
TEST(Telescope, FollowsWhatMovesOverTheSky) {
  Mount m;
  const auto path = [](SimTime t) {
    return direction_of(Horizontal{pi + (50.0 - 0.5 * t.seconds()) * deg, 50.0 * deg});
  };
  EXPECT_EQ(fault_of([&] {
              m.telescope.follow([](SimTime) { return Vec<Enu>{0, 1, 0}; }, {});
            }),
            DeviceFault::invalid_value);  // on the horizon
  m.telescope.follow(path, {});
  EXPECT_TRUE(m.telescope.is_slewing(at_s(1)));
  EXPECT_TRUE(m.telescope.is_following());
  const SimTime there = at_s(60);
  ASSERT_FALSE(m.telescope.is_slewing(there));
  EXPECT_TRUE(m.telescope.is_tracking(there));
  EXPECT_NEAR(m.telescope.horizontal_place(there).azimuth_rad / deg, 200.0, 1e-9);
  EXPECT_EQ(fault_of([&] { m.telescope.set_rates(0.1, 0.0, there); }),
            DeviceFault::invalid_operation);
  EXPECT_EQ(fault_of([&] {
              m.telescope.sync_to({0.0, 0.0}, there);
            }),
            DeviceFault::invalid_operation);
  // The axis of an exposure is on the path in its middle, and moves as far as the path does.
  const SimTime end = there + at_s(2), middle = there + at_s(1);
  const CommandedPointing p = m.telescope.pointing_during(there, end);
  const Equatorial truly = equatorial_of(m.sky.gcrs(path(middle), middle));
  EXPECT_TRUE(p.follows);
  EXPECT_LT(apart_deg({p.longitude_deg, p.latitude_deg}, truly), 1e-9);
  const Equatorial ends{p.longitude_deg + p.longitude_rate_deg_per_s,
                        p.latitude_deg + p.latitude_rate_deg_per_s};
  EXPECT_LT(apart_deg(ends, equatorial_of(m.sky.gcrs(path(end), end))), 0.01);
  EXPECT_NEAR(apart_deg({p.longitude_deg, p.latitude_deg}, ends), 0.5 * std::cos(50.0 * deg), 0.01);
  m.telescope.abort_slew(end);
  EXPECT_FALSE(m.telescope.is_following());
  const Equatorial stays = m.telescope.place(end);
  EXPECT_LT(apart_deg(m.telescope.place(end + at_s(100)), stays), 1e-9);
}

// It sets at the limit, and the telescope stands there.
TEST(Telescope, StopsWhereASatelliteSets) {
  Mount m;
  m.telescope.follow(
      [](SimTime t) {
        return direction_of(Horizontal{pi / 2, std::max(5.0, 50.0 - t.seconds()) * deg});
      },
      {});
  EXPECT_TRUE(m.telescope.is_tracking(at_s(39)));
  EXPECT_FALSE(m.telescope.is_tracking(at_s(60)));
  EXPECT_NEAR(m.telescope.horizontal_place(at_s(60)).elevation_rad / deg, 10.0, 1e-6);
}

}  // namespace
}  // namespace dmise
