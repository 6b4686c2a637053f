#include "core/visibility/target_direction.h"

namespace dmise {

Refraction configured_refraction(const SensorConfig& sensor) {
  const auto* site = std::get_if<SiteConfig>(&sensor.place);
  if (!site) return {};
  return Refraction(sensor.weather.air.value_or(standard_weather(site->height_m)),
                    sensor.camera.band.centre_m * 1e6);
}

Vec<Gcrs> apparent_direction(const SensorConfig& sensor, const PointingScene& scene,
                             const Refraction& refraction, const Vec<Gcrs>& position_m,
                             const Vec<Gcrs>& slope_m_per_s) {
  // Satellites share the Earth's motion, so the solar system is not needed.
  Observer observer{.position_m = scene.observer.position_m,
                    .velocity_m_per_s = scene.observer.velocity_m_per_s};
  if (scene.site) {
    const Vec<Itrs> up = enu_from_itrs(*scene.site).inverse() * Vec<Enu>{0, 0, 1};
    observer.air = Air{scene.itrs_from_gcrs.inverse() * up, refraction};
  }
  // The mount follows all effects, also those that a plan leaves out of the frame.
  const EffectSet& effects = sensor.unplanned ? *sensor.unplanned : sensor.effects;
  return ApparentPlaces(observer, effects).satellite(position_m, slope_m_per_s).direction;
}

Vec<Gcrs> target_direction(const SensorConfig& sensor, const PointingScene& scene,
                           const Refraction& refraction, const Vec<Gcrs>& position_m,
                           const Vec<Gcrs>& slope_m_per_s) {
  const auto* target = std::get_if<PointTarget>(&sensor.pointing);
  if (target && target->geometric) return unit(position_m - scene.observer.position_m);
  return apparent_direction(sensor, scene, refraction, position_m, slope_m_per_s);
}

}  // namespace dmise
