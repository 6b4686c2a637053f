#include "core/tracking/maintenance/pinch_search.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/base/numeric/rng.h"
#include "core/frames/earth_orientation.h"
#include "core/orbit/breakup/breakup_model.h"
#include "core/orbit/elements/catalogue.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/time/iso8601.h"
#include "core/tracking/maintenance/arc_fit.h"
#include "tests/support/data.h"

// Truth flies by core/forces, which tests/forces compares with Orekit;
// tests/reference/breakups_with_scipy.py has paths that scipy integrates.
namespace dmise {
namespace {

constexpr double an_hour_s = 3600.0;

const Clock& clock_2019() {
  static const Clock clock(parse_utc("2019-12-19T12:00:00"));
  return clock;
}

const MaintenanceForces& simple_forces() {
  static const MaintenanceForces out = [] {
    MaintenanceSettings settings;
    settings.gravity_degree = 4;
    return MaintenanceForces(clock_2019(), sim_seconds(-25 * an_hour_s),
                             sim_seconds(25 * an_hour_s), settings);
  }();
  return out;
}

const OrbitState parent_then{SimTime{}, {7158135.0, 0, 0}, {0, 468.6, 7447.7}};

/// An orbit as it is known when its object is first seen: with errors of 200 m and 0.2 m/s.
OrbitEstimate known_about(const OrbitState& truth, std::uint32_t number) {
  OrbitVector sigma;
  sigma << 200, 200, 200, 0.2, 0.2, 0.2, 0, 0;
  const RngKey key = rng_key(1, "known", number, "pinch search");
  OrbitVector off;
  for (int i = 0; i < orbit_size; ++i)
    off[i] = sigma[i] * normal_of(rng_word(key, std::uint32_t(i), 0));
  OrbitEstimate out{state_of(vector_of(truth) + off, truth.time)};
  out.covariance = sigma.array().square().matrix().asDiagonal();
  return out;
}

OrbitEstimate fragment(const BreakupPiece& piece, std::uint32_t number) {
  OrbitState from = parent_then;
  from.velocity_m_per_s +=
      piece.speed_m_per_s * Vec<Gcrs>{piece.direction[0], piece.direction[1], piece.direction[2]};
  const SimTime seen = sim_seconds(an_hour_s * (1 + 0.3 * number));
  return known_about(ArcPath::fly(simple_forces(), from, {}, seen)->at(seen), number);
}

TEST(PinchSearch, FindsWhereFragmentsWereOne) {
  const auto drawn = draw_pieces({.mass_kg = 900}, 3, "pinch search").pieces;
  PinchSearch search(simple_forces(), sim_seconds(-24 * an_hour_s));
  constexpr std::uint32_t count = 6;
  for (std::uint32_t k = 0; k < count; ++k) search.put(k, fragment(drawn[5 * k], k));
  // One that is not of them.
  OrbitState other = parent_then;
  other.position_m = {0, 7158135.0, 0};
  other.velocity_m_per_s = {-3000.0, 0, 6800.0};
  search.put(count, known_about(other, count));
  const auto point = search.of(count - 1);
  ASSERT_TRUE(point);
  ASSERT_EQ(point->members.size(), count);
  EXPECT_EQ(point->members.back(), count - 1);
  EXPECT_LT(std::fabs(point->time.seconds()), 5 * point->time_sigma_s);
  EXPECT_LT(point->time_sigma_s, 30.0);
  const Eigen::Vector3d off = eigen_of(point->position_m - parent_then.position_m);
  EXPECT_LT(off.dot(point->covariance.inverse() * off), 30.0);
  EXPECT_GT(point->confidence, 0.999);
  EXPECT_FALSE(search.of(count));
}

TEST(PinchSearch, ObjectsThatStayTogetherHaveNoSuchTime) {
  PinchSearch search(simple_forces(), sim_seconds(-24 * an_hour_s));
  for (std::uint32_t k = 0; k < 4; ++k) {
    OrbitState s = parent_then;
    s.position_m.y += 150.0 * k;
    search.put(k, known_about(s, k));
  }
  for (std::uint32_t k = 0; k < 4; ++k) EXPECT_FALSE(search.of(k)) << k;
}

TEST(PinchSearch, UnrelatedOrbitsHaveNone) {
  const std::string path = test::data_path("tle/catalog_3le_2019-12-19_18470.txt.gz");
  if (!test::exists(path)) DMISE_SKIP() << path;
  const auto all = read_catalogue(path, {.lenient = true}).elements;
  std::vector<MeanElements> some;
  for (std::size_t i = 0; i < all.size() && some.size() < 1000; i += 18) some.push_back(all[i]);
  ASSERT_EQ(some.size(), 1000u);
  const Sgp4Batch batch(some);
  const auto gcrs = earth_orientation(clock_2019(), SimTime{}).gcrs_from_teme(SimTime{});
  PinchSearch search(simple_forces(), sim_seconds(-24 * an_hour_s));
  const Utc now = clock_2019().utc(SimTime{});
  for (std::size_t i = 0; i < some.size(); ++i) {
    const double minutes = 1440 * ((now.jd1 - some[i].epoch_jd1) + (now.jd2 - some[i].epoch_jd2));
    const auto s = batch.propagate_one(i, minutes);
    search.put(i, known_about({SimTime{}, gcrs * s.position_m, gcrs * s.velocity_m_per_s},
                              std::uint32_t(i)));
  }
  std::size_t found = 0;
  for (std::size_t i = 0; i < some.size(); ++i) found += search.of(i).has_value();
  EXPECT_EQ(found, 0u);
}

TEST(PinchSearch, LeavesOutWhatHasNoPast) {
  PinchSearch search(simple_forces(), sim_seconds(-24 * an_hour_s));
  OrbitState falls = parent_then;
  falls.velocity_m_per_s = {7000.0, 0, 0};  // from the ground
  search.put(0, known_about(falls, 0));
  OrbitState early = parent_then;
  early.time = sim_seconds(-24 * an_hour_s);
  search.put(1, known_about(early, 1));
  OrbitEstimate unknown{parent_then};
  unknown.covariance = OrbitMatrix::Identity() * 1e20;
  search.put(2, unknown);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_FALSE(search.of(k)) << k;
}

}  // namespace
}  // namespace dmise
