#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/time/iso8601.h"
#include "core/tracking/maintenance/catalogue_object.h"
#include "tests/support/watched_orbit.h"

// Orbits of a catalogue kept over days. Truth flies by core/forces, which tests/forces compares
// with Orekit; with precise orbits `dmise bench catalogue` compares.
namespace dmise {
namespace {

constexpr double hour_s = 3600.0, day_s = 86400.0;

const Clock& clock_2018() {
  static const Clock clock(parse_utc("2018-12-24T22:00:00"));
  return clock;
}

MaintenanceSettings quick() {
  MaintenanceSettings out;
  out.gravity_degree = 8;
  return out;
}

const MaintenanceForces& forces() {
  static const MaintenanceForces out(clock_2018(), SimTime{}, sim_seconds(3 * day_s), quick());
  return out;
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

OrbitEstimate believed_about(const OrbitState& truth, unsigned seed) {
  OrbitEstimate out{truth};
  OrbitVector sigma;
  sigma << 700, 700, 700, 0.5, 0.5, 0.5, 0.01, 0.01;
  out.covariance = sigma.array().square().matrix().asDiagonal();
  const double turn[] = {0.3, -0.8, 1.1, -0.5, 0.9, -0.2, 0.7, -0.4};
  OrbitVector off;
  for (int i = 0; i < orbit_size; ++i) off[i] = sigma[i] * turn[(i + int(seed)) % 8];
  out.state = state_of(vector_of(truth) + off, truth.time);
  return out;
}

/// The truth, with a change of velocity.
ArcPath flown(std::vector<VelocityChange> changes, double days) {
  return *ArcPath::fly(forces(), low_orbit(), changes, sim_seconds(days * day_s));
}

std::vector<std::vector<AngleObservation>> passes(const ArcPath& truth, std::uint64_t seed) {
  const WatchedOrbit watched(clock_2018(),
                             [&](SimTime t) {
                               const OrbitState s = truth.at(t);
                               return MotionState<Gcrs>{s.position_m, s.velocity_m_per_s};
                             },
                             truth.start(), truth.end(), {.radius_m = 2, .albedo = 0.3});
  return watched.passes(wide_network(), {.seed = seed});
}

TEST(ArcPath, HasTheDerivativesOfItsStates) {
  const ArcPath path = flown({}, 0.5);
  const SimTime end = path.end();
  const OrbitMatrix all = path.transition(end);
  const double steps[] = {10, 10, 10, 0.01, 0.01, 0.01, 0.005, 0.005};
  for (int column = 0; column < orbit_size; ++column) {
    OrbitVector by = OrbitVector::Zero();
    by[column] = steps[column];
    const auto at = [&](double sign) {
      const OrbitState from = state_of(vector_of(low_orbit()) + sign * by, SimTime{});
      return vector_of(ArcPath::fly(forces(), from, {}, end)->at(end));
    };
    const OrbitVector slope = (at(1) - at(-1)) / (2 * steps[column]);
    // Derivatives cross the edge of the shadow within steps of minutes.
    const double relative = column == srp_row ? 0.03 : 0.005;
    EXPECT_LT((slope - all.col(column)).head<3>().norm(), relative * slope.head<3>().norm())
        << column;
  }
}

TEST(ArcFit, PriorAloneIsTheEstimate) {
  const OrbitEstimate prior = believed_about(low_orbit(), 1);
  const auto fit = ArcFit::make(forces(), prior, {}, {});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->cost(), 0);
  const auto now = fit->estimate_at(SimTime{});
  ASSERT_TRUE(now);
  EXPECT_LT((now->covariance - prior.covariance).norm(), 1e-9 * prior.covariance.norm());
}

/// A direction that nobody has seen, so that a fit reaches its time.
AngleObservation unseen(SimTime time) {
  return {.time = time,
          .sensor_m = {6.4e6, 0, 0},
          .direction = {1, 0, 0},
          .covariance_rad2 = {1e-10, 0, 1e-10},
          .sensor = "none",
          .detection_id = "none/0/0"};
}

// Referee: flights whose manoeuvre is ten seconds earlier and later, by half an orbit.
TEST(ArcFit, HasTheDerivativeByTheTimeOfAManoeuvre) {
  constexpr double step_s = 10.0, sigma_s = 900.0;
  for (const double eccentricity : {0.001, 0.2, 0.7})
    for (const double at_s : {500.0, 2700.0, 9000.0})
      for (const Vec<Rtn>& change : {Vec<Rtn>{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0.4, 0.5, -0.7}}) {
        const auto s = state_of(KeplerElements{.periapsis_m = 7.185e6,
                                               .eccentricity = eccentricity,
                                               .inclination_rad = 1.1,
                                               .raan_rad = 0.4,
                                               .argument_of_perigee_rad = 1.0,
                                               .true_anomaly_rad = -0.3});
        const OrbitState start{SimTime{}, s.position_m, s.velocity_m_per_s};
        const SimTime end = sim_seconds(at_s + 3000);
        const auto at_end = [&](double late_s) {
          const VelocityChange burn{sim_seconds(at_s + late_s), change};
          return vector_of(ArcPath::fly(forces(), start, std::span(&burn, 1), end)->at(end));
        };
        OrbitEstimate prior = believed_about(start, 1);
        prior.state = start;
        const auto fit =
            ArcFit::make(forces(), prior, {unseen(end)}, {{{sim_seconds(at_s), change}, sigma_s}});
        ASSERT_TRUE(fit) << fit.reason;
        const OrbitVector slope = (at_end(step_s) - at_end(-step_s)) / (2 * step_s);
        const OrbitVector told =
            fit->path().transition(end) * fit->unknowns().back().effect / sigma_s;
        // What the change and the turning axes do may nearly cancel.
        const OrbitState there = fit->path().at(sim_seconds(at_s));
        const double turn_per_s = norm(there.velocity_m_per_s) / norm(there.position_m);
        const Eigen::Vector3d off_m = (told - slope).head<3>();
        const Eigen::Vector3d off_m_per_s = (told - slope).segment<3>(3);
        EXPECT_LT(off_m.norm(), 0.01 * std::max(norm(change), slope.head<3>().norm()))
            << eccentricity << " " << at_s << " " << change.x << " " << change.y;
        EXPECT_LT(off_m_per_s.norm(),
                  0.01 * std::max(turn_per_s * norm(change), slope.segment<3>(3).norm()))
            << eccentricity << " " << at_s << " " << change.x << " " << change.y;
      }
}

// The forces of the fit are those of the truth, so that its noise may be none.
TEST(CatalogueObject, KnowsItsErrorAfterADay) {
  MaintenanceSettings settings = quick();
  settings.noise = {.floor_m2_per_s3 = 1e-22, .drag_share = 0, .radiation_share = 0};
  const MaintenanceForces exact(clock_2018(), SimTime{}, sim_seconds(2 * day_s), settings);
  const ArcPath truth = flown({}, 1);
  double sum = 0;
  constexpr unsigned seeds = 10;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    CatalogueObject object(exact, believed_about(low_orbit(), 1));
    for (const auto& pass : passes(truth, seed)) {
      const auto news = object.take(pass);
      ASSERT_TRUE(news) << news.reason;
      EXPECT_FALSE(news->manoeuvre);
    }
    const auto end = object.estimate_at(truth.end());
    ASSERT_TRUE(end);
    EXPECT_LT(norm(end->state.position_m - truth.at(truth.end()).position_m), 200);
    sum += nees(*end, truth.at(truth.end()));
  }
  // Mean of 60 squared deviates: 6 +- 1.1.
  EXPECT_GT(sum / seeds, 6 - 3 * 1.1);
  EXPECT_LT(sum / seeds, 6 + 3 * 1.1);
}

TEST(CatalogueObject, FindsAManoeuvreItsTimeAndSize) {
  const VelocityChange change{sim_seconds(27 * hour_s), {0.0, 0.05, 0.01}};
  const ArcPath truth = flown({change}, 1.7);
  CatalogueObject object(forces(), believed_about(low_orbit(), 2));
  for (const auto& pass : passes(truth, 3)) ASSERT_TRUE(object.take(pass));
  ASSERT_EQ(object.manoeuvres().size(), 1u);
  const FoundManoeuvre& found = object.manoeuvres().front();
  EXPECT_GT(found.found, change.time);
  EXPECT_LT((found.found - change.time).seconds(), 12 * hour_s);
  EXPECT_NEAR(found.change.time.seconds(), change.time.seconds(), 4 * found.time_sigma_s + 60);
  EXPECT_NEAR(found.change.delta_v_m_per_s.y, 0.05, 4 * std::sqrt(found.covariance(1, 1)) + 1e-3);
  EXPECT_GT(found.confidence, 0.999);
  const auto end = object.estimate_at(truth.end());
  ASSERT_TRUE(end);
  EXPECT_LT(norm(end->state.position_m - truth.at(truth.end()).position_m), 300);
  EXPECT_LT(nees(*end, truth.at(truth.end())), 30);
}

// A change along the normal turns the plane about a line: half an orbit before or after, the
// opposite change has the same effect on all that follows.
TEST(CatalogueObject, TellsAllTimesAtWhichAManoeuvreMayHaveBeen) {
  const VelocityChange change{sim_seconds(27 * hour_s), {0.0, 0.0, 0.4}};
  const ArcPath truth = flown({change}, 1.7);
  CatalogueObject object(forces(), believed_about(low_orbit(), 2));
  for (const auto& pass : passes(truth, 3)) ASSERT_TRUE(object.take(pass));
  ASSERT_EQ(object.manoeuvres().size(), 1u);
  const FoundManoeuvre& found = object.manoeuvres().front();
  ASSERT_FALSE(found.modes.empty());
  double chances = 0, nearest = 1e9, off_sigmas = 1e9;
  for (const ManoeuvreMode& mode : found.modes) {
    chances += mode.chance;
    const double off_s = std::fabs((mode.change.time - change.time).seconds());
    const double d2 = off_s * off_s / (mode.time_sigma_s * mode.time_sigma_s);
    if (d2 > nearest) continue;
    nearest = d2;
    off_sigmas = (mode.change.delta_v_m_per_s.z - 0.4) / std::sqrt(mode.covariance(2, 2));
  }
  EXPECT_NEAR(chances, 1.0, 1e-12);
  EXPECT_LT(nearest, 25.0);
  EXPECT_LT(std::fabs(off_sigmas), 5.0);
  EXPECT_LE(std::fabs((found.change.time - change.time).seconds()), 5 * found.time_sigma_s);
}

TEST(CatalogueObject, GoesOnWithinItsWindowForDays) {
  const ArcPath truth = flown({}, 2.9);
  CatalogueObject object(forces(), believed_about(low_orbit(), 3));
  for (const auto& pass : passes(truth, 4)) ASSERT_TRUE(object.take(pass));
  EXPECT_TRUE(object.manoeuvres().empty());
  const auto end = object.estimate_at(truth.end());
  ASSERT_TRUE(end);
  EXPECT_LT(norm(end->state.position_m - truth.at(truth.end()).position_m), 200);
  EXPECT_LT(nees(*end, truth.at(truth.end())), 30);
}

TEST(CatalogueObject, RefusesWhatIsEarlyOrWrong) {
  CatalogueObject object(forces(), believed_about(low_orbit(), 1));
  EXPECT_EQ(object.take({}).reason, "there are no observations");
  AngleObservation seen = unseen(sim_seconds(-10));
  EXPECT_EQ(object.take({seen}).reason, "an observation is before the last");
  seen.time = sim_seconds(10);
  seen.direction.x = std::nan("");
  EXPECT_FALSE(object.take({seen}));
  EXPECT_EQ(object.time(), SimTime{});
}

TEST(ManoeuvreScan, ConfidenceFallsWithTheTimesThatWereTried) {
  EXPECT_NEAR(confidence_of(7.815, 1), 0.95, 2e-3);  // chi-square of 3 degrees, table
  EXPECT_LT(confidence_of(20, 100), confidence_of(20, 10));
  EXPECT_GT(confidence_of(40, 200), 0.9999);
}

}  // namespace
}  // namespace dmise
