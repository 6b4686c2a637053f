#include "core/orbit/breakup/breakup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/base/units.h"
#include "core/orbit/breakup/elements_at.h"
#include "core/orbit/sgp4/sgp4_batch.h"

namespace dmise {
namespace {

const Utc breakup_time{2458139.5, 0.25};

BreakupEvent collision_of(double mass_kg, double projectile_kg, double speed_m_per_s) {
  return {.kind = BreakupKind::collision,
          .structure = BrokenStructure::spacecraft,
          .mass_kg = mass_kg,
          .projectile_mass_kg = projectile_kg,
          .relative_speed_m_per_s = speed_m_per_s};
}

/// A circular orbit at 780 km of height, inclined by 86.4 deg.
Breakup breakup_of(const BreakupEvent& event) {
  return {.name = "b",
          .first_number = 990000001,
          .event = event,
          .parent = {{7158135.0, 0, 0}, {0, 468.6, 7447.7}},
          .epoch = breakup_time};
}

// Johnson et al. 2001: an explosion of S = 1 has 6 / 0.1^1.6 = 239 pieces over 10 cm. The collision
// of Iridium 33 (556 kg) and Cosmos 2251 (900 kg) at 11.7 km/s, of which 1632 pieces were
// catalogued by December 2009 (Wang 2010, Science & Global Security 18, 87), has 1209.
TEST(Breakup, NumbersAreThePapers) {
  const BreakupEvent stage{.mass_kg = 900};
  EXPECT_NEAR(pieces_over(stage, 0.1), 238.9, 0.1);
  EXPECT_NEAR(pieces_over(stage, 1.0), 6.0, 1e-9);
  const BreakupEvent cosmos = collision_of(900, 556, 11700);
  EXPECT_TRUE(is_catastrophic(cosmos));
  EXPECT_NEAR(pieces_over(cosmos, 0.1), 1209, 1);
  EXPECT_NEAR(1632 / pieces_over(cosmos, 0.1), 1.0, 0.4);
}

TEST(Breakup, FortyJoulesAGramAreCatastrophic) {
  // 1 kg at 10 km/s has 50 MJ: enough for 1250 kg.
  EXPECT_TRUE(is_catastrophic(collision_of(1249, 1, 1e4)));
  EXPECT_FALSE(is_catastrophic(collision_of(1251, 1, 1e4)));
  // M = 1 kg (10 km/s)^2 = 100: 0.1 * 100^0.75 = 3.162 over 1 m.
  EXPECT_NEAR(pieces_over(collision_of(5000, 1, 1e4), 1.0), 3.1623, 1e-3);
}

TEST(Breakup, PiecesWeighNoMoreThanWhatBroke) {
  for (const double mass_kg : {1.0, 50.0, 900.0}) {
    const BreakupEvent event{.mass_kg = mass_kg, .min_length_m = 0.05};
    const DrawnPieces drawn = draw_pieces(event, 3, "b");
    const double sum_kg =
        std::accumulate(drawn.pieces.begin(), drawn.pieces.end(), 0.0,
                        [](double sum, const BreakupPiece& p) { return sum + p.mass_kg; });
    EXPECT_LE(sum_kg, mass_kg);
    EXPECT_EQ(int(drawn.pieces.size()) + drawn.too_heavy, int(pieces_over(event, 0.05)));
    for (std::size_t k = 1; k < drawn.pieces.size(); ++k)
      ASSERT_GE(drawn.pieces[k - 1].length_m, drawn.pieces[k].length_m);
  }
}

TEST(Breakup, SeedsDrawAnew) {
  Breakup breakup = breakup_of({.mass_kg = 900});
  const auto first = fragments_of(breakup, 1, breakup_time).elements;
  EXPECT_EQ(first, fragments_of(breakup, 1, breakup_time).elements);
  EXPECT_NE(first, fragments_of(breakup, 2, breakup_time).elements);
  breakup.seed = 2;
  const auto stated = fragments_of(breakup, 1, breakup_time).elements;
  EXPECT_EQ(stated, fragments_of(breakup, 7, breakup_time).elements);
  EXPECT_NE(first, stated);
  std::set<std::string> names;
  for (const auto& e : first) names.insert(e.name);
  EXPECT_EQ(names.size(), first.size());
  EXPECT_EQ(first.front().name, "b-001");
  EXPECT_EQ(first.back().catalogue_number, 990000000 + first.size());
}

// All pieces are at one point at one instant, each with the speed that it was given.
TEST(Breakup, TenThousandPiecesBeginAtOnePoint) {
  BreakupEvent event = collision_of(2000, 100, 10000);
  event.min_length_m = 0.0372;
  const Breakup breakup = breakup_of(event);
  const Fragments made = fragments_of(breakup, 1, breakup_time);
  ASSERT_GT(made.elements.size(), 8000u);
  EXPECT_EQ(int(made.elements.size()) + made.open + made.no_path + made.too_heavy,
            breakup.fragment_count());
  EXPECT_GE(breakup.fragment_count(), 8600);
  EXPECT_LE(made.no_path, breakup.fragment_count() / 1000);
  const Sgp4Batch batch(made.elements);
  for (std::size_t k = 0; k < made.elements.size(); ++k) {
    const Sgp4State state = batch.propagate_one(k, 0.0);
    ASSERT_EQ(state.code, Sgp4Code::ok);
    ASSERT_LT(norm(state.position_m - breakup.parent.position_m), 1.0) << k;
    ASSERT_NEAR(norm(state.velocity_m_per_s - breakup.parent.velocity_m_per_s),
                made.pieces[k].speed_m_per_s, 1e-3);
    for (const double minutes : {1.0, 10.0, 100.0, 1440.0}) {
      const Sgp4State later = batch.propagate_one(k, minutes);
      ASSERT_TRUE(std::isfinite(norm(later.position_m)) &&
                  std::isfinite(norm(later.velocity_m_per_s)));
    }
  }
}

TEST(Breakup, WhatLeavesTheEarthOrEntersItIsCounted) {
  Breakup breakup = breakup_of({.mass_kg = 900});
  breakup.parent.velocity_m_per_s = {0, 800.0, 12000.0};
  const Fragments open = fragments_of(breakup, 1, breakup_time);
  EXPECT_TRUE(open.elements.empty());
  EXPECT_EQ(open.open + open.too_heavy, breakup.fragment_count());
  breakup.parent.velocity_m_per_s = {0, 400.0, 6000.0};
  const Fragments falling = fragments_of(breakup, 1, breakup_time);
  EXPECT_GT(falling.falling, int(falling.elements.size()) / 2);
  const Fragments later = fragments_of(breakup, 1, {2458140.5, 0.25});
  EXPECT_GT(later.decayed, falling.falling / 2);
  EXPECT_NE(describe(breakup, later).find("enter the Earth before the start"), std::string::npos);
}

// Circles, low and high perigees, orbits that turn back; at 180 deg elements are singular.
TEST(Breakup, ElementsOfClosedOrbitsPassThroughTheirStates) {
  std::vector<MotionState<Teme>> states;
  const auto add = [&](double distance_m, double inclination_deg, double excess) {
    const double speed = excess * std::sqrt(3.986008e14 / distance_m), i = inclination_deg * deg;
    states.push_back({{distance_m, 0, 0}, {0, speed * std::cos(i), speed * std::sin(i)}});
  };
  for (const double distance_m : {6.7e6, 7.2e6, 1.2e7, 2.66e7, 4.2164e7})
    for (const double inclination_deg : {3.5, 30.0, 63.4, 90.0, 150.0, 176.0})
      for (const double excess : {0.95, 0.99, 1.0, 1.01, 1.2})
        add(distance_m, inclination_deg, excess);
  for (const double inclination_deg : {0.0, 1e-9, 180.0})  // without Sun and Moon, near the Earth
    for (const double excess : {0.99, 1.0, 1.01}) add(7.2e6, inclination_deg, excess);
  std::vector<MeanElements> sets(states.size());
  const auto faults = fit_elements_at(breakup_time, states, sets);
  const Sgp4Batch batch(sets);
  for (std::size_t k = 0; k < states.size(); ++k) {
    EXPECT_EQ(faults[k], ElementsFault::none) << k;
    const Sgp4State there = batch.propagate_one(k, 0.0);
    EXPECT_LT(norm(there.position_m - states[k].position_m), 1.0) << k;
    EXPECT_LT(norm(there.velocity_m_per_s - states[k].velocity_m_per_s), 1e-3) << k;
  }
}

TEST(Breakup, WhatIsNoClosedOrbitIsSaidToBeOpen) {
  const std::vector<MotionState<Teme>> states{
      {{7e6, 0, 0}, {0, 11000, 0}}, {{7e6, 0, 0}, {5000, 0, 0}}, {{7e6, 0, 0}, {NAN, 0, 0}}};
  std::vector<MeanElements> sets(states.size());
  for (const auto fault : fit_elements_at(breakup_time, states, sets))
    EXPECT_EQ(fault, ElementsFault::open);
}

}  // namespace
}  // namespace dmise
