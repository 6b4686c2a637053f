#include "sensors/pipeline/sky_layer.h"

#include <algorithm>
#include <memory>

#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "sensors/pipeline/throughput.h"

namespace dmise {
namespace {

SkyParts parts_over(const View& view, const DrawnStars& drawn) {
  SkyParts parts = acting_sky(view.sensor().sky.parts, view.sensor().effects, view.scene());
  if (parts.faint_starlight) {
    parts.faint_starlight->brighter_limit_v_mag = drawn.to_v_mag;
    parts.faint_starlight->by_counts = drawn.by_counts;
  }
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
      .gases = gases_over(view),
      .time_s = t.seconds()};
  if (acts<CloudCover>(view.sensor().effects, view.scene()))
    scene.clouds = std::make_shared<const CloudMap>(*view.sensor().weather.clouds);
  return scene;
}

SkyModel sky_of(const View& view, const SkyParts& parts) {
  return SkyModel(parts, scene_of(view), view.sensor().camera.band, extinction_over(view));
}

void fill_with(const View& view, const SkyModel& sky, ExpectedElectronImage& image,
               Threads& threads, GlEvaluator* evaluator = nullptr) {
  const auto& optics = view.sensor().camera.optics;
  const PixelFunction electrons = electrons_of(view, sky);
  const int level = view.sensor().effects.level(SkyGrid::facts);
  const double tolerance = SkyGrid::asked(level);
  if (!evaluator) {
    if (tolerance > 0.0)
      fill_from_grid(optics.columns, optics.rows, electrons, tolerance, image.pixels.data(),
                     threads);
    else
      fill_every_pixel(optics.columns, optics.rows, electrons, image.pixels.data(), threads);
    return;
  }
  std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
  evaluator->add_sky(patches_of_grid(optics.columns, optics.rows, electrons,
                                     std::max(tolerance, SkyGrid::asked(2)), threads),
                     image);
}

}  // namespace

PixelFunction electrons_of(const View& view, const SkyModel& sky) {
  const auto& optics = view.sensor().camera.optics;
  const auto gcrs_from_camera = view.camera_from_gcrs(view.times().middle).inverse();
  const auto enu_from_camera = view.enu_from_gcrs(view.times().middle) * gcrs_from_camera;
  const auto throughput = std::make_shared<const Throughput>(view);
  const double electrons_per_photon_m2 =
      throughput->electrons_per_photon_m2() * view.times().seconds();
  return [=, &view, &optics, &sky, earth = view.earth_occultation(view.times().middle)](double x,
                                                                                        double y) {
    const auto direction = unproject(optics, {x, y});
    if (!direction) return 0.0;
    const Vec<Gcrs> seen = gcrs_from_camera * *direction;
    if (earth && earth->hides_direction(seen)) return 0.0;
    return sky.photons_per_s_m2_sr(enu_from_camera * *direction) * throughput->of_limb(seen) *
           electrons_per_photon_m2 * pixel_solid_angle_sr(optics, {x, y}) *
           view.illumination({x, y});
  };
}

SkyModel sky_over(const View& view, const DrawnStars& drawn) {
  return sky_of(view, parts_over(view, drawn));
}

void fill_sky(const View& view, const DrawnStars& drawn, ExpectedElectronImage& image,
              Threads& threads, GlEvaluator* evaluator) {
  if (!acts<SkyBackground>(view.sensor().effects, view.scene())) {
    std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
    return;
  }
  fill_with(view, sky_over(view, drawn), image, threads, evaluator);
}

void fill_sky_behind(const View& view, const DrawnStars& drawn, ExpectedElectronImage& image,
                     Threads& threads) {
  SkyParts parts = parts_over(view, drawn);
  if (view.on_ground())
    parts = {.zodiacal_light = parts.zodiacal_light, .faint_starlight = parts.faint_starlight};
  fill_with(view, sky_of(view, parts), image, threads);
}

}  // namespace dmise
