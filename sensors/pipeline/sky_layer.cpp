#include "sensors/pipeline/sky_layer.h"

#include <algorithm>

#include "core/effects/light_effects.h"
#include "core/optics/projection.h"
#include "core/optics/vignetting.h"
#include "core/sky/sky_grid.h"
#include "sensors/pipeline/light.h"
#include "sensors/pipeline/stopwatch.h"

namespace dmise {
namespace {

SkyParts parts_switched_on(const SensorConfig& sensor, double drawn_to_v_mag) {
  SkyParts parts = sensor.sky.parts;
  if (parts.faint_starlight) parts.faint_starlight->brighter_limit_v_mag = drawn_to_v_mag;
  const auto keep = [&](const EffectFacts& effect, auto& part) {
    if (!sensor.effects.has(effect)) part.reset();
  };
  keep(effect::airglow, parts.airglow);
  keep(effect::zodiacal_light, parts.zodiacal_light);
  keep(effect::faint_starlight, parts.faint_starlight);
  keep(effect::scattered_moonlight, parts.scattered_moonlight);
  keep(effect::twilight, parts.twilight);
  keep(effect::light_pollution, parts.light_pollution);
  return parts;
}

SkyScene scene_of(const View& view) {
  const SimTime t = view.times().middle;
  const auto& environment = view.environment();
  const auto enu_from_gcrs = view.enu_from_gcrs(t);
  const Vec<Gcrs> here_m = view.observer(t).position_m;
  const Vec<Gcrs> to_moon = environment.moon_m - here_m;
  const Vec<Gcrs> still{0, 0, 0};
  SkyScene scene{
      .sun = enu_from_gcrs * unit(environment.sun_m - here_m),
      .moon = enu_from_gcrs * view.places(t).satellite(environment.moon_m, still).direction,
      .moon_phase_rad = angle_rad(environment.sun_m - environment.moon_m, -to_moon),
      .moon_distance_m = norm(to_moon),
      .gcrs_from_enu = enu_from_gcrs.inverse(),
      .in_air = view.on_ground(),
      .time_s = t.seconds()};
  const auto& clouds = view.sensor().weather.clouds;
  if (view.on_ground() && clouds && view.sensor().effects.has(effect::clouds))
    scene.clouds = std::make_shared<const CloudMap>(*clouds);
  return scene;
}

SkyModel sky_of(const View& view, const SkyParts& parts) {
  return SkyModel(parts, scene_of(view), view.sensor().camera.band, extinction_over(view));
}

void fill_with(const View& view, const SkyModel& sky, RateImage& image, Threads& threads,
               GlEvaluator* evaluator = nullptr) {
  const auto& optics = view.sensor().camera.optics;
  const auto gcrs_from_camera = view.camera_from_gcrs(view.times().middle).inverse();
  const auto enu_from_camera = view.enu_from_gcrs(view.times().middle) * gcrs_from_camera;
  const Hidden hidden(view, view.times().middle);
  const double electrons_per_photon_m2 =
      Light(view).electrons_per_photon_m2() * view.times().seconds();
  const PixelFunction electrons = [&](double x, double y) {
    const auto direction = unproject(optics, {x, y});
    if (!direction || hidden.direction(gcrs_from_camera * *direction)) return 0.0;
    return sky.photons_per_s_m2_sr(enu_from_camera * *direction) * electrons_per_photon_m2 *
           pixel_solid_angle_sr(optics, {x, y}) * relative_illumination(optics, {x, y});
  };
  if (!evaluator) {
    fill_from_grid(optics.columns, optics.rows, electrons, sky_tolerance, image.pixels.data(),
                   threads);
    return;
  }
  std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
  evaluator->add_sky(
      patches_of_grid(optics.columns, optics.rows, electrons, sky_tolerance, threads), image);
}

}  // namespace

SkyModel sky_over(const View& view, double drawn_to_v_mag) {
  return sky_of(view, parts_switched_on(view.sensor(), drawn_to_v_mag));
}

void fill_sky(const View& view, double drawn_to_v_mag, RateImage& image, Threads& threads,
              EffectTimes& times, GlEvaluator* evaluator) {
  if (!view.sensor().effects.has(effect::sky)) {
    std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
    return;
  }
  Stopwatch timing(times[effect::sky]);
  fill_with(view, sky_over(view, drawn_to_v_mag), image, threads, evaluator);
}

void fill_sky_behind(const View& view, double drawn_to_v_mag, RateImage& image, Threads& threads) {
  SkyParts parts = parts_switched_on(view.sensor(), drawn_to_v_mag);
  if (view.on_ground())
    parts = {.zodiacal_light = parts.zodiacal_light, .faint_starlight = parts.faint_starlight};
  if (view.sensor().effects.has(effect::sky))
    fill_with(view, sky_of(view, parts), image, threads);
  else
    std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
}

}  // namespace dmise
