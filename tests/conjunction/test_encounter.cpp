#include "core/conjunction/encounter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

Eigen::Matrix3d symmetric(double xx, double xy, double xz, double yy, double yz, double zz) {
  Eigen::Matrix3d out;
  out << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return out;
}

// Reference: NASA CARA Analysis Tools, PcCircle_UnitTest.m, case 1: 2.706023476569787e-05.
TEST(CollisionProbability, AgreesWithCara) {
  const Eigen::Vector3d r1(378.39559, 4305.721887, 5752.767554),
      v1(2.360800244, 5.580331936, -4.322349039), r2(374.5180598, 4307.560983, 5751.130418),
      v2(-5.388125081, -3.946827739, 3.322820358);
  const Eigen::Matrix3d c1 = symmetric(44.5757544811362, 81.6751751052616, -67.8687662707124,
                                       158.453402956163, -128.616921644857, 105.490542562701),
                        c2 = symmetric(2.31067077720423, 1.69905293875632, -1.4170164577661,
                                       1.24957388457206, -1.04174164279599, 0.869260558223714);
  const double p = collision_probability(1e3 * (r2 - r1), 1e3 * (v2 - v1), 1e6 * (c1 + c2), 20);
  EXPECT_NEAR(p / 2.706023476569787e-05, 1, 1e-5);
}

// Reference: Alfano 2009, Satellite Conjunction Monte Carlo Analysis, case 5, as CARA has it
// (AlfanoTestCase05.cdm, radial, transverse, normal); the plane's integral by CARA 4.44873860e-02.
TEST(CollisionProbability, AgreesWithAlfanosFifthCase) {
  const Eigen::Vector3d r(1.008140, -2.117599, 0.706652), v(-0.300002, -0.001116, 0.424270);
  const Eigen::Matrix3d c = symmetric(4.777224467280041e-01, -8.519384381202406e+01, 0,
                                      1.580759742365653e+04, 0, 7.845896810140191e-02) +
                            symmetric(4.710007645702890e-01, -8.457040115987763e+01, 0,
                                      1.580846029392646e+04, 0, 7.846753355604119e-02);
  EXPECT_NEAR(collision_probability(r, v, c, 10) / 4.44873860e-02, 1, 1e-3);
}

// In closed form: equal errors about the middle, 1 - exp(-R^2 / 2 sigma^2).
TEST(CollisionProbability, HasTheClosedFormsOfARoundDistribution) {
  const Eigen::Matrix3d c = 100 * Eigen::Matrix3d::Identity();
  for (const double radius : {0.01, 1.0, 10.0, 100.0})
    EXPECT_NEAR(collision_probability({0, 0, 0}, {0, 0, 7e3}, c, radius),
                -std::expm1(-radius * radius / 200), 1e-7)
        << radius;
}

TEST(CollisionProbability, IsNoneWithoutMotionOrSizeAndFarAway) {
  const Eigen::Matrix3d c = Eigen::Matrix3d::Identity();
  EXPECT_EQ(collision_probability({1, 0, 0}, {0, 0, 0}, c, 1), 0);
  EXPECT_EQ(collision_probability({1, 0, 0}, {0, 0, 1}, c, 0), 0);
  EXPECT_EQ(collision_probability({1e6, 0, 0}, {0, 0, 1}, c, 1), 0);
  EXPECT_NEAR(collision_probability({0.1, 0, 0}, {0, 0, 1}, Eigen::Matrix3d::Zero(), 1), 1, 1e-6);
}

TEST(Encounter, FindsTheClosestApproachInTheAxesOfTheFirst) {
  Encounter e;
  e.first.state = {.position_m = {7e6, 0, 0}, .velocity_m_per_s = {0, 7500, 0}};
  e.second.state = {.position_m = {7e6 + 100, 300, -50}, .velocity_m_per_s = {0, 0, 7500}};
  const RelativeMotion motion = relative_motion(e);
  EXPECT_NEAR(motion.position_m.x, 100, 1e-9);
  EXPECT_NEAR(motion.position_m.y, 300, 1e-9);
  EXPECT_NEAR(motion.position_m.z, -50, 1e-9);
  const double t = to_closest_s(e);
  const auto distance = [&](double at) {
    return norm(Vec<Rtn>{100, 300 - 7500 * at, -50 + 7500 * at});
  };
  EXPECT_LT(distance(t), distance(t - 1e-3));
  EXPECT_LT(distance(t), distance(t + 1e-3));
}

}  // namespace
}  // namespace dmise
