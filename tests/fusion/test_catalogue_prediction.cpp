#include "core/fusion/catalogue_prediction.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

#include "core/base/units.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"

namespace dmise {
namespace {

const Utc start{2458138.5, 0.25};
const Clock evening(start);

/// On a circle 7378 km from the Earth's centre, its elements `age_days` old at the start.
MeanElements circle(double age_days) {
  MeanElements e;
  e.catalogue_number = 7;
  e.epoch_jd1 = start.jd1 - std::floor(age_days);
  e.epoch_jd2 = start.jd2 - (age_days - std::floor(age_days));
  e.mean_motion_rad_per_min = 60 * std::sqrt(3.986008e14 / std::pow(7378e3, 3));
  e.inclination_rad = 60 * deg;
  return e;
}

TEST(CataloguePrediction, IsKnownAsWellAsItsElementsAreOld) {
  FusionSettings settings;
  settings.catalogue_sigma_m = {200, 500, 100};
  settings.catalogue_sigma_m_per_day = {10, 300, 20};
  CataloguePrediction fresh({circle(0)}, evening, settings),
      old({circle(2.125)}, evening, settings);
  fresh.move({});
  old.move({});
  EXPECT_NEAR(fresh.sigma_m(0), 500, 1e-3);
  EXPECT_NEAR(old.sigma_m(0), 500 + 2.125 * 300, 1e-3);
}

// Reference: variances along the axes of the orbit; the velocity's are those times the mean motion,
// along the radius those along the motion.
TEST(CataloguePrediction, ItsCovarianceLiesAlongTheOrbit) {
  FusionSettings settings;
  settings.catalogue_sigma_m = {200, 500, 100};
  CataloguePrediction paths({circle(0)}, evening, settings);
  paths.move(sim_seconds(600));
  ASSERT_TRUE(paths.known(0));
  const OrbitEstimate estimate = paths.estimate(0);
  EXPECT_EQ(estimate.state.time, sim_seconds(600));
  EXPECT_EQ(estimate.state.position_m, paths.position_m(0));
  const Vec<Gcrs> r = paths.position_m(0), v = paths.velocity_m_per_s(0);
  const Eigen::Vector3d up = eigen_of(unit(r)), across = eigen_of(unit(cross(r, v)));
  const Eigen::Vector3d along = across.cross(up);
  const Eigen::Matrix3d place = estimate.covariance.topLeftCorner<3, 3>(),
                        speed = estimate.covariance.block<3, 3>(3, 3);
  const double days = 600.0 / 86400;
  const auto sigma = [](const Eigen::Matrix3d& p, const Eigen::Vector3d& axis) {
    return std::sqrt(axis.dot(p * axis));
  };
  EXPECT_NEAR(sigma(place, up), 200 + 100 * days, 1e-6);
  EXPECT_NEAR(sigma(place, along), 500 + 1000 * days, 1e-6);
  EXPECT_NEAR(sigma(place, across), 100 + 100 * days, 1e-6);
  EXPECT_NEAR(up.dot(place * along), 0, 1e-6);
  const double turn_rad_per_s = norm(v) / norm(r);
  EXPECT_NEAR(sigma(speed, up) / turn_rad_per_s, 500 + 1000 * days, 1.0);
  EXPECT_NEAR(sigma(speed, along) / turn_rad_per_s, 200 + 100 * days, 1.0);
}

TEST(CataloguePrediction, AnObjectWithoutAStateIsNotKnown) {
  MeanElements wrong = circle(0);
  wrong.eccentricity = 0.999;  // its perigee is in the Earth
  CataloguePrediction paths({circle(0), wrong}, evening, {});
  EXPECT_FALSE(paths.known(0));  // before it was moved
  paths.move({});
  EXPECT_TRUE(paths.known(0));
  EXPECT_FALSE(paths.known(1));
}

}  // namespace
}  // namespace dmise
