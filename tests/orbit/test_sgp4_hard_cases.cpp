#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/orbit/sgp4_orbits.h"
#include "tests/support/simd.h"

namespace dmise {
namespace {

using namespace test;

class Sgp4HardCases : public testing::TestWithParam<SimdLevel> {};
INSTANTIATE_TEST_SUITE_P(Simd, Sgp4HardCases, testing::ValuesIn(simd_here()), simd_name);

struct Edge {
  double e, inclination_deg, rev_per_day, bstar, minutes;
  int code;
  double position_km[3];
  const char* name;
};
// Reference: python3-sgp4 2.15, by tests/reference/sgp4_hard_cases.py.
const Edge edges[] = {
#include "tests/orbit/sgp4_branches_reference.inc"
};

struct Failing {
  double e, inclination_deg, rev_per_day, bstar, minutes;
  int code;
  double radius_km;  // where the code is 0
  double a_km;       // Brouwer's semi-major axis
};
// Reference: the compiled sgp4 of PyPI, by tests/reference/sgp4_codes.py.
const Failing failing[] = {
#include "tests/orbit/sgp4_codes_reference.inc"
};

TEST_P(Sgp4HardCases, BothSidesOfEveryBranchEqualTheReference) {
  std::vector<MeanElements> elements;
  for (const Edge& c : edges)
    elements.push_back(elements_with(c.e, c.inclination_deg, c.rev_per_day, c.bstar));
  const Sgp4Batch batch(elements, nullptr, GetParam());
  for (std::size_t i = 0; i < std::size(edges); ++i) {
    const Edge& c = edges[i];
    const Sgp4State s = batch.propagate_one(i, c.minutes);
    EXPECT_EQ(int(s.code), c.code) << c.name << " at " << c.minutes;
    const double km = std::hypot(s.position_m.x * 1e-3 - c.position_km[0],
                                 s.position_m.y * 1e-3 - c.position_km[1],
                                 s.position_m.z * 1e-3 - c.position_km[2]);
    EXPECT_LE(km, 1e-8) << c.name << " at " << c.minutes;
  }
}

// Where the reference says 0 of a place farther than 2.2 a (1 + e), ours has a code of its own.
TEST_P(Sgp4HardCases, Codes1And2And3And4And6AreTheReferencesAndAbsurdRadiiHaveTheirOwn) {
  std::vector<MeanElements> elements;
  for (const Failing& c : failing)
    elements.push_back(elements_with(c.e, c.inclination_deg, c.rev_per_day, c.bstar));
  const Sgp4Batch batch(elements, nullptr, GetParam());
  int seen[8] = {};
  for (std::size_t i = 0; i < std::size(failing); ++i) {
    const Failing& c = failing[i];
    const bool absurd = c.code == 0 && c.radius_km > 2.2 * c.a_km * (1 + c.e);
    const Sgp4State s = batch.propagate_one(i, c.minutes);
    EXPECT_EQ(int(s.code), absurd ? int(Sgp4Code::absurd) : c.code) << i;
    ++seen[int(s.code)];
    if (s.code == Sgp4Code::ok) {
      EXPECT_NEAR(norm(s.position_m) / 1e3, c.radius_km, 1e-11 * c.radius_km + 1e-6) << i;
    } else {
      EXPECT_EQ(norm(s.position_m), 0.0);
    }
  }
  for (const int code : {0, 1, 2, 3, 4, 6, 7}) EXPECT_GT(seen[code], 0) << code;
}

TEST_P(Sgp4HardCases, ABadObjectLeavesTheOthersUntouchedToTheBit) {
  const std::vector<MeanElements> good = mixture(100);
  MeanElements no_motion = good[0], hyperbolic = good[1], not_a_number = good[2], falls = good[0];
  no_motion.mean_motion_rad_per_min = 0.0;
  hyperbolic.eccentricity = 1.2;
  not_a_number.inclination_rad = std::nan("");
  falls.bstar_per_earth_radius = 0.5;
  const std::vector<MeanElements> bad = {no_motion, hyperbolic, not_a_number, falls};
  std::vector<MeanElements> both;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < good.size(); ++i) {
    if (i % 3 == 0) both.push_back(bad[i / 3 % bad.size()]);
    place.push_back(both.size());
    both.push_back(good[i]);
  }
  const Outputs alone = at(Sgp4Batch(good, nullptr, GetParam()), epoch_jd1, 0.1);
  const Outputs mixed = at(Sgp4Batch(both, nullptr, GetParam()), epoch_jd1, 0.1);
  for (std::size_t i = 0; i < good.size(); ++i) {
    EXPECT_EQ(alone.code[i], mixed.code[place[i]]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(alone.position[i + axis * good.size()],
                mixed.position[place[i] + axis * both.size()]);
      EXPECT_EQ(alone.velocity[i + axis * good.size()],
                mixed.velocity[place[i] + axis * both.size()]);
    }
  }
  EXPECT_EQ(Sgp4Code(mixed.code[0]), Sgp4Code::mean_motion);
  EXPECT_EQ(Sgp4Code(mixed.code[4]), Sgp4Code::eccentricity);
  EXPECT_EQ(Sgp4Code(mixed.code[8]), Sgp4Code::absurd);
  EXPECT_NE(Sgp4Code(mixed.code[12]), Sgp4Code::ok);
}

TEST_P(Sgp4HardCases, StatesWithoutACodeAreFiniteAndNeitherUndergroundNorAbsurdlyFar) {
  const std::vector<MeanElements> elements = mixture(600);
  const Sgp4Batch batch(elements, nullptr, GetParam());
  const std::size_t n = batch.size();
  bool seen[8] = {};
  for (double days : {-400.0, -30.0, 0.0, 7.0, 30.0, 180.0, 400.0, 800.0, 4000.0, 1e6, 1e300}) {
    const Outputs out = at(batch, epoch_jd1 + days, 0.3);
    for (std::size_t i = 0; i < n; ++i) {
      const double r = std::hypot(out.position[i], out.position[i + n], out.position[i + 2 * n]);
      const double v = std::hypot(out.velocity[i], out.velocity[i + n], out.velocity[i + 2 * n]);
      seen[out.code[i]] = true;
      if (out.code[i] != 0) {
        EXPECT_EQ(r, 0.0);
        EXPECT_EQ(v, 0.0);
        continue;
      }
      const double a =
          std::cbrt(398600.8e9 / std::pow(elements[i].mean_motion_rad_per_min / 60, 2));
      EXPECT_GE(r, 6378135.0);
      EXPECT_LE(r, 2.15 * a * (1.0 + elements[i].eccentricity));
      EXPECT_TRUE(std::isfinite(v));
    }
  }
  EXPECT_TRUE(seen[0] && seen[1] && seen[6] && seen[7]);
}

}  // namespace
}  // namespace dmise
