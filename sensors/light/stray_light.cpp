#include "sensors/light/stray_light.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/optics/projection.h"
#include "core/photometry/magnitude.h"
#include "core/sky/bodies/earth_disc.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/shadow.h"
#include "sensors/scene/bodies_in_field.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

bool in_frame(const Optics& optics, const Vec<CameraFrame>& direction) {
  const auto at = project(optics, direction);
  return at && at->x_px >= -0.5 && at->y_px >= -0.5 && at->x_px < optics.columns - 0.5 &&
         at->y_px < optics.rows - 0.5;
}

/// The focal plane's irradiance by the lit Earth [photons/s/m2].
double of_earth(const View& view, SimTime t, const Rotation<CameraFrame, Gcrs>& camera) {
  const Vec<Gcrs> here_m = view.observer(t).position_m, down = -unit(here_m);
  const OblateEarth earth = view.surface();
  const EarthRadiance radiance(view.sensor().camera.band, here_m, view.environment().sun_m, earth,
                               view.sensor().earth_albedo);
  // Rings of equal solid angle about the nadir, out to the equator's radius.
  constexpr int rings = 64, sectors = 128;
  const double sine = std::min(1.0, earth.ellipsoid.equatorial_radius_m / norm(here_m));
  const double within = sine * sine / (1.0 + std::sqrt((1.0 - sine) * (1.0 + sine)));  // 1 - cos
  const double patch_sr = 2.0 * pi * within / (rings * sectors);
  const Vec<Gcrs> any = std::abs(down.z) < 0.9 ? Vec<Gcrs>{0, 0, 1} : Vec<Gcrs>{1, 0, 0};
  const Vec<Gcrs> u = unit(cross(any, down)), v = cross(down, u);
  const Optics& optics = view.sensor().camera.optics;
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double lost = within * (i + 0.5) / rings, c = 1.0 - lost;
    const double s = std::sqrt(lost * (2.0 - lost));
    for (int j = 0; j < sectors; ++j) {
      const double at = 2.0 * pi * (j + 0.5) / sectors;
      const Vec<Gcrs> line = down * c + (u * std::cos(at) + v * std::sin(at)) * s;
      const double photons = radiance.photons_per_s_m2_sr(line);
      if (!(photons > 0.0)) continue;
      const Vec<CameraFrame> seen = camera * line;
      if (in_frame(optics, seen)) continue;
      sum += photons * patch_sr * optics.stray_light.at(angle_rad(seen, {0, 0, 1}));
    }
  }
  return sum;
}

}  // namespace

double stray_light_e(const View& view) {
  const SensorConfig& sensor = view.sensor();
  if (!acts<StrayLight>(sensor.effects, view.scene())) return 0.0;
  const Optics& optics = sensor.camera.optics;
  const SimTime t = view.times().middle;
  const auto camera = view.camera_from_gcrs(t);
  const Throughput throughput(view);
  const auto of_body = [&](const Vec<Gcrs>& apparent, double photons) {
    const Vec<CameraFrame> seen = camera * apparent;
    if (in_frame(optics, seen)) return 0.0;
    const double air = view.on_ground() ? throughput.of_sunlight(apparent) : 1.0;
    return photons * air * optics.stray_light.at(angle_rad(seen, {0, 0, 1}));
  };
  const SeenBody sun = seen_sun(view, t), moon = seen_moon(view, t);
  const Vec<Gcrs> here_m = view.observer(t).position_m;
  const bool on_ground = view.on_ground();
  const auto is_up = [&](const Vec<Gcrs>& apparent) {
    return on_ground ? dot(view.up(t), apparent) > 0.0
                     : FreeSight(here_m, view.surface()).clear_direction(apparent);
  };
  const double au = norm(sun.above_air_m) / au_m;
  const double of_sun = sunlight_photons_per_s_m2(sun_v_mag, sensor.camera.band) / (au * au);
  double irradiance = 0.0;
  if (on_ground) {
    if (is_up(sun.apparent)) irradiance += of_body(sun.apparent, of_sun);
  } else {
    const EarthShadow shadow(view.environment().sun_m, view.surface());
    irradiance += of_body(sun.apparent, of_sun * shadow.sunlit_fraction(here_m));
    irradiance += of_earth(view, t, camera);
  }
  if (is_up(moon.apparent))
    irradiance += of_body(
        moon.apparent,
        MoonRadiance(sensor.camera.band, moon.above_air_m, sun.above_air_m).photons_per_s_m2());
  return irradiance * optics.pixel_pitch_m * optics.pixel_pitch_m *
         sensor.camera.detector.quantum_efficiency * view.times().seconds();
}

}  // namespace dmise
