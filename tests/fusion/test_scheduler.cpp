#include "core/fusion/scheduler.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/base/units.h"
#include "core/orbit/two_body.h"
#include "core/tracking/predict.h"
#include "core/tracking/propagate.h"
#include "tests/support/cue_trial.h"

namespace dmise {
namespace {

const Clock evening(Utc{2458138.5, 0.0});  // an hour after sunset at the site
const Site site{32.0, -88.0, 200.0};
constexpr double tick_s = 5.0;

CuedSensor telescope(const std::string& name = "telescope") {
  return {.name = name,
          .site = site,
          .cue = {.slew_deg_per_s2 = 3.0},
          .half_angle_rad = 0.6 * deg,
          .exposure_s = 0.5,
          .cadence_s = 2.5};
}

/// An object on a circle 1000 km high that is in this direction of the site at 60 s, known as well
/// as said.
CueTarget target(std::uint32_t track, double azimuth_deg, double elevation_deg,
                 double sigma_m = 300.0) {
  const SimTime then = sim_seconds(60);
  const auto itrs_from_gcrs = earth_orientation(evening, then).itrs_from_gcrs(then);
  const Vec<Gcrs> here = itrs_from_gcrs.inverse() * itrs_from_geodetic(site);
  const double a = azimuth_deg * deg, e = elevation_deg * deg;
  const Vec<Enu> line{std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
  const Vec<Gcrs> direction = (enu_from_itrs(site) * itrs_from_gcrs).inverse() * line;
  const double r = 7378e3, b = dot(here, direction);
  const Vec<Gcrs> place = here + direction * (-b + std::sqrt(b * b + r * r - dot(here, here)));
  const Vec<Gcrs> north{0, 0, 1};
  const Vec<Gcrs> along = unit(cross(cross(place, north), place));
  CueTarget out{
      .track = track, .catalogue_number = 0, .name = {}, .magnitude = 6.0, .estimate = {}};
  out.estimate.state = {then, place, along * std::sqrt(earth_gm_m3_per_s2 / r)};
  const double v = sigma_m / 300;
  const OrbitVector sigmas{sigma_m, sigma_m, sigma_m, v, v, v, 0, 0};
  out.estimate.covariance = sigmas.array().square().matrix().asDiagonal();
  return out;
}

std::vector<Task> tasks_of(Scheduler& scheduler, std::span<const CueTarget> targets,
                           double now_s = 60) {
  return scheduler.step(sim_seconds(now_s), sim_seconds(now_s + 2 * tick_s),
                        sim_seconds(now_s + 3 * tick_s), targets);
}

Scheduler scheduler_of(std::vector<CuedSensor> sensors) {
  return {evening, {}, std::move(sensors), sim_seconds(600), 0.9};
}

Vec<Gcrs> path_point(const Task& task, std::size_t i) {
  return {task.path_m[3 * i], task.path_m[3 * i + 1], task.path_m[3 * i + 2]};
}

// Reference: of a round deviate 1 - exp(-r^2 / 2 s^2); of one without width erf(r / s sqrt 2); for
// standard deviations 1 and 2 scipy 1.10's dblquad (tests/reference/field_share.py).
TEST(Scheduler, TheEllipseOfAPredictionMayExceedTheField) {
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  for (const double r : {0.1, 1.0, 3.0})
    EXPECT_NEAR(probability_in_circle(covariance, r), 1 - std::exp(-r * r / 2), 1e-6);
  covariance << 1, 0, 0, 0;
  EXPECT_NEAR(probability_in_circle(covariance, 1.0), std::erf(1 / std::sqrt(2.0)), 1e-5);
  covariance << 2.5, 1.5, 1.5, 2.5;  // 1 and 4 along the diagonals
  EXPECT_NEAR(probability_in_circle(covariance, 0.5), 0.060131744, 1e-6);
  EXPECT_NEAR(probability_in_circle(covariance, 2.0), 0.590095329, 1e-6);
  EXPECT_NEAR(probability_in_circle(covariance, 4.0), 0.945454579, 1e-6);
  EXPECT_EQ(probability_in_circle(Eigen::Matrix2d::Zero(), 1.0), 1.0);
}

// Reference: P - P H' (H P H' + R)^-1 H P, Kalman's update, one exposure after the other.
TEST(Scheduler, TheGainIsThatOfTheUpdatesThatFollow) {
  const CueTarget t = target(1, 90, 60);
  Matrix6 covariance = t.estimate.covariance.topLeftCorner<6, 6>(), information = Matrix6::Zero();
  const double before = std::log(covariance.determinant());
  for (int k = 0; k < 3; ++k) {
    Eigen::Matrix<double, 2, 6> rows = Eigen::Matrix<double, 2, 6>::Zero();
    rows(0, 0) = 1e-6, rows(1, 1 + k % 2) = 1e-6, rows(0, 3) = 1e-5 * k;
    information += rows.transpose() * rows / (arcsec * arcsec);
    const Eigen::Matrix2d s =
        rows * covariance * rows.transpose() + arcsec * arcsec * Eigen::Matrix2d::Identity();
    covariance -= covariance * rows.transpose() * s.inverse() * rows * covariance;
  }
  const double gain = (before - std::log(covariance.determinant())) / 2;
  EXPECT_GT(gain, 1.0);
  EXPECT_NEAR(gain_nats(t.estimate, Matrix6::Zero(), information), gain, 1e-6 * gain);
  EXPECT_NEAR(gain_nats(t.estimate, information, information),
              gain_nats(t.estimate, Matrix6::Zero(), 2 * information) - gain, 1e-6);
}

TEST(Scheduler, TakesWhatIsKnownLeastAndSaysWhy) {
  Scheduler scheduler = scheduler_of({telescope()});
  const CueTarget targets[] = {target(3, 180, 60, 30), target(5, 185, 60, 1000),
                               target(8, 175, 60, 100)};
  const auto tasks = tasks_of(scheduler, targets);
  ASSERT_EQ(tasks.size(), 1u);
  const Task& task = tasks[0];
  EXPECT_EQ(task.track, 5u);
  EXPECT_EQ(task.id, 1u);
  EXPECT_EQ(task.candidates, 3u);
  EXPECT_EQ(task.runner_up, 8u);
  EXPECT_GT(task.gain_nats_per_s, task.runner_up_nats_per_s);
  EXPECT_NEAR(task.gain_nats_per_s, task.gain_nats / (task.end - task.start).seconds(), 1e-12);
  EXPECT_GT(task.detection_probability, 0.85);
}

// Times are those of the mount, exposures those of the sensor's grid; the path begins before the
// first and ends after the last, where the object is.
TEST(Scheduler, ATaskBeginsAfterTheDelayAndFollowsThePath) {
  Scheduler scheduler = scheduler_of({telescope()});
  const CueTarget targets[] = {target(1, 90, 50)};
  const auto tasks = tasks_of(scheduler, targets);
  ASSERT_EQ(tasks.size(), 1u);
  const Task& task = tasks[0];
  EXPECT_EQ(task.given, sim_seconds(60));
  EXPECT_EQ(task.start, sim_seconds(70));
  EXPECT_NEAR((task.on_target - task.start).seconds(), task.slew_s, 2e-3);
  EXPECT_NEAR(
      task.slew_s,
      turn_s(task.slew_rad, telescope().cue.slew_deg_per_s, telescope().cue.slew_deg_per_s2) + 2.0,
      1e-9);
  const CuedSensor sensor = telescope();
  EXPECT_GE(sensor.exposure_start(task.first_frame), task.on_target);
  EXPECT_LT(sensor.exposure_start(task.first_frame - 1), task.on_target);
  EXPECT_EQ(task.exposures, 3u);
  EXPECT_EQ(task.end, sensor.exposure_start(task.first_frame + 2) + sim_seconds(0.5));
  EXPECT_LT(task.path_start, task.on_target);
  const std::size_t points = task.path_m.size() / 3;
  EXPECT_GT(task.path_start + sim_seconds(double(points - 1) * task.path_step_s), task.end);
  const ForceModel forces(evening, {});
  for (const std::size_t i : {std::size_t(0), points - 1}) {
    const SimTime t = task.path_start + sim_seconds(double(i) * task.path_step_s);
    const auto there = propagate(forces, targets[0].estimate.state, t);
    ASSERT_TRUE(there);
    EXPECT_LT(norm(path_point(task, i) - there->position_m), 1.0);
  }
}

TEST(Scheduler, TwoSensorsShareTheTargets) {
  Scheduler scheduler = scheduler_of({telescope("a"), telescope("b")});
  const CueTarget targets[] = {target(1, 178, 60), target(2, 182, 60)};
  const auto tasks = tasks_of(scheduler, targets);
  ASSERT_EQ(tasks.size(), 2u);
  EXPECT_NE(tasks[0].track, tasks[1].track);
  EXPECT_NE(tasks[0].sensor, tasks[1].sensor);

  // One that is known far worse is worth both.
  Scheduler again = scheduler_of({telescope("a"), telescope("b")});
  const CueTarget one_bad[] = {target(1, 178, 60, 1e-3), target(2, 182, 60, 2000)};
  const auto both = tasks_of(again, one_bad);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].track, 2u);
  EXPECT_EQ(both[1].track, 2u);
  EXPECT_LT(both[1].gain_nats, both[0].gain_nats);
}

TEST(Scheduler, TiesGoToTheFirstNameAndTheLowerId) {
  CueTarget twin = target(4, 180, 60);
  twin.track = 2;
  const CueTarget targets[] = {target(4, 180, 60), twin};
  Scheduler scheduler = scheduler_of({telescope("b"), telescope("a")});
  const auto tasks = tasks_of(scheduler, targets);
  ASSERT_EQ(tasks.size(), 2u);
  EXPECT_EQ(tasks[0].sensor, "a");
  EXPECT_EQ(tasks[0].track, 2u);
  EXPECT_EQ(tasks[1].track, 4u);
}

TEST(Scheduler, LeavesAloneWhatTheSensorMayNotLookAt) {
  const auto none = [](const CuedSensor& sensor, const CueTarget& t) {
    Scheduler scheduler = scheduler_of({sensor});
    const CueTarget targets[] = {t};
    return tasks_of(scheduler, targets).empty();
  };
  CuedSensor low = telescope(), far_from_sun = telescope(), far_from_moon = telescope(),
             slow = telescope();
  EXPECT_FALSE(none(telescope(), target(1, 90, 50)));
  low.cue.min_elevation_deg = 65;
  EXPECT_TRUE(none(low, target(1, 90, 50)));
  far_from_sun.cue.sun_exclusion_deg = 180;
  EXPECT_TRUE(none(far_from_sun, target(1, 90, 50)));
  far_from_moon.cue.moon_exclusion_deg = 180;
  EXPECT_TRUE(none(far_from_moon, target(1, 90, 50)));
  slow.cue.slew_deg_per_s = 0.1;  // slower than the object
  EXPECT_TRUE(none(slow, target(1, 90, 50)));
  CueTarget faint = target(1, 90, 50);
  faint.magnitude = 20;
  EXPECT_TRUE(none(telescope(), faint));
  CueTarget doubtful = target(1, 90, 50);
  doubtful.existence = 1e-3;
  EXPECT_TRUE(none(telescope(), doubtful));
}

// An altazimuth mount: a path that leads over its zenith, or to the end of its azimuth's range, or
// above its highest elevation, is left to others.
TEST(Scheduler, KnowsTheLimitsOfTheAxes) {
  const auto task_of = [](CueSettings cue, const CueTarget& t) -> std::optional<Task> {
    CuedSensor sensor = telescope();
    sensor.cue = cue;
    sensor.cue.exposures = 8;
    Scheduler scheduler = scheduler_of({sensor});
    const CueTarget targets[] = {t};
    auto tasks = tasks_of(scheduler, targets);
    if (tasks.empty()) return std::nullopt;
    return tasks[0];
  };
  const CueSettings free = telescope().cue;
  CueSettings altazimuth = free;
  altazimuth.mount = MountKind::altazimuth;
  // Northwards, from 25 deg above the southern horizon: within half a minute far from the zenith.
  const CueTarget south = target(1, 180, 25), east = target(1, 90, 50), over = target(1, 180, 75);
  const auto easy = task_of(altazimuth, south);
  ASSERT_TRUE(easy);
  EXPECT_EQ(easy->exposures, 8u);
  ASSERT_TRUE(task_of(altazimuth, east));
  ASSERT_TRUE(task_of(free, over));
  EXPECT_EQ(task_of(free, over)->exposures, 8u);
  altazimuth.azimuth_deg_per_s = 1;  // near the zenith the azimuth turns by 180 deg
  const auto through = task_of(altazimuth, over);
  EXPECT_TRUE(!through || through->exposures < 8u);
  ASSERT_TRUE(task_of(altazimuth, south));
  EXPECT_GE(task_of(altazimuth, east)->slew_s, 90.0 - 30.0);  // from the south at 1 deg/s

  CueSettings low = free;
  low.greatest_elevation_deg = 45;
  EXPECT_TRUE(task_of(low, south));
  EXPECT_FALSE(task_of(low, over));

  altazimuth = free;
  altazimuth.mount = MountKind::altazimuth;
  altazimuth.azimuth_range_deg = {100, 270};
  EXPECT_TRUE(task_of(altazimuth, south));
  const auto to_the_end = task_of(altazimuth, east);  // it goes north
  EXPECT_TRUE(!to_the_end || to_the_end->exposures < 8u);
}

std::vector<Task> wished(Scheduler& scheduler, std::span<const CueTarget> targets,
                         std::vector<CueWish>& wishes, double now_s = 60) {
  return scheduler.step(sim_seconds(now_s), sim_seconds(now_s + 2 * tick_s),
                        sim_seconds(now_s + 3 * tick_s), targets, &wishes);
}

// The wished task is the one that the same sensor is given if it has no other choice.
TEST(Scheduler, GivesWhatIsWishedWhateverElseWouldTellMore) {
  const CueTarget targets[] = {target(3, 180, 60, 30), target(5, 185, 60, 1000)};
  Scheduler scheduler = scheduler_of({telescope("a"), telescope("b")});
  std::vector<CueWish> wishes{{.sensor = "b", .track = 3}};
  const auto tasks = wished(scheduler, targets, wishes);
  ASSERT_EQ(tasks.size(), 1u);
  EXPECT_EQ(wishes[0].obstacle, "");
  Scheduler alone = scheduler_of({telescope("b")});
  const auto expected = tasks_of(alone, std::span(targets).first(1));
  ASSERT_EQ(expected.size(), 1u);
  EXPECT_EQ(tasks[0].sensor, "b");
  EXPECT_EQ(tasks[0].track, 3u);
  EXPECT_EQ(tasks[0].first_frame, expected[0].first_frame);
  EXPECT_EQ(tasks[0].path_m, expected[0].path_m);
  EXPECT_EQ(tasks[0].gain_nats, expected[0].gain_nats);
}

TEST(Scheduler, AWishMaySayHowManyExposuresAndNeedsNoGain) {
  CuedSensor sensor = telescope();
  sensor.cue.min_gain_nats = 1e3;
  const CueTarget targets[] = {target(1, 90, 50)};
  Scheduler scheduler = scheduler_of({sensor});
  EXPECT_TRUE(tasks_of(scheduler, targets).empty());
  std::vector<CueWish> wishes{{.sensor = "telescope", .track = 1, .exposures = 5}};
  const auto tasks = wished(scheduler, targets, wishes);
  ASSERT_EQ(tasks.size(), 1u);
  EXPECT_EQ(tasks[0].exposures, 5u);
}

TEST(Scheduler, NothingIsWishedOfASensorThatIsNotNamed) {
  const CueTarget targets[] = {target(1, 90, 50)};
  Scheduler scheduler = scheduler_of({telescope()});
  std::vector<CueWish> none;
  EXPECT_TRUE(wished(scheduler, targets, none).empty());
  EXPECT_EQ(tasks_of(scheduler, targets).size(), 1u);
}

TEST(Scheduler, AWishThatCannotBeSaysWhy) {
  const auto obstacle = [](const CuedSensor& sensor, const CueTarget& t, double now_s = 60) {
    Scheduler scheduler = scheduler_of({sensor});
    std::vector<CueWish> wishes{{.sensor = "telescope", .track = 1}};
    EXPECT_TRUE(wished(scheduler, {&t, 1}, wishes, now_s).empty());
    return wishes[0].obstacle;
  };
  CuedSensor high = telescope(), low = telescope(), sunless = telescope(), moonless = telescope(),
             slow = telescope();
  high.cue.min_elevation_deg = 65;
  low.cue.greatest_elevation_deg = 30;
  sunless.cue.sun_exclusion_deg = moonless.cue.moon_exclusion_deg = 180;
  slow.cue.slew_deg_per_s = 0.1;
  const CueTarget east = target(1, 90, 50);
  EXPECT_EQ(obstacle(high, east), "it is below the least elevation");
  EXPECT_EQ(obstacle(telescope(), target(1, 90, -30)), "it is below the least elevation");
  EXPECT_EQ(obstacle(low, east), "it is above the greatest elevation");
  EXPECT_EQ(obstacle(sunless, east), "it is too near the Sun");
  EXPECT_EQ(obstacle(moonless, east), "it is too near the Moon");
  EXPECT_EQ(obstacle(slow, east), "it is faster than the mount");
  EXPECT_EQ(obstacle(telescope(), target(2, 90, 50)), "its path can't be predicted");
  EXPECT_EQ(obstacle(telescope(), east, 580), "the run ends before");
  EXPECT_EQ(obstacle(telescope(), east, 600), "the run ends before");

  Scheduler scheduler = scheduler_of({telescope()});
  std::vector<CueWish> wishes{{.sensor = "telescope", .track = 1}};
  EXPECT_EQ(wished(scheduler, {&east, 1}, wishes).size(), 1u);
  EXPECT_TRUE(wished(scheduler, {&east, 1}, wishes, 65).empty());
  EXPECT_EQ(wishes[0].obstacle, "it is busy");
}

// A prediction that is wider than the field tells less than its information would.
TEST(Scheduler, WhatMayLieOutsideTheFieldCountsForLess) {
  CuedSensor narrow = telescope();
  narrow.half_angle_rad = 0.05 * deg;
  const CueTarget targets[] = {target(1, 180, 60, 3000)};
  Scheduler wide = scheduler_of({telescope()}), small = scheduler_of({narrow});
  const auto seen = tasks_of(wide, targets), missed = tasks_of(small, targets);
  ASSERT_EQ(seen.size(), 1u);
  ASSERT_EQ(missed.size(), 1u);
  EXPECT_GT(seen[0].in_field, 0.99);
  EXPECT_LT(missed[0].in_field, 0.2);
  EXPECT_NEAR(missed[0].gain_nats / seen[0].gain_nats,
              missed[0].detection_probability / seen[0].detection_probability, 1e-9);
}

TEST(Scheduler, ASensorHasOneTaskAtATime) {
  Scheduler scheduler = scheduler_of({telescope()});
  const CueTarget targets[] = {target(1, 178, 60), target(2, 190, 55), target(3, 160, 70)};
  std::vector<Task> all;
  for (int k = 0; k < 12; ++k)
    for (Task& task : tasks_of(scheduler, targets, 60 + k * tick_s)) all.push_back(std::move(task));
  ASSERT_GT(all.size(), 2u);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_GE(all[i].start, all[i - 1].end);
    EXPECT_GE(all[i].start, all[i].given + sim_seconds(2 * tick_s));
    EXPECT_NE(all[i].track, all[i - 1].track);  // what the last one tells counts as known
  }
}

// Without pixels, with errors, misses and false alarms: what two sites find is cued and detected.
TEST(Scheduler, WhatTheSitesFindTheTelescopesDetect) {
  int tasks = 0, found = 0, better = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const CueOutcome& cue : cue_trial({.seed = seed, .ticks = 24})) {
      if (cue.exposures < 2) continue;
      ++tasks;
      const bool detected = cue.first_detection > 0 && cue.first_detection <= 2;
      found += detected;
      better += cue.sigma_after_m < cue.sigma_before_m;
    }
  EXPECT_GE(tasks, 6);
  EXPECT_GE(found, 0.8 * tasks);
  EXPECT_GE(better, 0.8 * tasks);
}

}  // namespace
}  // namespace dmise
