#include "sensors/sky/sky_light.h"

#include <algorithm>
#include <memory>

#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

DayAir day_air_over(const View& view) {
  const AtmosphereConfig& atmosphere = view.sensor().atmosphere;
  const double pressure_hpa = std::min(view.weather().pressure_hpa, 1100.0);
  const double height_m = view.site()->height_m;
  DayAir air{.height_m = height_m, .pressure_hpa = pressure_hpa};
  air.haze.optical_depth = atmosphere.aerosol_optical_depth.value_or(
      haze_depth_of_extinction(extinction_over(view), pressure_hpa));
  air.haze.angstrom_exponent = atmosphere.angstrom_exponent.value_or(air.haze.angstrom_exponent);
  air.ground_albedo = atmosphere.ground_albedo.value_or(air.ground_albedo);
  if (view.sensor().effects.has(GasAbsorption::facts))
    air.gases = AirGases{.pwv_mm = view.sensor().weather.pwv_mm.value_or(usual_pwv_mm(height_m)),
                         .pressure_hpa = pressure_hpa};
  return air;
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
      .warm_air = warm_air_over(view),
      .time_s = t.seconds()};
  if (acts<Daylight>(view.sensor().effects, view.scene())) {
    scene.day_air = day_air_over(view);
    scene.apparent_sun =
        enu_from_gcrs * view.places(t).satellite(environment.sun_m, still).direction;
  }
  if (acts<CloudCover>(view.sensor().effects, view.scene()))
    scene.clouds = std::make_shared<const CloudMap>(*view.sensor().weather.clouds);
  return scene;
}

}  // namespace

SkyParts sky_parts_over(const View& view, const DrawnStars& drawn) {
  SkyParts parts = acting_sky(view.sensor().sky.parts, view.sensor().effects, view.scene());
  if (parts.faint_starlight) {
    parts.faint_starlight->brighter_limit_v_mag = drawn.to_v_mag;
    parts.faint_starlight->by_counts = drawn.by_counts;
  }
  return parts;
}

SkyModel sky_of(const View& view, const SkyParts& parts) {
  return SkyModel(parts, scene_of(view), view.sensor().camera.band, extinction_over(view));
}

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
  return sky_of(view, sky_parts_over(view, drawn));
}

}  // namespace dmise
