#include "core/visibility/sensor_track.h"

#include <cmath>

#include "core/base/units.h"
#include "core/config/sensors/pointing_config.h"
#include "core/sky/bodies/earth_limb.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/sun_disc.h"
#include "core/sky/places/sun_moon.h"
#include "core/visibility/target_direction.h"

namespace dmise {
namespace {

/// A target closer than this is the sensor's own platform, under another number.
constexpr double min_distance_m = 1.0;

}  // namespace

SensorTrack::SensorTrack(const SensorConfig& sensor, const EphemerisTable& sky,
                         const Sgp4Batch& batch, std::optional<std::size_t> platform,
                         std::optional<std::size_t> target)
    : sensor_(sensor), sky_(sky), batch_(batch), platform_(platform), target_(target) {
  const auto* towards = std::get_if<PointTarget>(&sensor.pointing);
  geometric_ = towards && towards->geometric;
  if (geometric_) refraction_ = configured_refraction(sensor);
  site_ = site_of(sensor);
  if (!site_) return;
  site_m_ = itrs_from_geodetic(*site_);
  up_ = enu_from_itrs(*site_).inverse() * Vec<Enu>{0, 0, 1};
  if (std::holds_alternative<PointUp>(sensor.pointing) ||
      std::holds_alternative<PointCued>(sensor.pointing) ||  // parked
      (std::holds_alternative<PointHorizon>(sensor.pointing) &&
       turn_rate_deg_per_s(sensor.pointing) == 0.0)) {
    // With ITRS instead of GCRS: such a pointing depends on the Earth's axes alone.
    const auto camera = aim(sensor, PointingScene{.site = &*site_});
    fixed_.emplace();
    fixed_->m = camera.m;
  }
}

bool SensorTrack::fixed_to_stars() const {
  return std::holds_alternative<PointSky>(sensor_.pointing) &&
         turn_rate_deg_per_s(sensor_.pointing) == 0.0;
}

std::optional<ObserverState> SensorTrack::state_of(
    std::size_t object, const CameraMoment& now, const Rotation<Gcrs, Teme>& gcrs_from_teme) const {
  const std::uint32_t index = std::uint32_t(object);
  double r[3], v[3];
  std::uint8_t code;
  batch_.propagate_some({&index, 1}, now.utc.jd1, now.utc.jd2, r, v, {&code, 1});
  if (code != 0) return std::nullopt;
  return ObserverState{gcrs_from_teme * Vec<Teme>{r[0], r[1], r[2]},
                       gcrs_from_teme * Vec<Teme>{v[0], v[1], v[2]}};
}

CameraMoment SensorTrack::at(SimTime t) const {
  CameraMoment now = camera_at(t);
  if (now.there && sensor_.camera.exclusion.any()) now.excluded = excluded_at(now);
  return now;
}

Excluded SensorTrack::excluded_at(const CameraMoment& now) const {
  const Exclusion& limits = sensor_.camera.exclusion;
  const auto gcrs_from_teme = sky_.earth(now.time).gcrs_from_teme(now.time);
  const Vec<Gcrs> here_m = gcrs_from_teme * now.apex_m, up = gcrs_from_teme * now.up;
  const Vec<Gcrs> axis =
      gcrs_from_teme * (now.camera_from_teme.inverse() * Vec<CameraFrame>{0, 0, 1});
  const OblateEarth earth = sky_.surface(now.time);
  const auto is_near = [&](const Vec<Gcrs>& body_m, double radius_m, double limit_deg) {
    const Vec<Gcrs> line_m = body_m - here_m;
    if (!(angle_rad(axis, line_m) < limit_deg * deg)) return false;
    const double radius_rad = std::asin(std::min(1.0, radius_m / norm(line_m)));
    return site_ ? dot(up, unit(line_m)) >= -std::sin(radius_rad)
                 : from_limb_rad(here_m, line_m, earth) >= -radius_rad;
  };
  Excluded excluded;
  if (limits.sun_deg) excluded.sun = is_near(sky_.sun_m(now.time), sun_radius_m, *limits.sun_deg);
  if (limits.moon_deg)
    excluded.moon = is_near(sky_.moon_m(now.time), moon_radius_m, *limits.moon_deg);
  if (limits.earth_limb_deg && !site_)
    excluded.earth_limb = from_limb_rad(here_m, axis, earth) < *limits.earth_limb_deg * deg;
  return excluded;
}

CameraMoment SensorTrack::camera_at(SimTime t) const {
  CameraMoment now{.time = t, .utc = sky_.clock().utc(t)};
  const EarthOrientation& earth = sky_.earth(t);
  const Rotation<Itrs, Teme> itrs_from_teme = earth.itrs_from_teme(t);
  if (site_) {
    now.apex_m = itrs_from_teme.inverse() * site_m_;
    now.up = itrs_from_teme.inverse() * up_;
    if (fixed_) {
      now.camera_from_teme = *fixed_ * itrs_from_teme;
      return now;
    }
  }
  const Rotation<Itrs, Gcrs> itrs_from_gcrs = earth.itrs_from_gcrs(t);
  const Rotation<Gcrs, Teme> gcrs_from_teme = itrs_from_gcrs.inverse() * itrs_from_teme;
  PointingScene scene{
      .time = t, .itrs_from_gcrs = itrs_from_gcrs, .site = site_ ? &*site_ : nullptr};
  now.gcrs_from_teme = gcrs_from_teme;
  if (site_) {
    scene.observer = standing_at(site_m_, earth, t);
  } else {
    const auto host = state_of(*platform_, now, gcrs_from_teme);
    now.there = host.has_value();
    if (!now.there) return now;
    scene.observer = *host;
    now.apex_m = gcrs_from_teme.inverse() * host->position_m;
    now.sight.emplace(host->position_m, oblate_earth(earth, sensor_.ellipsoid));
  }
  if (target_) {
    const auto target = state_of(*target_, now, gcrs_from_teme);
    now.there = target.has_value();
    if (!now.there) return now;
    scene.towards_target = target->position_m - scene.observer.position_m;
    now.there = norm(scene.towards_target) > min_distance_m;
    if (!now.there) return now;
    if (geometric_) {
      // `Sight` uses straight lines: relative to them the target is off the axis, at its apparent
      // direction.
      const Vec<Gcrs> line = unit(scene.towards_target);
      const Vec<Gcrs> seen = apparent_direction(sensor_, scene, refraction_, target->position_m,
                                                target->velocity_m_per_s);
      scene.towards_target = line * 2.0 - seen;
    }
  }
  now.camera_from_teme = aim(sensor_, scene) * gcrs_from_teme;
  return now;
}

}  // namespace dmise
