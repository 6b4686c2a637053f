#include "core/fusion/pass_association.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/fusion/frame_pairs.h"
#include "core/time/iso8601.h"
#include "core/tracking/propagate.h"

namespace dmise {
namespace {

const Vec<Gcrs> station_m{6.37e6, 0, 0}, station_m_per_s{0, 464, 0};
const Clock& pass_clock() {
  static const Clock clock(parse_utc("2018-12-24T22:00:00"));
  return clock;
}
const ForceModel& pass_forces() {
  static const ForceModel out(pass_clock(), SimTime{});
  return out;
}

OrbitEstimate orbit_believed() {
  OrbitEstimate out{{SimTime{}, {7.0e6, 5e5, 4e5}, {-800, 5200, 5300}}};
  OrbitVector sigma;
  sigma << 300, 300, 300, 0.3, 0.3, 0.3, 0, 0;
  out.covariance = sigma.array().square().matrix().asDiagonal();
  return out;
}

OrbitEstimate moved_by(double east_m, double north_m) {
  OrbitEstimate out = orbit_believed();
  out.state.position_m += Vec<Gcrs>{0, east_m, north_m};
  return out;
}

SeenMotion seen_of(const OrbitEstimate& truth, const char* id) {
  const PredictedMotion there = predict_motion(truth, station_m, station_m_per_s, truth.state.time);
  SeenMotion out{{.time = truth.state.time,
                  .sensor_m = station_m,
                  .direction = there.direction.direction,
                  .covariance_rad2 = {1e-8, 0, 1e-8}}};
  out.observation.detection_id = id;
  out.rate_rad_per_s = there.rate_rad_per_s;
  out.rate_sigma_rad_per_s = 1e-5;
  return out;
}

PassExposure exposure_of(std::vector<SeenMotion> sources, std::vector<OrbitEstimate> others) {
  PassExposure out{.time = {}, .sensor_m = station_m, .sensor_m_per_s = station_m_per_s};
  out.sources = std::move(sources);
  out.others = std::move(others);
  return out;
}

PassArc arc_of(const PassExposure& e) {
  return *associate_pass(pass_forces(), orbit_believed(), std::span(&e, 1));
}

TEST(FramePairs, CountsWhatElseMayHaveMadeASource) {
  FramePairs pairs(0.9, 2.0);
  pairs.add(0, 0, 1.0, -20, 1.0);
  pairs.add(0, 1, 4.0, -20, 0.5);
  pairs.add(1, 1, 9.0, -20, 0.5);
  const auto columns = pairs.assigned(3, 2);
  EXPECT_EQ(columns, (std::vector<std::size_t>{0, 1, unassigned}));
  const auto others = pairs.others(columns);
  EXPECT_NEAR(others[0], 2 + 0.9 * 0.5 * std::exp(8.0), 1e-9);
  EXPECT_EQ(others[1], 2.0);
  EXPECT_NEAR(pairs.likelihood(0, 0), 0.9 * std::exp(9.5), 1e-9);
  EXPECT_EQ(pairs.likelihood(1, 0), 0.0);
}

TEST(PassAssociation, TakesItsOwnBesideAnother) {
  const PassArc arc = arc_of(
      exposure_of({seen_of(moved_by(20e3, -5e3), "other"), seen_of(moved_by(200, 100), "own")},
                  {moved_by(20e3, -5e3)}));
  ASSERT_EQ(arc.observations.size(), 1u);
  EXPECT_EQ(arc.observations[0].detection_id, "own");
  EXPECT_EQ(arc.ambiguous, 0u);
}

TEST(PassAssociation, RefusesWhatMayBeEithers) {
  const PassArc arc =
      arc_of(exposure_of({seen_of(moved_by(200, 100), "own")}, {moved_by(600, 300)}));
  EXPECT_TRUE(arc.observations.empty());
  EXPECT_EQ(arc.ambiguous, 1u);
}

TEST(PassAssociation, ARateTellsWhatADirectionDoesNot) {
  OrbitEstimate crossing = moved_by(300, 0);
  crossing.state.velocity_m_per_s = {-800, 5200, -5300};
  const PassExposure e = exposure_of({seen_of(crossing, "crossing")}, {});
  EXPECT_TRUE(arc_of(e).observations.empty());
  EXPECT_EQ(associate_pass(pass_forces(), orbit_believed(), std::span(&e, 1), {.rates = false})
                ->observations.size(),
            1u);
}

TEST(PassAssociation, AFieldShowsNothingBeyondIt) {
  PassExposure e = exposure_of({seen_of(moved_by(900, 0), "own")}, {});
  e.half_angle_rad = 0.01 * deg;
  EXPECT_TRUE(arc_of(e).observations.empty());
  e.half_angle_rad = 1 * deg;
  EXPECT_EQ(arc_of(e).observations.size(), 1u);
}

TEST(PassAssociation, LooksWhereAManoeuvreMayHaveLed) {
  const MaintenanceForces kept(pass_clock(), SimTime{}, sim_seconds(20000), {.gravity_degree = 8});
  OrbitEstimate known = orbit_believed();
  known.covariance *= 1e-3;
  const CatalogueObject object(kept, known);
  OrbitEstimate changed = orbit_believed();
  changed.state.velocity_m_per_s += 0.5 * unit(changed.state.velocity_m_per_s);
  const SimTime later = sim_seconds(10000);
  auto truth = move_on(kept, changed, later);
  ASSERT_TRUE(truth);
  PassExposure e{
      .time = later, .sensor_m = unit(truth->state.position_m) * 6.37e6, .sensor_m_per_s = {}};
  SeenMotion seen = seen_of(*truth, "own");
  const PredictedMotion there = predict_motion(*truth, e.sensor_m, {}, later);
  seen.observation.sensor_m = e.sensor_m;
  seen.observation.direction = there.direction.direction;
  seen.rate_rad_per_s = there.rate_rad_per_s;
  e.sources = {seen};
  EXPECT_TRUE(associate_pass(kept, object, std::span(&e, 1), {.manoeuvre_m_per_s = 0})
                  ->observations.empty());
  const auto arc = associate_pass(kept, object, std::span(&e, 1));
  ASSERT_TRUE(arc);
  EXPECT_EQ(arc->observations.size(), 1u);
  EXPECT_TRUE(arc->after_a_manoeuvre);
}

}  // namespace
}  // namespace dmise
