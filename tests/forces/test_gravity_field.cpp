#include "core/forces/gravity_field.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

// Reference: tests/reference/gravity_values.py (brahe 1.8).
TEST(GravityField, IsThatOfBraheAtAnyPlaceThePoleIncluded) {
  struct Row {
    Vec<Itrs> place_m;
    int degree;
    Vec<Itrs> expected_m_per_s2;
  };
  for (const Row& row : {
           Row{{6878137.0, 0.0, 0.0},
               2,
               {-8.4373769167789892, -3.9291683945551866e-05, -5.7976317475767753e-09}},
           Row{{6878137.0, 0.0, 0.0},
               20,
               {-8.4373516481631317, -2.539675420930661e-05, 4.4694115461139669e-05}},
           Row{{6878137.0, 0.0, 0.0},
               70,
               {-8.4373546238664083, -2.3361020632570497e-05, 2.9980386734176263e-05}},
           Row{{0.0, 0.0, 6778137.0},
               2,
               {-6.1474151621098211e-09, 4.1190358771413441e-08, -8.6510002346761219}},
           Row{{0.0, 0.0, 6778137.0},
               20,
               {9.9623339330618215e-05, -2.7037556355576232e-05, -8.6511749462112704}},
           Row{{0.0, 0.0, 6778137.0},
               70,
               {0.00010164748650303492, -2.4291599659570387e-05, -8.6511606989752998}},
           Row{{-4069503.0, 2861786.0, -4483608.0},
               70,
               {5.389841595388412, -3.7904104688307885, 5.9560770072684166}},
           Row{{30000000.0, -28000000.0, 9000000.0},
               20,
               {-0.16127032718283882, 0.15051903294548682, -0.048384731101994788}},
       }) {
    const Vec<Itrs> a = GravityField(row.degree).acceleration_m_per_s2(row.place_m);
    // The coefficients have steps of 1e-15.
    EXPECT_LT(norm(a - row.expected_m_per_s2), 1e-12) << row.degree << " " << row.place_m.x;
  }
}

TEST(GravityField, OfDegree0IsAPointMass) {
  const Vec<Itrs> a = GravityField(0).acceleration_m_per_s2({0, 7e6, 0});
  EXPECT_DOUBLE_EQ(a.y, -3.986004415e14 / 49e12);
  EXPECT_EQ(a.x, 0);
}

TEST(GravityField, RefusesADegreeThatItHasNot) {
  for (const int degree : {-1, 1, 71}) EXPECT_THROW(GravityField{degree}, Error) << degree;
}

}  // namespace
}  // namespace dmise
