#pragma once
#include <optional>

#include "core/config/scenario.h"
#include "core/frames/earth_orientation.h"
#include "core/frames/geodesy.h"
#include "core/frames/vec.h"
#include "core/orbit/motion_state.h"

namespace dmise {

/// Camera axes for a boresight at (`longitude_rad`, `latitude_rad`) of frame `F`: the image's up
/// (-y) points along increasing latitude rotated by `roll_rad` towards increasing longitude.
/// Defined at the poles too, by the longitude. Seen from inside the sphere: with north up, east is
/// left.
template <class F>
Rotation<CameraFrame, F> camera_at(double longitude_rad, double latitude_rad, double roll_rad) {
  const double cl = std::cos(longitude_rad), sl = std::sin(longitude_rad);
  const double cb = std::cos(latitude_rad), sb = std::sin(latitude_rad);
  const Vec<F> boresight{cl * cb, sl * cb, sb};
  const Vec<F> north{-cl * sb, -sl * sb, cb};
  const Vec<F> east{-sl, cl, 0.0};
  const Vec<F> up = north * std::cos(roll_rad) + east * std::sin(roll_rad);
  const Vec<F> right = cross(boresight, up);
  Rotation<CameraFrame, F> r;
  r.m = {{{right.x, right.y, right.z},
          {-up.x, -up.y, -up.z},
          {boresight.x, boresight.y, boresight.z}}};
  return r;
}

/// Geocentric state of an observer at one instant.
using ObserverState = MotionState<Gcrs>;

/// State of an observer who stands still on the Earth at `place_m`.
inline ObserverState standing_at(const Vec<Itrs>& place_m, const EarthOrientation& earth,
                                 SimTime t) {
  return {earth.itrs_from_gcrs(t).inverse() * place_m, earth.velocity_of_fixed_point(place_m, t)};
}

/// Inputs of a camera's attitude at one instant.
struct PointingScene {
  SimTime time;
  ObserverState observer;
  Vec<Gcrs> towards_target;  // from the observer, any length; of PointTarget and PointCued
  Rotation<Itrs, Gcrs> itrs_from_gcrs;
  const Site* site = nullptr;                          // null aboard a platform
  std::optional<Rotation<Gcrs, Body>> gcrs_from_body;  // the platform's; for PointBody only
};

/// Attitude of a camera that points at its goal at the instant of `scene`. Throws `Error` for one
/// fixed to a body without an attitude.
Rotation<CameraFrame, Gcrs> aim(const SensorConfig& sensor, const PointingScene& scene);

/// Attitude at the instant `now` of an exposure aimed at the instant `aimed`, according to the
/// tracking.
Rotation<CameraFrame, Gcrs> camera_from_gcrs(const SensorConfig& sensor, const PointingScene& aimed,
                                             const PointingScene& now);

}  // namespace dmise
