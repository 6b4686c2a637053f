#include "core/visibility/pointing.h"

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/frames/quaternion.h"

namespace dmise {
namespace {

constexpr double nearest_m = 1e-3;  // a camera looks at no nearer place
constexpr double min_sine = 1e-6;   // between boresight and up

Rotation<CameraFrame, Gcrs> at_direction(const Vec<Gcrs>& direction, double roll_rad) {
  const auto [ra, dec] = to_spherical(direction);
  return camera_at<Gcrs>(ra, dec, roll_rad);
}

/// Rotates vectors about `axis` (unit), right-handed.
template <class F>
Rotation<F, F> rotation_about(const std::array<double, 3>& axis, double angle_rad) {
  const double half = 0.5 * angle_rad, s = std::sin(half);
  return rotation_of<F, F>({std::cos(half), s * axis[0], s * axis[1], s * axis[2]});
}

struct Aim {
  const SensorConfig& sensor;
  const PointingScene& scene;

  double roll_rad() const { return sensor.roll_deg * deg; }

  /// Longitude in ENU runs from east through north.
  Rotation<CameraFrame, Gcrs> in_enu(double longitude_rad, double latitude_rad, double roll) const {
    return camera_at<Enu>(longitude_rad, latitude_rad, roll) * enu_from_itrs(*scene.site) *
           scene.itrs_from_gcrs;
  }
  Rotation<CameraFrame, Gcrs> operator()(PointUp) const {
    // From longitude -90 deg (south), north is up and east is where longitude increases.
    if (scene.site) return in_enu(-pi / 2, pi / 2, roll_rad());
    return at_direction(scene.observer.position_m, roll_rad());
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointHorizon& p) const {
    const double t_s = scene.time.seconds();
    const double azimuth_deg = p.azimuth_deg + p.azimuth_rate_deg_per_s * t_s;
    const double elevation_deg = p.elevation_deg + p.elevation_rate_deg_per_s * t_s;
    return in_enu(pi / 2 - azimuth_deg * deg, elevation_deg * deg, -roll_rad());
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointSky& p) const {
    const double t_s = scene.time.seconds();
    return camera_at<Gcrs>((p.ra_deg + p.ra_rate_deg_per_s * t_s) * deg,
                           (p.dec_deg + p.dec_rate_deg_per_s * t_s) * deg, roll_rad());
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointBody& p) const {
    if (!scene.gcrs_from_body) throw Error("pointing.body: the platform has no attitude");
    return (*scene.gcrs_from_body * p.body_from_camera).inverse();
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointScan& p) const {
    const double angle_rad = p.rate_deg_per_s * deg * scene.time.seconds();
    if (const auto* sky = std::get_if<PointSky>(&p.start))
      return (*this)(*sky) * rotation_about<Gcrs>(p.axis, -angle_rad);
    const auto enu_from_gcrs = enu_from_itrs(*scene.site) * scene.itrs_from_gcrs;
    return (*this)(std::get<PointHorizon>(p.start)) * enu_from_gcrs.inverse() *
           rotation_about<Enu>(p.axis, -angle_rad) * enu_from_gcrs;
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointTarget& p) const {
    const auto centred = at_direction(scene.towards_target, roll_rad());
    const double x = std::tan(p.offset_x_deg * deg), y = std::tan(p.offset_y_deg * deg);
    const double across = std::hypot(x, y);
    if (!(across > 0.0)) return centred;
    // The shortest turn of the axis z to (x, y, 1).
    return rotation_about<CameraFrame>({-y / across, x / across, 0.0}, std::atan(across)) * centred;
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointEnu& p) const {
    const auto enu_from_gcrs = enu_from_itrs(p.origin) * scene.itrs_from_gcrs;
    Vec<Enu> line = p.look;
    if (p.at_m) {
      const Vec<Itrs> eye_m = scene.itrs_from_gcrs * scene.observer.position_m;
      line = *p.at_m - enu_from_itrs(p.origin) * (eye_m - itrs_from_geodetic(p.origin));
      if (!(norm(line) > nearest_m)) throw Error(p.where + ": the sensor is where it looks at");
    }
    const Vec<Enu> z = unit(line);
    Vec<Enu> side = cross(z, p.up);
    // If the line is along `up`, an axis that is not takes its place.
    if (norm(side) < min_sine)
      side = cross(z, std::abs(z.y) < 0.9 ? Vec<Enu>{0, 1, 0} : Vec<Enu>{0, 0, 1});
    const Vec<Enu> x = unit(side), y = cross(z, x);
    Rotation<CameraFrame, Enu> camera;
    camera.m = {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    return camera * enu_from_gcrs;
  }
  Rotation<CameraFrame, Gcrs> operator()(const PointCued& p) const {
    if (norm(scene.towards_target) > 0.0) return at_direction(scene.towards_target, roll_rad());
    return (*this)(p.park);
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
    case Tracking::moving:
      return aim(sensor, now);
    case Tracking::fixed:
      break;
  }
  if (!now.site) return aim(sensor, now);
  // Fixed to the ground: the attitude relative to the Earth is that of the instant of aiming.
  return aim(sensor, aimed) * aimed.itrs_from_gcrs.inverse() * now.itrs_from_gcrs;
}

}  // namespace dmise
