#include "core/orbit/sgp4/walker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/units.h"
#include "core/frames/vec.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/orbit/sgp4/sgp4_terms.h"
#include "core/orbit/two_body.h"

namespace dmise {
namespace {

const Walker galileo{.name = "GAL",
                     .first_number = 990000001,
                     .planes = 3,
                     .per_plane = 8,
                     .phasing = 1,
                     .semi_major_axis_m = 29600318.0,
                     .inclination_rad = 56 * deg,
                     .raan_spread_rad = 360 * deg,
                     .raan_rad = 25 * deg,
                     .argument_of_latitude_rad = 338.333 * deg,
                     .epoch = {2458139.5, 0.25}};
const Walker shell{.name = "S",
                   .first_number = 1,
                   .planes = 12,
                   .per_plane = 9,
                   .phasing = 5,
                   .semi_major_axis_m = 6928137.0,
                   .inclination_rad = 97.6 * deg,
                   .raan_spread_rad = 360 * deg,
                   .epoch = {2458139.5, 0.25}};

double off_deg(double angle_rad, double wanted_deg) {
  return std::remainder(angle_rad / deg - wanted_deg, 360.0);
}

/// Mean position of a circular orbit `angle_rad` after the epoch.
Vec<Teme> place_m(const MeanElements& e, double axis_m, double angle_rad) {
  const TwoBodyState s = state_of({.periapsis_m = axis_m,
                                   .inclination_rad = e.inclination_rad,
                                   .raan_rad = e.raan_rad,
                                   .true_anomaly_rad = e.mean_anomaly_rad + angle_rad});
  return {s.position_m.x, s.position_m.y, s.position_m.z};
}

// Galileo's reference constellation, Walker 24/3/1 at 56 deg: nodes 120 deg apart, places 45 deg, a
// plane 15 deg ahead of the one before (Galileo OS service definition; Walker 1984).
TEST(Walker, GalileoIsAsPublished) {
  const auto all = elements_of(galileo);
  ASSERT_EQ(all.size(), 24u);
  std::set<std::string> names;
  for (int plane = 0; plane < 3; ++plane)
    for (int place = 0; place < 8; ++place) {
      const MeanElements& e = all[std::size_t(8 * plane + place)];
      EXPECT_NEAR(off_deg(e.raan_rad, 25.0 + 120 * plane), 0, 1e-9);
      EXPECT_NEAR(off_deg(e.mean_anomaly_rad, 338.333 + 45 * place + 15 * plane), 0, 1e-9);
      EXPECT_EQ(e.inclination_rad, 56 * deg);
      EXPECT_EQ(e.eccentricity, 0.0);
      EXPECT_EQ(e.catalogue_number, 990000001u + unsigned(8 * plane + place));
      EXPECT_EQ(e.epoch_jd2, 0.25);
      names.insert(e.name);
    }
  EXPECT_EQ(names.size(), 24u);
  EXPECT_EQ(*names.begin(), "GAL-1-1");
  // The published period is 14 h 4 min 42 s.
  EXPECT_NEAR(2 * pi / all[0].mean_motion_rad_per_min * 60, 14 * 3600 + 4 * 60 + 42, 2);
}

// A satellite meets its neighbour in the next plane as closely as any other does, over the seam
// from the last plane to the first too.
TEST(Walker, DistancesOfNeighboursAreTheSameInAllPlanes) {
  const auto all = elements_of(shell);
  const auto closest_m = [&](int a, int b) {
    double closest = 1e9;
    for (int step = 0; step < 3600; ++step)
      closest = std::min(closest, norm(place_m(all[std::size_t(a)], 7e6, step * 0.1 * deg) -
                                       place_m(all[std::size_t(b)], 7e6, step * 0.1 * deg)));
    return closest;
  };
  const double first_m = closest_m(0, 9);
  for (int plane = 1; plane < 12; ++plane)
    for (int place = 0; place < 9; ++place) {
      // Beyond the last plane the first follows, of which the place is F further.
      const int next = plane == 11 ? (place + shell.phasing) % 9 : 9 * (plane + 1) + place;
      EXPECT_NEAR(closest_m(9 * plane + place, next), first_m, 10.0) << plane << " " << place;
    }
}

TEST(Walker, AStarSpreadsItsNodesOverHalfATurn) {
  Walker star = shell;
  star.raan_spread_rad = 180 * deg;
  const auto all = elements_of(star);
  for (int plane = 0; plane < 12; ++plane)
    EXPECT_NEAR(off_deg(all[std::size_t(9 * plane)].raan_rad, 15.0 * plane), 0, 1e-9);
  EXPECT_EQ(all.back().name, "S-12-9");
  EXPECT_EQ(all.front().name, "S-01-1");
}

TEST(Walker, TheSemiMajorAxisIsThatOfSgp4) {
  for (const double inclination_deg : {0.0, 53.0, 97.6})
    for (const double axis_m : {6.7e6, 6.928e6, 2.96e7, 4.2164e7}) {
      MeanElements e = elements_of(shell).front();
      e.inclination_rad = inclination_deg * deg;
      e.mean_motion_rad_per_min = kozai_mean_motion_rad_per_min(axis_m, e.inclination_rad);
      const auto model = sgp4::initialise(e);
      const double root = model.deep ? model.far.secular.sqrt_a0 : model.near.secular.sqrt_a0;
      EXPECT_NEAR(root * root * sgp4::earth_radius_m, axis_m, 1e-3);
    }
}

// All have the same plane but for the node, which turns by 5 deg a day: 0.1 deg in 30 minutes.
TEST(Walker, OfATrainTheNextIsWhereTheOneBeforeWas) {
  Walker train = shell;
  train.planes = 1;
  train.per_plane = 30;
  train.phasing = 0;
  train.inclination_rad = 53 * deg;
  train.spacing_s = 60.0;
  const auto all = elements_of(train);
  EXPECT_EQ(all.front().name, "S-01");
  const Sgp4Batch batch(all);
  for (const std::size_t k : {1u, 7u, 29u}) {
    const auto first = batch.propagate_one(0, 100.0),
               later = batch.propagate_one(k, 100.0 + double(k));
    EXPECT_NEAR(later.position_m.z, first.position_m.z, 1.0) << k;
    EXPECT_NEAR(norm(later.position_m), norm(first.position_m), 1.0) << k;
    EXPECT_LE(norm(later.position_m - first.position_m), 0.11 * deg * 6.9e6) << k;
  }
}

// What SGP4 adds to a mean orbit, by J2 and J3: 16.7 km at 550 km of height.
TEST(Walker, SatellitesAreWhereTheirMeanOrbitIs) {
  const auto all = elements_of(shell);
  const Sgp4Batch batch(all);
  double farthest_m = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto state = batch.propagate_one(k, 0.0);
    const Vec<Teme> sgp4_m{state.position_m.x, state.position_m.y, state.position_m.z};
    farthest_m = std::max(farthest_m, norm(sgp4_m - place_m(all[k], shell.semi_major_axis_m, 0.0)));
  }
  EXPECT_LE(farthest_m, 2e4);
}

}  // namespace
}  // namespace dmise
