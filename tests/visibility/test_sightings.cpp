#include "core/visibility/sightings.h"

#include <set>

#include "core/base/units.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"
#include "tests/visibility/watch.h"

namespace dmise {
namespace {

using test::Watch;

std::vector<MeanElements> population(std::size_t objects) {
  return synthetic_catalogue({.objects = objects, .seed = 1});
}

void expect_equal(const Sightings& fast, const Sightings& slow) {
  ASSERT_EQ(fast.seen.size(), slow.seen.size());
  for (std::size_t k = 0; k < fast.seen.size(); ++k) {
    ASSERT_EQ(fast.seen[k].object, slow.seen[k].object) << k;
    ASSERT_EQ(fast.seen[k].step, slow.seen[k].step) << k;
    ASSERT_EQ(fast.seen[k].range_m, slow.seen[k].range_m) << k;
    ASSERT_EQ(fast.seen[k].sunlit, slow.seen[k].sunlit) << k;
  }
}

// The whole catalogue of December 2019 over an hour and a half, every 10 s.
TEST(Sightings, SkippingWorkFindsWhatAskingForEveryObjectFinds) {
  const std::string path = test::data_path("tle/catalog_3le_2019-12-19_18470.txt.gz");
  DMISE_NEEDS_FILE(path);
  Watch watch(test::at_atlanta(test::flat_camera(74, 90)), read_catalogue(path).elements,
              "2019-12-20T00:00:00Z", 5400, 10);
  const Sightings fast = watch.sightings(), slow = watch.one_by_one();
  EXPECT_GT(slow.seen.size(), 50000u);
  expect_equal(fast, slow);
}

TEST(Sightings, TheSameForAFisheyeAMaskAndATiltedCamera) {
  SensorConfig tilted = test::at_atlanta(test::flat_camera(20, 10), 25.0);
  tilted.pointing = PointHorizon{.azimuth_deg = 200, .elevation_deg = 30};
  for (const SensorConfig& sensor : {test::at_atlanta(test::all_sky_camera(), 10.0), tilted}) {
    Watch watch(sensor, population(2000), "2018-01-20T06:00:00Z", 7200, 10);
    const Sightings slow = watch.one_by_one();
    EXPECT_GT(slow.seen.size(), 500u);
    expect_equal(watch.sightings(), slow);
  }
}

TEST(Sightings, TheSameForACameraOnTheStarsAndOneThatFollowsATarget) {
  for (const Pointing& pointing :
       {Pointing{PointSky{.ra_deg = 80, .dec_deg = 10}}, Pointing{PointTarget{"7"}}}) {
    SensorConfig sensor = test::at_atlanta(test::flat_camera(20, 20));
    sensor.pointing = pointing;
    const bool follows = std::holds_alternative<PointTarget>(pointing);
    constexpr std::size_t target = 6;  // 1300 km, up for a part of the time
    Watch watch(sensor, population(1000), "2018-01-20T06:00:00Z", 7200, 10, std::nullopt,
                follows ? std::optional<std::size_t>(target) : std::nullopt);
    const Sightings slow = watch.one_by_one();
    EXPECT_GT(slow.seen.size(), 100u) << follows;
    expect_equal(watch.sightings(), slow);
  }
}

TEST(Sightings, TheSameForACameraInOrbitThatTheEarthBlocks) {
  for (const Pointing& pointing :
       {Pointing{PointSky{.ra_deg = 80, .dec_deg = 10}}, Pointing{PointUp{}}}) {
    SensorConfig sensor{.name = "imager", .place = PlatformConfig{"3"}};
    sensor.camera.optics = test::flat_camera(60, 60);
    sensor.pointing = pointing;
    Watch watch(sensor, population(1000), "2018-01-20T06:00:00Z", 6000, 10, 0);
    const Sightings slow = watch.one_by_one();
    EXPECT_GT(slow.seen.size(), 1000u) << pointing.index();
    expect_equal(watch.sightings(), slow);
  }
}

TEST(Sightings, AnyNumberOfThreadsFindsTheSame) {
  const auto sensor = test::at_atlanta(test::flat_camera(74, 90));
  Watch one(sensor, population(3000), "2018-01-20T06:00:00Z", 7200, 10);
  Watch four(sensor, population(3000), "2018-01-20T06:00:00Z", 7200, 10, std::nullopt, std::nullopt,
             4);
  const Sightings a = one.sightings(), b = four.sightings();
  expect_equal(a, b);
  EXPECT_GT(a.intervals.size(), 100u);
  EXPECT_EQ(a.intervals, b.intervals);
}

/// Every sighting of `every_second` lies within one of the stays.
void expect_covered(const std::vector<VisibilityInterval>& intervals,
                    const std::vector<Sighting>& every_second) {
  auto interval = intervals.begin();
  for (const Sighting& s : every_second) {
    const SimTime t = sim_seconds(s.step);
    while (
        interval != intervals.end() &&
        (interval->object < s.object || (interval->object == s.object && interval->out_after < t)))
      ++interval;
    ASSERT_NE(interval, intervals.end()) << s.object << " at " << s.step << " s";
    EXPECT_TRUE(interval->object == s.object && interval->out_before <= t &&
                t <= interval->out_after)
        << s.object << " at " << s.step << " s";
  }
}

// What is found on a grid of one second, between the instants of a grid of one minute.
TEST(Sightings, AnObjectThatOnlyCrossesBetweenInstantsIsFound) {
  const auto sensor = test::at_atlanta(test::flat_camera(8, 8));
  Watch fine(sensor, population(4000), "2018-01-20T06:00:00Z", 7200, 1);
  Watch coarse(sensor, population(4000), "2018-01-20T06:00:00Z", 7200, 60);
  const Sightings found = coarse.sightings();
  std::set<std::pair<std::uint32_t, std::uint32_t>> at_instants;  // object, minute
  for (const Sighting& s : found.seen) at_instants.insert({s.object, s.step});
  std::size_t between = 0;
  for (const VisibilityInterval& s : found.intervals) {
    const auto minute = std::uint32_t(s.in_last.seconds() / 60);
    between += s.in_first.seconds() > minute * 60.0 && !at_instants.count({s.object, minute});
  }
  EXPECT_GT(between, 20u);
  expect_covered(found.intervals, fine.one_by_one().seen);
}

struct MovingCamera {
  const char* name;
  SensorConfig sensor;
  std::optional<std::size_t> platform, target;
};

/// One that keeps to the stars and one that follows a low object from the ground, and three ways to
/// point from a low orbit.
std::vector<MovingCamera> moving_cameras() {
  constexpr std::size_t low = 0, host = 2, other = 6;
  SensorConfig ground = test::at_atlanta(test::flat_camera(20, 20));
  SensorConfig space{.name = "imager", .place = PlatformConfig{"3"}};
  space.camera.optics = test::flat_camera(20, 20);
  std::vector<MovingCamera> all;
  ground.pointing = PointSky{.ra_deg = 80, .dec_deg = 10};
  all.push_back({"stars", ground, std::nullopt, std::nullopt});
  ground.camera.optics = test::flat_camera(60, 60);
  ground.pointing = PointTarget{"1"};
  all.push_back({"follows", ground, std::nullopt, low});
  space.pointing = PointUp{};
  all.push_back({"orbit, zenith", space, host, std::nullopt});
  space.pointing = PointSky{.ra_deg = 80, .dec_deg = 10};
  all.push_back({"orbit, stars", space, host, std::nullopt});
  space.pointing = PointTarget{"7"};
  all.push_back({"orbit, follows", space, host, other});
  return all;
}

TEST(Sightings, AMovingCameraHasTheSameStaysOnAnyGrid) {
  for (const MovingCamera& c : moving_cameras()) {
    const auto intervals = [&](double step_s) {
      Watch watch(c.sensor, population(800), "2018-01-20T06:00:00Z", 43200, step_s, c.platform,
                  c.target);
      return watch.sightings().intervals;
    };
    const auto every_10_s = intervals(10);
    EXPECT_GT(every_10_s.size(), 100u) << c.name;
    for (const double step_s : {60.0, 300.0, 3000.0, 3600.0})  // 3000 s: the last is 1200 s
      EXPECT_EQ(intervals(step_s), every_10_s) << c.name << ", " << step_s;
  }
}

TEST(Sightings, AMovingCameraMissesNothingBetweenInstantsAnHourApart) {
  for (const MovingCamera& c : moving_cameras()) {
    Watch hours(c.sensor, population(800), "2018-01-20T06:00:00Z", 10800, 3600, c.platform,
                c.target);
    Watch seconds(c.sensor, population(800), "2018-01-20T06:00:00Z", 10800, 1, c.platform,
                  c.target);
    const auto every_second = seconds.one_by_one().seen;
    EXPECT_GT(every_second.size(), 500u) << c.name;
    expect_covered(hours.sightings().intervals, every_second);
  }
}

TEST(Sightings, TheSameObjectIsFoundAsOftenAsItComesWithinAStep) {
  const auto sensor = test::at_atlanta(test::all_sky_camera(), 10.0);
  Watch day(sensor, population(300), "2018-01-20T06:00:00Z", 86400, 86400);
  const auto intervals = day.sightings().intervals;
  std::size_t again = 0;
  for (std::size_t k = 1; k < intervals.size(); ++k)
    again += intervals[k].object == intervals[k - 1].object;
  EXPECT_GT(again, 300u);
  Watch fine(sensor, population(300), "2018-01-20T06:00:00Z", 86400, 10);
  EXPECT_EQ(intervals, fine.sightings().intervals);
}

TEST(Sightings, TheCamerasOwnHostIsLeftOut) {
  auto elements = population(50);
  elements.push_back(elements[3]);  // a second element set of the host, at range 0
  SensorConfig sensor{.name = "imager", .place = PlatformConfig{"3"}};
  sensor.camera.optics = test::flat_camera(90, 90);
  sensor.pointing = PointUp{};
  Watch watch(sensor, elements, "2018-01-20T06:00:00Z", 600, 10, 3);
  for (const Sighting& s : watch.sightings().seen) {
    EXPECT_NE(s.object, 3u);
    EXPECT_NE(s.object, 50u);
    EXPECT_GT(s.range_m, 1.0);
  }
}

TEST(Sightings, ADecayedObjectLeavesWithItsCodeAndTakesNoOtherWithIt) {
  auto elements = population(50);
  const Sightings before =
      Watch(test::at_atlanta(test::all_sky_camera()), elements, "2018-01-20T06:00:00Z", 3600, 10)
          .sightings();
  MeanElements falling = elements[0];
  falling.bstar_per_earth_radius = 0.5;
  falling.mean_motion_rad_per_min = 16.4 * 2 * pi / 1440;
  falling.eccentricity = 0.0005;
  elements.push_back(falling);
  Watch watch(test::at_atlanta(test::all_sky_camera()), elements, "2018-01-20T06:00:00Z", 3600, 10);
  const Sightings after = watch.sightings();
  ASSERT_EQ(after.lost.size(), 1u);
  EXPECT_EQ(after.lost[0].object, 50u);
  EXPECT_NE(after.lost[0].code, Sgp4Code::ok);
  std::size_t others = 0;
  for (const Sighting& s : after.seen) others += s.object != 50;
  EXPECT_EQ(others, before.seen.size());
}

}  // namespace
}  // namespace dmise
