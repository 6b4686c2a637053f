#include "core/visibility/pointing.h"

#include "core/base/units.h"

namespace dmise {
namespace {

Rotation<CameraFrame, Gcrs> at_direction(const Vec<Gcrs>& direction, double roll_rad) {
  const auto [ra, dec] = to_spherical(direction);
  return camera_at<Gcrs>(ra, dec, roll_rad);
}

struct Aim {
  const SensorConfig& sensor;
  const PointingScene& scene;

  double roll_rad() const { return sensor.roll_deg * deg; }

  /// Longitude of ENU runs from east through north.
  Rotation<CameraFrame, Gcrs> in_enu(double longitude_rad, double latitude_rad, double roll) const {
    return camera_at<Enu>(longitude_rad, latitude_rad, roll) * enu_from_itrs(*scene.site) *
           scene.itrs_from_gcrs;
  }
  Rotation<CameraFrame, Gcrs> operator()(PointUp) const {
    // Coming from longitude -90 deg (south), north is up and east is where longitude grows.
    if (scene.site) return in_enu(-pi / 2, pi / 2, roll_rad());
    return at_direction(scene.observer.position_m, roll_rad());
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointHorizon& p) const {
    return in_enu(pi / 2 - p.azimuth_deg * deg, p.elevation_deg * deg, -roll_rad());
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointSky& p) const {
    return camera_at<Gcrs>(p.ra_deg * deg, p.dec_deg * deg, roll_rad());
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointTarget&) const {
    return at_direction(scene.target_m - scene.observer.position_m, roll_rad());
  }
};

}  // namespace

Rotation<CameraFrame, Gcrs> aim(const SensorConfig& sensor, const PointingScene& scene) {
  return std::visit(Aim{sensor, scene}, sensor.pointing);
}

Rotation<CameraFrame, Gcrs> camera_from_gcrs(const SensorConfig& sensor, const PointingScene& aimed,
                                             const PointingScene& now) {
  switch (sensor.tracking) {
    case Tracking::sidereal:
      return aim(sensor, aimed);
    case Tracking::target:
      return aim(sensor, now);
    case Tracking::fixed:
      break;
  }
  if (!now.site) return aim(sensor, now);
  // Fixed to the ground: the attitude to the Earth is that of the instant of aiming.
  return aim(sensor, aimed) * aimed.itrs_from_gcrs.inverse() * now.itrs_from_gcrs;
}

}  // namespace dmise
