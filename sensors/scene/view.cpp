#include "sensors/scene/view.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/sensors/effect_list.h"
#include "core/facets/moonlight.h"
#include "core/sky/air/air_exposure.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/daylight.h"
#include "core/visibility/sight.h"
#include "core/visibility/target_direction.h"
#include "sensors/scene/cue_path.h"
#include "sensors/scene/exclusion.h"

namespace dmise {

View::View(const SensorConfig& sensor, const FrameTimes& commanded, const StateWindow& window,
           std::uint64_t seed, Belief belief)
    : sensor_(sensor),
      errors_(belief == Belief::truth ? ExposureErrors(sensor, commanded, seed)
                                      : ExposureErrors(commanded)),
      times_(errors_.exposed()),
      shutter_(acting_detector(sensor.camera.detector, sensor.effects)),
      window_(window),
      seed_(seed),
      environment_(window.environment(times_.middle)),
      air_(window.site(sensor.name, times_.middle)),
      site_(site_of(sensor)) {
  if (site_) {
    site_m_ = itrs_from_geodetic(*site_);
    weather_ = air_ ? Weather{air_->pressure_hpa, air_->temperature_c, air_->humidity}
                    : sensor.weather.air.value_or(standard_weather(site_->height_m));
    refraction_ = Refraction(weather_, sensor.camera.band.centre_m * 1e6);
    const SimTime middle = times_.middle;
    const Vec<Gcrs> to_sun = environment_.sun_m - observer(middle).position_m;
    daylight_ = elevation_over(up(middle), unit(to_sun)) > daylight_from_rad;
  } else {
    platform_ = object_index(window.roster(), std::get<PlatformConfig>(sensor.place).object,
                             sensor.name + ": platform");
  }
  if (const auto* target = std::get_if<PointTarget>(&sensor.pointing))
    target_ = object_index(window.roster(), target->object, sensor.name + ": pointing.target");
  for (const auto& needed : {platform_, target_})
    for (const SimTime t :
         {commanded.start, commanded.end, times_.start, times_.end, times_of_all_rows().end})
      if (needed && !window.has_state(*needed, t))
        throw Error(sensor.name + ": " + window.roster().objects[*needed].name +
                    " has no state at frame " + std::to_string(commanded.frame) + ": " +
                    window.why_no_state(*needed, t));
  if (target_ && norm(window.motion(*target_, commanded.middle).position_m -
                      observer(commanded.middle).position_m) < Sight::nearest_m)
    throw Error(sensor.name + ": pointing.target: " + window.roster().objects[*target_].name +
                " is where the sensor is, at frame " + std::to_string(commanded.frame));
  aimed_ = pointing_scene(commanded.middle);
  vignettes_ = acts<Vignetting>(sensor.effects, scene());
  if (belief == Belief::truth) excluded_ = excluded_by(sensor.camera.exclusion, body_angles(*this));
  if (!shutter_closed()) bodies_ = bodies_in_field(*this);
  if (sensor.effects.has(Moonlight::facts))
    moonlight_colour_ = dmise::moonlight_colour(sensor.camera.band);
}

View View::during(const FrameTimes& times) const {
  View view = *this;
  view.times_ = times;
  return view;
}

SimTime View::row_delay(double y_px) const {
  return sim_seconds(shutter_.row_delay_s(y_px, sensor_.camera.optics.rows));
}

FrameTimes View::times_of_all_rows() const {
  if (!rolls()) return times_;
  const SimTime delay = row_delay(sensor_.camera.optics.rows - 1);
  return {times_.frame, times_.start, {times_.middle.ns + delay.ns / 2}, times_.end + delay};
}

SceneFacts View::scene() const {
  SceneFacts scene = scene_facts(sensor_);
  scene.sun_in_field = bodies_.sun;
  scene.moon_in_field = bodies_.moon;
  scene.planets_in_field = !bodies_.planets.empty();
  scene.earth_in_field = bodies_.earth;
  scene.shutter_closed = shutter_closed();
  scene.limb_in_field = bodies_.limb;
  scene.daylight = daylight_;
  return scene;
}

std::optional<EarthOccultation> View::earth_occultation(SimTime t) const {
  if (!acts<EarthOccultation>(sensor_.effects, scene())) return std::nullopt;
  std::optional<FreeSight> sight;
  if (!on_ground()) sight.emplace(observer(t).position_m, surface());
  return EarthOccultation(up(t), sight);
}

double View::illumination(PixelPosition pixel) const {
  return vignettes_ ? relative_illumination(sensor_.camera.optics, pixel) : 1.0;
}

ObserverState View::observer(SimTime t) const {
  if (platform_) {
    const Motion motion = window_.motion(*platform_, t);
    return {motion.position_m, motion.slope_m_per_s};
  }
  return standing_at(site_m_, earth(), t);
}

PointingScene View::pointing_scene(SimTime t) const {
  PointingScene scene{.time = t,
                      .observer = observer(t),
                      .itrs_from_gcrs = earth().itrs_from_gcrs(t),
                      .site = site_ ? &*site_ : nullptr};
  const Task* task = std::holds_alternative<PointCued>(sensor_.pointing) ? window_.task() : nullptr;
  if ((target_ || task) &&
      (sensor_.tracking == Tracking::target || t == errors_.commanded().middle)) {
    const Motion target = task ? predicted_motion(*task, t) : window_.motion(*target_, t);
    scene.towards_target =
        target_direction(sensor_, scene, refraction_, target.position_m, target.slope_m_per_s);
  }
  if (platform_ && std::holds_alternative<PointBody>(sensor_.pointing))
    scene.gcrs_from_body = window_.gcrs_from_body(*platform_, t);
  return scene;
}

Rotation<CameraFrame, Gcrs> View::commanded_camera(SimTime reading) const {
  return dmise::camera_from_gcrs(sensor_, aimed_, pointing_scene(reading));
}

Rotation<CameraFrame, Gcrs> View::camera_from_gcrs(SimTime t) const {
  // A body turns by itself, without the sensor's clock.
  const bool by_clock = errors_.of_clock() && !std::holds_alternative<PointBody>(sensor_.pointing);
  const SimTime reading = by_clock ? errors_.reading(t) : t;
  auto camera = commanded_camera(reading);
  // A mount on the ground is told axes of the Earth, as they are by its clock.
  if (by_clock && site_)
    camera = camera * earth().itrs_from_gcrs(reading).inverse() * earth().itrs_from_gcrs(t);
  return errors_.displace() ? errors_.true_from_commanded(t) * camera : camera;
}

ApparentPlaces View::places(SimTime t, const EffectSet& effects) const {
  const auto& e = environment_;
  const SolarSystem bodies{e.sun_m, e.moon_m, e.earth_barycentric_m, e.earth_velocity_m_per_s,
                           e.moon_velocity_m_per_s};
  const Tt tt{e.tt_jd1, e.tt_jd2 + (t - e.time).seconds() / day_s};
  if (site_) return {ground_observer(*site_, e.earth, t, tt, bodies, refraction_), effects};
  const ObserverState at = observer(t);
  return {space_observer(at.position_m, at.velocity_m_per_s, tt, bodies), effects};
}

Vec<Gcrs> View::up(SimTime t) const {
  if (!site_) return unit(observer(t).position_m);
  return (enu_from_itrs(*site_) * earth().itrs_from_gcrs(t)).inverse() * Vec<Enu>{0, 0, 1};
}

Rotation<Enu, Gcrs> View::enu_from_gcrs(SimTime t) const {
  if (site_) return enu_from_itrs(*site_) * earth().itrs_from_gcrs(t);
  const auto [ra, dec] = to_spherical(up(t));
  const double ca = std::cos(ra), sa = std::sin(ra), cd = std::cos(dec), sd = std::sin(dec);
  Rotation<Enu, Gcrs> r;
  r.m = {{{-sa, ca, 0}, {-ca * sd, -sa * sd, cd}, {ca * cd, sa * cd, sd}}};
  return r;
}

double View::turns_rad_per_s(const Vec<Gcrs>& direction) const {
  return earth_turn_rad_per_s * std::hypot(direction.x, direction.y);  // the pole is z to 0.1 deg
}

}  // namespace dmise
