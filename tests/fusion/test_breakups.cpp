#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "core/base/units.h"
#include "core/fusion/fusion.h"
#include "core/orbit/two_body.h"
#include "core/products/product_json.h"
#include "core/time/iso8601.h"
#include "core/tracking/mean_elements_fit.h"
#include "tests/support/watched_orbit.h"

// A fusion that announces a breakup. Truth flies by core/forces, which tests/forces compares with
// Orekit.
namespace dmise {
namespace {

constexpr double an_hour_s = 3600.0, steps_s = 30.0;
constexpr double broke_s = 38000.0, watched_s = 24 * an_hour_s;

const Clock& winter_evening() {
  static const Clock clock(parse_utc("2018-12-24T22:00:00"));
  return clock;
}

OrbitState parent_state() {
  const auto s = state_of(KeplerElements{.periapsis_m = 7.185e6,
                                         .eccentricity = 0.001,
                                         .inclination_rad = 98.6 * deg,
                                         .raan_rad = 65 * deg,
                                         .argument_of_perigee_rad = 1.0,
                                         .true_anomaly_rad = 2.0});
  return {sim_seconds(broke_s), s.position_m, s.velocity_m_per_s, 0.02, 0.015};
}

/// Cameras alone, so that each frame is of the whole sky; of 3 arcsec, to magnitude 9.
std::vector<OrbitWatcher> cameras() {
  auto out = wide_network();
  std::erase_if(out, [](const OrbitWatcher& w) { return w.name.ends_with("-telescope"); });
  for (OrbitWatcher& camera : out) {
    camera.sigma_rad = 3 * arcsec;
    camera.limiting_magnitude = 9;
  }
  return out;
}

/// Detections of fragments that parted then with these changes of velocity, as frames.
std::map<SimTime, std::vector<SensorFrame>> frames_of(const std::vector<Vec<Gcrs>>& changes) {
  const MaintenanceForces forces(winter_evening(), SimTime{}, sim_seconds(watched_s + an_hour_s));
  std::map<std::tuple<SimTime, std::string>, SensorFrame> frames;
  std::uint32_t number = 0;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    OrbitState from = parent_state();
    from.velocity_m_per_s += changes[k];
    const auto path = *ArcPath::fly(forces, from, {}, sim_seconds(watched_s));
    const WatchedOrbit watched(winter_evening(),
                               [&](SimTime t) {
                                 const OrbitState s = path.at(t);
                                 return MotionState<Gcrs>{s.position_m, s.velocity_m_per_s};
                               },
                               path.start(), path.end(), {.radius_m = 2, .albedo = 0.3});
    for (const auto& pass : watched.passes(cameras(), {.seed = 10 + k}))
      for (const AngleObservation& seen : pass) {
        auto [at, is_new] = frames.try_emplace({seen.time, seen.sensor});
        SensorFrame& frame = at->second;
        if (is_new)
          frame = {.sensor = seen.sensor,
                   .frame = ++number,
                   .time = seen.time,
                   .sensor_m = seen.sensor_m,
                   .axis = unit(seen.sensor_m),
                   .half_angle_rad = 1.5,
                   .limiting_magnitude = 9};
        frame.sources.push_back({.observation = seen, .magnitude = 6.0});
        frame.sources.back().observation.detection_id = seen.sensor + "/" +
                                                        std::to_string(frame.frame) + "/" +
                                                        std::to_string(frame.sources.size() - 1);
      }
  }
  std::map<SimTime, std::vector<SensorFrame>> out;
  for (auto& [key, frame] : frames) out[std::get<0>(key)].push_back(std::move(frame));
  return out;
}

std::vector<FoundBreakup> announced(const std::vector<Vec<Gcrs>>& changes) {
  const ForceModel simple(winter_evening(), SimTime{});
  MeanElements parent = fit_mean_elements(winter_evening(), simple, parent_state())->elements;
  parent.catalogue_number = 7;
  parent.name = "PARENT";
  Fusion fusion({parent}, winter_evening(), sim_seconds(watched_s / 2), {.keep_orbits = true});
  const auto frames = frames_of(changes);
  std::vector<FoundBreakup> out;
  auto next = frames.begin();
  for (double t = broke_s; t <= watched_s; t += steps_s) {
    std::vector<SensorFrame> now;
    for (; next != frames.end() && next->first <= sim_seconds(t); ++next)
      now.insert(now.end(), next->second.begin(), next->second.end());
    const FusionTick tick = fusion.step(sim_seconds(t), std::move(now));
    out.insert(out.end(), tick.breakups.begin(), tick.breakups.end());
  }
  return out;
}

TEST(Breakups, AreAnnouncedWithTimePlaceAndParent) {
  const auto found = announced({{40, 30, -20}, {-35, 10, 40}, {5, -50, 10}, {-20, -20, -45}});
  ASSERT_FALSE(found.empty());
  const FoundBreakup& last = found.back();
  EXPECT_EQ(last.breakup, 1u);
  EXPECT_GE(last.members.size(), 3u);
  EXPECT_EQ(last.members.front().substr(0, 4), "new-");
  EXPECT_LT(std::fabs(last.time.seconds() - broke_s), 5 * last.time_sigma_s);
  EXPECT_LT(last.time_sigma_s, 120.0);
  EXPECT_EQ(last.parent, "7");
  EXPECT_EQ(last.parent_name, "PARENT");
  const double sigma_m = std::sqrt(last.covariance[0] + last.covariance[2] + last.covariance[5]);
  EXPECT_LT(norm(last.position_m - parent_state().position_m), 5 * sigma_m);
  EXPECT_GT(last.confidence, 0.99);
  const std::string line = to_json(last, [](SimTime) { return std::string("now"); });
  EXPECT_EQ(found_breakup_of(JsonRecord(line, "test:1")), last);
}

TEST(Breakups, TwoFragmentsAreNone) {
  EXPECT_TRUE(announced({{40, 30, -20}, {-35, 10, 40}}).empty());
}

}  // namespace
}  // namespace dmise
