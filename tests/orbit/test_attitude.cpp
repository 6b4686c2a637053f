#include "core/orbit/attitude.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

const AttitudeScene scene{.time_s = 100.0,
                          .position_m = {4e6, -5e6, 3e6},
                          .velocity_m_per_s = {5e3, 4.2e3, 1e3},
                          .sun_m = {1e11, 1.1e11, -0.4e11}};

void expect_rotation(const Rotation<Gcrs, Body>& r) {
  const Vec<Gcrs> x = r * Vec<Body>{1, 0, 0}, y = r * Vec<Body>{0, 1, 0},
                  z = r * Vec<Body>{0, 0, 1};
  EXPECT_NEAR(norm(x), 1, 1e-14);
  EXPECT_NEAR(norm(y), 1, 1e-14);
  EXPECT_NEAR(dot(x, y), 0, 1e-14);
  EXPECT_LE(norm(cross(x, y) - z), 1e-14);
}

TEST(Attitude, NadirLooksDownAndForward) {
  const auto r = gcrs_from_body(NadirAttitude{}, scene);
  expect_rotation(r);
  EXPECT_NEAR(angle_rad(r * Vec<Body>{0, 0, 1}, -scene.position_m), 0, 1e-15);
  const Vec<Gcrs> normal = cross(scene.position_m, scene.velocity_m_per_s);
  EXPECT_NEAR(angle_rad(r * Vec<Body>{0, 1, 0}, -normal), 0, 1e-14);
  EXPECT_GT(dot(r * Vec<Body>{1, 0, 0}, scene.velocity_m_per_s), 0);
}

TEST(Attitude, SunYawPutsTheHingeSquareToTheSunSoThatThePanelFacesIt) {
  const auto r = gcrs_from_body(SunYawAttitude{}, scene);
  expect_rotation(r);
  const Vec<Body> sun = unit(r.inverse() * (scene.sun_m - scene.position_m));
  EXPECT_NEAR(sun.y, 0, 1e-15);
  const SunTrackingPanel panel;
  const Vec<Body> normal = body_from_panel(panel, sun) * Vec<Panel>{0, 0, 1};
  EXPECT_NEAR(angle_rad(normal, sun), 0, 1e-14);
}

TEST(Attitude, DegenerateDirectionsStillGiveARotation) {
  AttitudeScene up = scene;
  up.velocity_m_per_s = scene.position_m * 1e-3;
  expect_rotation(gcrs_from_body(NadirAttitude{}, up));
  up.velocity_m_per_s = {};
  expect_rotation(gcrs_from_body(NadirAttitude{}, up));
  up.sun_m = scene.position_m * 1e5;
  expect_rotation(gcrs_from_body(SunYawAttitude{}, up));
  AttitudeScene centre;
  EXPECT_THROW(gcrs_from_body(NadirAttitude{}, centre), Error);
}

TEST(Attitude, InertialStaysAndSpinningTurnsAtItsRate) {
  const Rotation<Gcrs, Body> start = rotation_of<Gcrs, Body>({0.5, 0.1, -0.7, 0.2});
  EXPECT_EQ(gcrs_from_body(InertialAttitude{start}, scene), start);
  const SpinningAttitude spin{start, {0, 0, 2}, 0.01};
  const auto r = gcrs_from_body(spin, scene);  // 1 rad after 100 s
  expect_rotation(r);
  EXPECT_NEAR(angle_rad(r * Vec<Body>{0, 0, 1}, start * Vec<Body>{0, 0, 1}), 0, 1e-15);
  EXPECT_LE(norm(r * Vec<Body>{1, 0, 0} - start * Vec<Body>{std::cos(1), std::sin(1), 0}), 1e-14);
  AttitudeScene later = scene;
  later.time_s = 1e9;
  expect_rotation(gcrs_from_body(spin, later));
  EXPECT_THROW(gcrs_from_body(SpinningAttitude{start, {0, 0, 0}, 1}, scene), Error);
}

TEST(Attitude, TableTurnsEvenlyTheShortWayAndEndsWithItsSpan) {
  const double h = pi / 8;  // a turn of 45 degrees about z, once written as -q
  const TableAttitude table{
      {0, 100, 200},
      {{1, 0, 0, 0}, {-std::cos(h), 0, 0, -std::sin(h)}, {std::cos(h), 0, 0, std::sin(h)}}};
  AttitudeScene s = scene;
  const auto heading = [&](double t_s) {
    s.time_s = t_s;
    const Vec<Gcrs> x = gcrs_from_body(table, s) * Vec<Body>{1, 0, 0};
    return std::atan2(x.y, x.x) / deg;
  };
  EXPECT_NEAR(heading(0), 0, 1e-12);
  EXPECT_NEAR(heading(20), 9, 1e-12);
  EXPECT_NEAR(heading(100), 45, 1e-12);
  EXPECT_NEAR(heading(150), 45, 1e-12);
  EXPECT_NEAR(heading(200), 45, 1e-12);
  EXPECT_THROW(heading(200.1), Error);
  EXPECT_THROW(heading(-0.1), Error);
}

TEST(SunTrackingPanel, AngleIsTheBestOneAndZeroWhereAllAreAlike) {
  const SunTrackingPanel panel{.hinge = {0, 1, 0}, .normal = {0, 0, 1}};
  EXPECT_NEAR(panel_angle_rad(panel, {1, 0, 0}), pi / 2, 1e-15);
  EXPECT_NEAR(panel_angle_rad(panel, {1, 5, 1}), pi / 4, 1e-15);
  EXPECT_NEAR(panel_angle_rad(panel, {0, 0, 1}), 0, 1e-15);
  EXPECT_EQ(panel_angle_rad(panel, {0, -3, 0}), 0);
  const Vec<Body> sun{0.3, 0.8, -0.5};
  const Vec<Body> best = body_from_panel(panel, sun) * Vec<Panel>{0, 0, 1};
  EXPECT_NEAR(dot(best, sun), std::hypot(0.3, 0.5), 1e-15);
}

}  // namespace
}  // namespace dmise
