#include "core/tracking/angle_observation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/tracking/predict.h"

namespace dmise {
namespace {

Detection ground_detection() {
  Detection d;
  d.id = "atlanta/3/1";
  d.sensor = "atlanta";
  d.time = sim_seconds(12.5);
  d.corrected_ra_rad = 0.3;
  d.corrected_dec_rad = 0.5;
  d.covariance_rad2 = {4e-11, 1e-12, 5e-11};
  d.sensor_position_m = {5.2e6, 1e6, 3.5e6};
  return d;
}

TEST(AngleObservation, IsTheDirectionOfTheDetection) {
  const auto seen = angle_observation(ground_detection());
  ASSERT_TRUE(seen) << seen.reason;
  EXPECT_NEAR(to_spherical(seen->direction)[0], 0.3, 1e-15);
  EXPECT_NEAR(to_spherical(seen->direction)[1], 0.5, 1e-15);
  EXPECT_EQ(seen->sensor, "atlanta");
  EXPECT_EQ(seen->detection_id, "atlanta/3/1");
  EXPECT_EQ(seen->covariance_rad2, ground_detection().covariance_rad2);
}

// An object at a known range, measured as docs/wire.md says: seen norm(offset) / range too high,
// raised by the mean parallax less; the line must pass through the object.
TEST(AngleObservation, LineBeginsOutsideTheAir) {
  Detection d = ground_detection();
  const Vec<Gcrs> straight = from_spherical<Gcrs>(0.3, 0.5);
  const Vec<Gcrs> up = unit(d.sensor_position_m - straight * dot(d.sensor_position_m, straight));
  const double range_m = 900e3;
  d.refraction_offset_m = up * 2.5;
  const Vec<Gcrs> object = d.sensor_position_m + straight * range_m;
  // Outside the air the line begins 2.5 m higher and is parallel to what is measured.
  const Vec<Gcrs> measured = unit(object - d.sensor_position_m - d.refraction_offset_m);
  d.refraction_parallax_rad = 1.5e-6;
  d.refraction_parallax_sigma_rad = 1e-6;
  const Vec<Gcrs> raised = unit(measured + up * d.refraction_parallax_rad);
  const auto angles = to_spherical(raised);
  d.corrected_ra_rad = angles[0];
  d.corrected_dec_rad = angles[1];
  const SkyTangents tangents = sky_tangents(raised);
  const double e = dot(up, tangents.east), n = dot(up, tangents.north);
  d.covariance_rad2 = {4e-11 + 1e-12 * e * e, 1e-12 * e * n, 4e-11 + 1e-12 * n * n};
  const auto seen = angle_observation(d);
  ASSERT_TRUE(seen) << seen.reason;
  const Vec<Gcrs> to_object = object - seen->sensor_m;
  EXPECT_LT(norm(cross(to_object, seen->direction)), 1e-3);
  EXPECT_NEAR(seen->covariance_rad2[0], 4e-11, 1e-17);
  EXPECT_NEAR(seen->covariance_rad2[1], 0, 1e-17);
  EXPECT_NEAR(seen->covariance_rad2[2], 4e-11, 1e-17);
}

TEST(AngleObservation, RefusesWhatIsNoDirection) {
  Detection d = ground_detection();
  d.covariance_rad2 = {1e-11, 2e-11, 1e-11};
  EXPECT_EQ(angle_observation(d).reason, "the covariance is not positive definite");
  d = ground_detection();
  d.corrected_ra_rad = NAN;
  EXPECT_EQ(angle_observation(d).reason, "the direction is not a unit vector");
  d = ground_detection();
  d.sensor_position_m.x = INFINITY;
  EXPECT_EQ(angle_observation(d).reason, "the sensor's position is not known");
  d = ground_detection();
  d.refraction_offset_m.x = NAN;
  EXPECT_EQ(angle_observation(d).reason, "the offset of refraction is not finite");
}

TEST(AngleObservation, AnglesAreThoseOnTheSky) {
  for (const double dec : {-pi / 2, -1.2, 0.0, 0.7, pi / 2})
    for (const double ra : {0.0, 1.0, 6.2}) {
      const Vec<Gcrs> from = from_spherical<Gcrs>(ra, dec);
      const SkyTangents t = sky_tangents(from);
      EXPECT_NEAR(norm(t.east), 1, 1e-15);
      EXPECT_NEAR(norm(t.north), 1, 1e-15);
      EXPECT_NEAR(dot(t.east, t.north), 0, 1e-15);
      const Vec<Gcrs> to = unit(from + 3e-4 * t.east - 4e-4 * t.north);
      const Eigen::Vector2d angles = angles_between(from, to);
      EXPECT_NEAR(angles.norm(), angle_rad(from, to), 1e-15);
      EXPECT_NEAR(angles[0], 3e-4, 1e-9);
      EXPECT_NEAR(angles[1], -4e-4, 1e-9);
      EXPECT_NEAR(angles_between(from, -from).norm(), pi, 1e-15);
    }
}

// Derivatives of the prediction against differences of it.
TEST(Predict, CovarianceIsThatOfTheDirections) {
  OrbitEstimate estimate{{sim_seconds(10), {6.9e6, 1e6, 5e5}, {-1e3, 7e3, 2e3}}};
  const Vec<Gcrs> sensor{6.3e6, 8e5, 1e5};
  for (const double dt_s : {0.0, 2.0, -2.0}) {
    const SimTime time = sim_seconds(10 + dt_s);
    const PredictedDirection mean = predict_direction(estimate, sensor, time);
    for (int k = 0; k < 6; ++k) {
      OrbitEstimate one = estimate;
      const double step = k < 3 ? 10 : 0.1;
      one.covariance(k, k) = step * step;
      OrbitVector x = vector_of(estimate.state);
      x[k] += step;
      const PredictedDirection moved =
          predict_direction({state_of(x, estimate.state.time)}, sensor, time);
      const Eigen::Vector2d angles = angles_between(mean.direction, moved.direction);
      const Eigen::Matrix2d expected = angles * angles.transpose();
      const Eigen::Matrix2d found = predict_direction(one, sensor, time).covariance_rad2;
      EXPECT_LT((found - expected).norm(), 1e-3 * expected.norm() + 1e-22) << k << " " << dt_s;
    }
    // Rates by the same at another time.
    const PredictedDirection later = predict_direction(estimate, sensor, time + sim_seconds(0.01));
    EXPECT_LT(norm((later.direction - mean.direction) / 0.01 - mean.rate_rad_per_s),
              1e-3 * norm(mean.rate_rad_per_s));
    EXPECT_NEAR((later.range_m - mean.range_m) / 0.01, mean.range_rate_m_per_s, 1);
  }
}

}  // namespace
}  // namespace dmise
