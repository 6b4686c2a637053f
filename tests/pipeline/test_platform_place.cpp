#include <algorithm>

#include "core/base/units.h"
#include "sensors/frame/make_sensor.h"
#include "tests/pipeline/wiring.h"

namespace dmise {
namespace {

/// A camera aboard a circular orbit that stands at its node at 12:00; a star of V = 4 in its field.
std::string in_orbit(const std::string& pointing, double exposure_s, const std::string& effects) {
  return test::scenario(
      "2018-03-06T12:00:00Z", exposure_s, "platform: bus", test::camera(400, 400, 0.1), pointing,
      exposure_s, exposure_s, ", sky: space, effects: {" + test::noiseless + effects + "}", "",
      "objects:\n  - name: bus\n    motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: "
      "0, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0}}\n    attitude: nadir\n" +
          test::with_stars);
}
const std::string near_star =
    "ra_deg,dec_deg,mag_v,bv,parallax_mas,pm_ra_mas_per_yr,pm_dec_mas_per_yr\n"
    "217.43,-62.68,4,0.65,0,0,0\n";

// Closed form (tests/reference/wiring.py): place and velocity on the circle 300 s on.
TEST(PlatformPlace, IsThatOfTheOrbitInMidExposure) {
  test::Stage stage(in_orbit("{ra_deg: 217.43, dec_deg: -62.68}", 600, ""), near_star);
  const auto frame = stage.frame();
  const Vec<Gcrs> place_m{6832823.442, -328915.713, 2174853.801};
  const Vec<Gcrs> velocity_m_per_s{-2283.45282, -1060.70673, 7013.59642};
  EXPECT_LT(norm(frame.header.sensor_position_m - place_m), 0.1);
  EXPECT_LT(norm(frame.header.sensor_velocity_m_per_s - velocity_m_per_s), 0.01);
  EXPECT_LT(norm(frame.report.sensor_velocity_m_per_s - velocity_m_per_s), 0.01);
}

// Reference: ERFA's eraPmpx, eraLdsun and eraAb with the orbit's velocity at that time, by
// tests/reference/wiring.py. From 300 to 600 s the star moves by 1.1 arcsec.
TEST(PlatformPlace, AStarIsSeenByTheVelocityOfItsTime) {
  test::Stage stage(in_orbit("{ra_deg: 217.43, dec_deg: -62.68}", 600, ""), near_star);
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const StarPlace star{.ra_rad = 217.43 * deg, .dec_rad = -62.68 * deg};
  const Vec<Gcrs> middle{-0.3644735457, -0.2790296919, -0.8884263985};
  const Vec<Gcrs> end{-0.3644784508, -0.2790276639, -0.8884250231};
  EXPECT_LT(angle_rad(view.places(sim_seconds(300)).star(star), middle), 2e-3 * arcsec);
  EXPECT_LT(angle_rad(view.places(sim_seconds(600)).star(star), end), 2e-3 * arcsec);
}

// Closed form: a nadir attitude turns by the orbit's rate, 0.010381 rad in 10 s, about the orbit's
// normal; a star at an angle from that leaves a trail shorter by its sine.
TEST(PlatformPlace, ACameraFixedToItsBodyTurnsWithTheOrbit) {
  test::Stage stage(in_orbit("{body: {boresight: [0, 0, -1], up: [1, 0, 0]}}", 10, ""), near_star);
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const auto at = [&](double t_s) { return view.camera_from_gcrs(sim_seconds(t_s)); };
  const Rotation<CameraFrame, CameraFrame> turn = at(10) * at(0).inverse();
  const double cosine = (turn.m[0][0] + turn.m[1][1] + turn.m[2][2] - 1) / 2;
  EXPECT_NEAR(std::acos(cosine), 0.010381289, 1e-7);
  EXPECT_LT(angle_rad(at(0).inverse() * Vec<CameraFrame>{0, 0, 1}, Vec<Gcrs>{1, 0, 0}), 1e-8);
}

// Without objects in its frames a camera on the ground still has to know where its target is.
TEST(PlatformPlace, WhoPointsAtAnObjectIsToldOfIt) {
  test::Stage stage(
      test::scenario("2018-03-06T12:00:00Z", 20, "site: atlanta", test::camera(8, 8, 0.1),
                     "{target: far}", 1, 5, ", effects: {objects: off}", "",
                     "objects:\n  - name: far\n    motion: {fixed: {gcrs_m: [4.2e+7, 0, 0]}}\n"));
  for (const bool propagates : {true, false}) {
    stage.scenario.network.sensors_propagate = propagates;
    const auto topics =
        make_sensor(stage.scenario, "a", "", stage.directory / "out", nullptr, stage.threads)
            ->consumes();
    EXPECT_EQ(std::count(topics.begin(), topics.end(), "state/roster"), propagates);
    EXPECT_EQ(std::count(topics.begin(), topics.end(), "state/objects"), !propagates);
  }
}

}  // namespace
}  // namespace dmise
