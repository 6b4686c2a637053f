#include "core/fusion/kept_orbits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/fusion/fusion.h"
#include "core/orbit/two_body.h"
#include "core/products/product_json.h"
#include "core/time/iso8601.h"
#include "core/tracking/mean_elements_fit.h"
#include "tests/support/watched_orbit.h"

// A fusion that keeps orbits. Truth flies by core/forces, which tests/forces compares with Orekit;
// what it knows beforehand is an element set, some hundred metres off.
namespace dmise {
namespace {

constexpr double hour_s = 3600.0, day_s = 86400.0;

const Clock& evening() {
  static const Clock clock(parse_utc("2018-12-24T22:00:00"));
  return clock;
}

/// 815 km high, polar, the plane where the evening is in the south.
OrbitState low_orbit() {
  const auto s = state_of(KeplerElements{.periapsis_m = 7.185e6,
                                         .eccentricity = 0.001,
                                         .inclination_rad = 98.6 * deg,
                                         .raan_rad = 65 * deg,
                                         .argument_of_perigee_rad = 1.0,
                                         .true_anomaly_rad = 2.0});
  return {SimTime{}, s.position_m, s.velocity_m_per_s, 0.02, 0.015};
}

/// An object on its path, and what a network detects of it.
struct Story {
  double days;
  MaintenanceForces forces{evening(), SimTime{} - sim_seconds(hour_s),
                           sim_seconds(days* day_s + hour_s)};
  ArcPath truth;
  std::vector<std::vector<AngleObservation>> passes;

  Story(double length_days, std::vector<VelocityChange> changes, std::uint64_t seed)
      : days(length_days),
        truth(*ArcPath::fly(forces, low_orbit(), changes, sim_seconds(days * day_s))) {
    const WatchedOrbit watched(evening(),
                               [&](SimTime t) {
                                 const OrbitState s = truth.at(t);
                                 return MotionState<Gcrs>{s.position_m, s.velocity_m_per_s};
                               },
                               truth.start(), truth.end(), {.radius_m = 2, .albedo = 0.3});
    passes = watched.passes(wide_network(), {.seed = seed});
  }

  std::vector<MeanElements> elements() const {
    const ForceModel simple(evening(), SimTime{});
    MeanElements out = fit_mean_elements(evening(), simple, low_orbit())->elements;
    out.catalogue_number = 7;
    return {out};
  }

  /// What a fusion keeps of the passes, of which each detection is a frame.
  std::vector<KeptOrbit> kept(std::vector<MeanElements> catalogue) const {
    Fusion fusion(std::move(catalogue), evening(), sim_seconds(days * day_s / 2),
                  {.keep_orbits = true});
    std::vector<KeptOrbit> out;
    std::uint32_t number = 0;
    const auto step = [&](SimTime time, std::vector<SensorFrame> frames) {
      const FusionTick tick = fusion.step(time, std::move(frames));
      out.insert(out.end(), tick.orbits.begin(), tick.orbits.end());
    };
    for (const auto& pass : passes) {
      for (const AngleObservation& seen : pass) {
        SensorFrame frame{.sensor = seen.sensor,
                          .frame = ++number,
                          .time = seen.time,
                          .sensor_m = seen.sensor_m,
                          .axis = seen.direction,
                          .half_angle_rad = 0.5,
                          .limiting_magnitude = 14};
        frame.sources.push_back({.observation = seen, .magnitude = 6.0});
        frame.sources[0].observation.detection_id =
            seen.sensor + "/" + std::to_string(number) + "/0";
        step(seen.time, {frame});
      }
      for (const double after_s : {310.0, 600.0, 910.0})
        step(pass.back().time + sim_seconds(after_s), {});
    }
    return out;
  }

  double error_m(const KeptOrbit& orbit) const {
    return norm(orbit.position_m - truth.at(orbit.time).position_m);
  }
};

double sigma_m(const KeptOrbit& orbit) {
  return std::sqrt(orbit.covariance[0] + orbit.covariance[2] + orbit.covariance[5]);
}

TEST(KeptOrbits, AnOrbitOfADayIsBetterThanItsElements) {
  const Story story(1.2, {}, 1);
  const auto kept = story.kept(story.elements());
  ASSERT_GT(kept.size(), 8u);
  for (const KeptOrbit& orbit : kept) {
    EXPECT_EQ(orbit.catalogue_number, 7u);
    EXPECT_EQ(orbit.object, "7");
    EXPECT_FALSE(orbit.manoeuvre) << orbit.time.seconds();
    EXPECT_LT(story.error_m(orbit), 4 * sigma_m(orbit));
  }
  EXPECT_LT(story.error_m(kept.back()), 100.0);
  EXPECT_EQ(kept.back().arcs, kept.size());
}

TEST(KeptOrbits, AManoeuvreIsFoundWithItsTimeAndSize) {
  const double at_h = 20.0, size_m_per_s = 0.5;
  const Story story(1.6, {{sim_seconds(at_h * hour_s), {0, size_m_per_s, 0}}}, 2);
  std::optional<KeptManoeuvre> found, revised;
  std::size_t manoeuvres = 0;
  for (const KeptOrbit& orbit : story.kept(story.elements())) {
    EXPECT_EQ(orbit.object, "7");
    const std::string line = to_json(orbit, [](SimTime) { return std::string("now"); });
    EXPECT_EQ(kept_orbit_of(JsonRecord(line, "test:1")), orbit);
    if (!orbit.revised.empty()) revised = orbit.revised.back();
    if (!orbit.manoeuvre) continue;
    ++manoeuvres;
    found = orbit.manoeuvre;
  }
  ASSERT_EQ(manoeuvres, 1u);
  EXPECT_LT((found->found - sim_seconds(at_h * hour_s)).seconds(), 12 * hour_s);
  EXPECT_GT(found->found, sim_seconds(at_h * hour_s));
  EXPECT_LT(std::fabs((found->time - sim_seconds(at_h * hour_s)).seconds()),
            4 * found->time_sigma_s);
  EXPECT_GT(found->confidence, 0.99);
  // Later arcs tell more of it.
  ASSERT_TRUE(revised);
  EXPECT_EQ(revised->found, found->found);
  EXPECT_LT(revised->time_sigma_s, found->time_sigma_s);
  EXPECT_LT(std::fabs((revised->time - sim_seconds(at_h * hour_s)).seconds()),
            4 * revised->time_sigma_s);
}

TEST(KeptOrbits, WhatIsInNoCatalogueIsOneObjectFromPassToPass) {
  const Story story(1.2, {}, 3);
  const auto kept = story.kept({});
  ASSERT_GT(kept.size(), 4u);
  for (const KeptOrbit& orbit : kept) {
    EXPECT_EQ(orbit.catalogue_number, 0u);
    EXPECT_EQ(orbit.object, kept.front().object);
  }
  EXPECT_LT(story.error_m(kept.back()), 200.0);
}

}  // namespace
}  // namespace dmise
