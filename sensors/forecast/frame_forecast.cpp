#include "sensors/forecast/frame_forecast.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/detection/pixels/components.h"
#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/air_exposure.h"
#include "core/sky/bodies/earth_limb.h"
#include "core/visibility/field_of_view.h"
#include "sensors/objects/object_sampler.h"
#include "sensors/objects/objects_in_field.h"
#include "sensors/planning/exposure_planner.h"
#include "sensors/scene/seen_planet.h"
#include "sensors/scene/throughput.h"
#include "sensors/sky/field_stars.h"

namespace dmise {

std::uint32_t objects_with_light(const View& view, const ObjectShapes* shapes, double margin_px) {
  const auto& optics = view.sensor().camera.optics;
  const ObjectSampler sampler(view, shapes);
  constexpr int pieces = 64;
  std::vector<ExposureInstant> instants;
  for (int k = 0; k <= pieces; ++k)
    instants.emplace_back(view, view.times().at(double(k) / pieces));
  std::uint32_t count = 0;
  for (const std::size_t object : objects_in_field(view, shapes)) {
    const bool lit = std::any_of(instants.begin(), instants.end(), [&](const auto& at) {
      const ObjectSample s = sampler.sample(object, at);
      return s.pixel && s.electrons_per_s > 0.0 && in_frame(optics, *s.pixel, margin_px);
    });
    count += lit;
  }
  return count;
}

FrameForecast frame_forecast(const View& view, const ForecastScene& scene) {
  const auto& sensor = view.sensor();
  const auto& optics = sensor.camera.optics;
  const SimTime middle = view.times().middle;
  const auto camera_from_gcrs = view.camera_from_gcrs(middle);
  const Vec<Gcrs> boresight = camera_from_gcrs.inverse() * Vec<CameraFrame>{0, 0, 1};
  const Vec<Gcrs> here_m = view.observer(middle).position_m, up = view.up(middle);
  const Vec<Gcrs> to_sun_m = view.environment().sun_m - here_m;
  const auto earth = view.earth_occultation(middle);
  const auto hides = [&](const Vec<Gcrs>& direction) {
    return earth && earth->hides_direction(direction);
  };
  FrameForecast out{.frame = view.times().frame, .middle = middle};
  if (view.on_ground()) {
    out.boresight_elevation_rad = elevation_over(up, unit(boresight));
    out.sun_elevation_rad = elevation_over(up, unit(to_sun_m));
    out.moon_elevation_rad = elevation_over(up, unit(view.environment().moon_m - here_m));
  }
  if (!view.on_ground()) out.limb_angle_rad = above_limb_rad(here_m, boresight, view.surface());
  out.boresight_hidden =
      hides(boresight) || (out.boresight_elevation_rad && *out.boresight_elevation_rad < 0.0);
  if (const auto* target = std::get_if<PointTarget>(&sensor.pointing)) {
    const auto index = object_index(view.states().roster(), target->object, target->where);
    const Vec<Gcrs> position_m = view.states().motion(index, middle).position_m;
    const Vec<Gcrs> line = position_m - here_m;
    if (view.on_ground()) out.target_elevation_rad = elevation_over(up, unit(line));
    out.target_hidden = view.on_ground() ? *out.target_elevation_rad < 0.0
                                         : earth && earth->hides_object(position_m, unit(line));
  }
  out.sun_in_field =
      FieldOfView(optics).contains(camera_from_gcrs * to_sun_m) && !hides(unit(to_sun_m));

  for (const Planet planet : view.planets()) {
    const SeenPlanet seen = seen_planet(view, planet, middle);
    out.planets.push_back(
        {facts_of(planet).name, seen.v_mag, 2.0 * seen.radius_rad, is_drawn_as_disc(view, seen)});
  }
  out.shutter_closed = view.shutter_closed();
  const double reach_px = 5 * scene.psf_sigma_px + 1;  // radius of a source's light
  DrawnStars drawn;
  if (scene.stars && sensor.effects.has(StarBackground::facts)) {
    const FieldStars field(sensor, scene.stars, scene.faintest_star_mag);
    const EffectSet asked = scene.planner ? scene.planner->asked_effects(view) : sensor.effects;
    drawn = field.drawn(scene.faintest_star_mag, asked);
    out.stars = out.shutter_closed ? 0 : field.count(view, scene.faintest_star_mag, reach_px);
    if (drawn.by_counts && !out.shutter_closed)
      out.synthetic = {field.expected_synthetic(view, asked), drawn.to_v_mag};
  }
  if (scene.count_objects && sensor.effects.has(SpaceObjects::facts))
    out.objects = out.shutter_closed ? 0 : objects_with_light(view, scene.shapes, reach_px);

  out.background = background_at_centre(view, drawn);
  out.full_e = saturation_e(acting_detector(sensor.camera.detector, sensor.effects));
  out.thermal = thermal_limit(view, out.background, out.full_e, scene.psf_sigma_px);
  const double pixels_per_deg = deg / optics.pixel_angle_rad();
  out.streak_deg_per_s = usual_rate_deg_per_s;
  out.streak_px = usual_rate_deg_per_s * pixels_per_deg * view.times().seconds();
  if (out.shutter_closed || out.boresight_hidden || out.background.electrons >= out.full_e)
    return out;
  const auto star_at = [&](SimTime t) {
    return project(optics, view.camera_from_gcrs(t) * boresight);
  };
  const auto start = star_at(view.times().start), end = star_at(view.times().end);
  if (start && end) out.star_px = std::hypot(end->x_px - start->x_px, end->y_px - start->y_px);
  const double diagonal_px = std::hypot(optics.columns, optics.rows);
  const auto limit = detection_limit(out.background.noise_e, scene.psf_sigma_px,
                                     std::min(out.streak_px, diagonal_px), out.star_px);
  const Throughput throughput(view);
  const double through = throughput.of_sunlight(boresight);
  if (!(through > 0.0)) return out;
  out.extinction_mag = magnitude_of_light(through);
  const auto v_mag = [&](double e_per_s) {
    return throughput.zero_point_mag() + magnitude_of_light(e_per_s / through);
  };
  out.point_limit_v_mag = v_mag(limit.point_e / view.times().seconds());
  const BlurByRange blur(sensor);
  out.near_disc_px = blur.disc_px(near_range_m);
  if (out.near_disc_px > 0.0)
    out.near_limit_v_mag =
        v_mag(limiting_point_e(out.background.noise_e, blur.sigma_px(near_range_m)) /
              view.times().seconds());
  if (limit.found_point_e)
    out.found_point_v_mag = v_mag(*limit.found_point_e / view.times().seconds());
  if (out.streak_px >= shortest_streak_px)
    out.streak_limit_v_mag = v_mag(limit.streak_e_per_px * out.streak_px / view.times().seconds());
  return out;
}

}  // namespace dmise
