#include "sensors/scene/limb_layer.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/optics/projection.h"
#include "core/sky/bodies/limb_airglow.h"
#include "core/sky/bodies/limb_extinction.h"
#include "core/sky/limb_air.h"
#include "sensors/scene/limb_window.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

/// Above it nothing shines, with any layer that a sky may have.
constexpr double zone_top_m = 120e3;

/// The airglow over a sensor's sky; the usual one where its sky is a single figure.
AirglowShells shells_of(const View& view) {
  const SensorConfig& sensor = view.sensor();
  return {sensor.sky.parts.airglow.value_or(Airglow{}), sensor.camera.band};
}

/// Calls `visit` with the lines of sight of a grid over the frame and its margin.
template <class Visit>
void for_lines(const View& view, SimTime t, int margin_px, int steps, Visit&& visit) {
  const Optics& optics = view.sensor().camera.optics;
  const LimbSight sight(view.observer(t).position_m, view.surface());
  const auto gcrs_from_camera = view.camera_from_gcrs(t).inverse();
  const auto along = [&](int i, int length) {
    return -0.5 - margin_px + (length + 2.0 * margin_px) * i / steps;
  };
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i)
      if (const auto at = unproject(optics, {along(i, optics.columns), along(j, optics.rows)})) {
        const Vec<Gcrs> direction = gcrs_from_camera * *at;
        if (!visit(sight.line(direction), direction)) return;
      }
}

LimbWindow::Light airglow_light(const View& view) {
  const bool dims = acts<LimbExtinction>(view.sensor().effects, view.scene());
  std::shared_ptr<const LimbExtinction> air;
  if (dims)
    air = std::make_shared<const LimbExtinction>(
        view.sensor().camera.band,
        LimbSight(view.observer(view.times().middle).position_m, view.surface()));
  return [shells = shells_of(view), air](const LimbLine& line, const Vec<Gcrs>&) {
    return shells.photons_per_s_m2_sr(line, air ? air->of_surface(line) : 1.0);
  };
}

LimbWindow::Light air_light(const View& view) {
  return [air = LimbAirRadiance(view.sensor().camera.band, view.environment().sun_m,
                                view.surface())](const LimbLine& line, const Vec<Gcrs>& direction) {
    return air.photons_per_s_m2_sr(line, direction);
  };
}

void draw(const View& view, const LimbWindow::Light& light, double top_m, bool before_ground,
          OpticsStage& optics, ExpectedElectronImage& image, Threads& threads) {
  LimbWindow window(view, optics.reach_px(), {light, top_m, before_ground}, threads);
  optics.add_extended(window.drawn(), image);
}

}  // namespace

bool limb_is_seen(const View& view, SimTime t) {
  const Vec<Gcrs> here_m = view.observer(t).position_m;
  const Optics& optics = view.sensor().camera.optics;
  const double sine =
      (view.sensor().ellipsoid.equatorial_radius_m + zone_top_m) / std::max(norm(here_m), 1.0);
  const double radius_rad = sine < 1.0 ? std::asin(sine) : pi;
  const SeenBody centre{.apparent = -unit(here_m), .radius_rad = radius_rad};
  if (angle_rad(view.boresight(t), centre.apparent) >
      half_diagonal_rad(optics) + radius_rad + 3.0 * disc_margin_px * optics.pixel_angle_rad())
    return false;
  constexpr double small_rad = 5.0 * deg;
  if (radius_rad < small_rad) return !box_of(view, centre, t, disc_margin_px).empty();
  bool seen = false;
  for_lines(view, t, disc_margin_px, 32, [&](const LimbLine& line, const Vec<Gcrs>&) {
    seen = line.lowest_height_m() < zone_top_m;
    return !seen;
  });
  return seen;
}

void draw_limb_airglow(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
                       Threads& threads) {
  const double top_m = shells_of(view).top_m();
  draw(view, airglow_light(view), top_m, true, optics, image, threads);
}

void draw_limb_air(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
                   Threads& threads) {
  draw(view, air_light(view), LimbAirTable::top_m, false, optics, image, threads);
}

void add_limb_facts(const View& view, PlanFacts& f) {
  const SceneFacts scene = view.scene();
  f.scene.limb_in_field = scene.limb_in_field;
  if (!scene.limb_in_field) return;
  const Optics& optics = view.sensor().camera.optics;
  const double electrons = Throughput(view).electrons_per_photon_m2() * view.times().seconds() *
                           pixel_solid_angle_sr(optics, principal_point(optics));
  constexpr double between = 1.5;  // the places that are looked at
  const auto most = [&](const LimbWindow::Light& light) {
    double photons = 0.0;
    for_lines(
        view, view.times().middle, 0, 8, [&](const LimbLine& line, const Vec<Gcrs>& direction) {
          photons = std::max(photons, light(line, direction));
          if (!(line.nearest_m > 1.0)) return true;
          // The brightest height may lie between two lines.
          LimbLine at = line;
          for (double height_m = 5e3; at.from_m < 0.0 && height_m < zone_top_m; height_m += 5e3) {
            at.nearest_m = at.radius_m + height_m;
            at.nearest = unit(line.nearest) * at.nearest_m;
            photons = std::max(photons, light(at, direction));
          }
          return true;
        });
    return between * electrons * photons;
  };
  if (acts<LimbAirglow>(view.sensor().effects, scene)) f.limb_airglow_e = most(airglow_light(view));
  if (acts<LimbAir>(view.sensor().effects, scene)) f.limb_air_e = most(air_light(view));
  const double light_e = f.limb_airglow_e + f.limb_air_e;
  double noise_e2 = 0.0;
  for (const SkySample& s : f.sky) noise_e2 = std::max(noise_e2, s.noise_e * s.noise_e);
  f.sky.push_back({.sky_e = light_e, .noise_e = std::sqrt(noise_e2 + light_e)});
}

}  // namespace dmise
