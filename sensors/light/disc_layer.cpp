#include "sensors/light/disc_layer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/effects/plan_facts.h"
#include "core/frames/rotation_angle.h"
#include "core/optics/projection.h"
#include "core/photometry/star_light.h"
#include "core/sky/bodies/earth_disc.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/sun_disc.h"
#include "sensors/light/disc_window.h"
#include "sensors/light/planet_layer.h"
#include "sensors/light/stray_light.h"
#include "sensors/scene/bodies_in_field.h"
#include "sensors/scene/seen_planet.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

/// Where light of an apparent direction comes from above the air over a ground sensor.
class AboveAir {
 public:
  AboveAir(const View& view, SimTime t, double distance_m)
      : refraction_(view.refraction()), up_(view.up(t)), distance_m_(distance_m) {
    refracts_ =
        view.on_ground() && acts<AtmosphericRefraction>(view.sensor().effects, view.scene());
  }
  Vec<Gcrs> of(const Vec<Gcrs>& apparent) const {
    if (!refracts_) return apparent;
    const double sine = std::clamp(dot(up_, apparent), -1.0, 1.0);
    const Vec<Gcrs> level = apparent - up_ * sine;
    const double length = norm(level);
    if (!(length > 1e-12)) return apparent;
    const double truly_rad = refraction_.true_from_apparent_rad(std::asin(sine), distance_m_);
    return level * (std::cos(truly_rad) / length) + up_ * std::sin(truly_rad);
  }

 private:
  const Refraction& refraction_;
  Vec<Gcrs> up_;
  double distance_m_;
  bool refracts_ = false;
};

double pixel_rad_near(const View& view, const Vec<Gcrs>& direction, SimTime t) {
  const Optics& optics = view.sensor().camera.optics;
  const auto place = project(optics, view.camera_from_gcrs(t) * direction);
  if (!place) return optics.pixel_angle_rad();
  const double sr = pixel_solid_angle_sr(optics, *place);
  return sr > 0.0 ? std::sqrt(sr) : optics.pixel_angle_rad();
}

DiscBox both(const DiscBox& a, const DiscBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right),
          std::max(a.bottom, b.bottom)};
}

/// Times at which the disc is drawn; each stands for an equal share of the exposure.
std::vector<SimTime> times_of(const View& view, const std::function<Vec<Gcrs>(SimTime)>& towards) {
  constexpr int most = 32;
  const FrameTimes& times = view.times();
  const auto camera = [&](SimTime t) { return view.camera_from_gcrs(t) * towards(t); };
  const double moves_px = angle_rad(camera(times.start), camera(times.end)) /
                          view.sensor().camera.optics.pixel_angle_rad();
  const int count = moves_px < 0.25 ? 1 : std::clamp(int(std::ceil(2.0 * moves_px)), 2, most);
  std::vector<SimTime> drawn;
  for (int i = 0; i < count; ++i) drawn.push_back(times.at((i + 0.5) / count));
  return drawn;
}

void draw(const View& view, const Disc& disc, const std::vector<SimTime>& times,
          OpticsStage& optics, ExpectedElectronImage& image, Threads& threads) {
  if (disc.box.empty()) return;
  DiscWindow window(view, disc, times.size(), threads);
  for (const SimTime t : times) window.add(t, 1.0 / double(times.size()));
  optics.add_extended(window.finish(), image);
}

/// Times whose boxes together hold the disc throughout the exposure.
std::vector<SimTime> times_of_box(const View& view, const std::vector<SimTime>& drawn) {
  const FrameTimes all = view.times_of_all_rows();
  if (all.end == view.times().end) return drawn;
  constexpr int steps = 32;
  std::vector<SimTime> times;
  for (int k = 0; k <= steps; ++k) times.push_back(all.at(double(k) / steps));
  return times;
}

/// Rows of a rolling shutter between whose exposures nothing of a disc moves by more than a small
/// part of a pixel. `passes_rad_per_s`: how fast what is near passes by.
int rows_together(const View& view, const std::function<Vec<Gcrs>(SimTime)>& towards,
                  double passes_rad_per_s) {
  if (!view.rolls()) return 1;
  constexpr int steps = 16;
  constexpr double still_px = 0.02;
  const Optics& optics = view.sensor().camera.optics;
  const FrameTimes all = view.times_of_all_rows();
  const double seconds = all.seconds() / steps;
  double fastest_rad_per_s = 0.0;
  for (int k = 0; k < steps; ++k) {
    const SimTime a = all.at(double(k) / steps), b = all.at(double(k + 1) / steps);
    const double turns_rad =
        rotation_angle_rad(view.camera_from_gcrs(b) * view.camera_from_gcrs(a).inverse());
    fastest_rad_per_s =
        std::max(fastest_rad_per_s, (turns_rad + angle_rad(towards(a), towards(b))) / seconds);
  }
  const double px_per_row = (fastest_rad_per_s + passes_rad_per_s) / optics.pixel_angle_rad() *
                            view.row_delay(1.0).seconds();
  return int(std::clamp(still_px / std::max(px_per_row, 1e-9), 1.0, 1e6));
}

constexpr double min_large_px = 64.0;

using SeenAt = std::function<SeenBody(const View&, SimTime)>;

/// A disc of Sun, Moon or a planet, but for its radiance.
Disc round_disc(const View& view, const SeenAt& seen, const std::vector<SimTime>& times,
                int reach_px) {
  Disc disc;
  for (const SimTime t : times_of_box(view, times))
    disc.box = both(disc.box, box_of(view, seen(view, t), t, reach_px));
  disc.rows_together = rows_together(
      view, [&](SimTime t) { return seen(view, t).apparent; }, 0.0);
  const SeenBody middle = seen(view, view.times().middle);
  const double radius_px =
      middle.radius_rad / pixel_rad_near(view, middle.apparent, view.times().middle);
  disc.changes_within_pixels = radius_px < 4.0;
  disc.radius_px = disc.finest_px = radius_px;
  disc.box_at = [&view, seen, reach_px](SimTime t) {
    return box_of(view, seen(view, t), t, reach_px);
  };
  disc.is_large = radius_px > min_large_px && !view.scene().clouds;
  return disc;
}

/// What of a body's light passes Earth and air, by apparent direction.
struct Way {
  std::optional<EarthOccultation> earth;
  std::shared_ptr<const Throughput> throughput;

  Way(const View& view, SimTime t, std::shared_ptr<const Throughput> air)
      : earth(view.earth_occultation(t)), throughput(std::move(air)) {}
  bool hides(const Vec<Gcrs>& apparent) const { return earth && earth->hides_direction(apparent); }
  double air(const Vec<Gcrs>& apparent) const { return throughput->of_sunlight(apparent); }
};

}  // namespace

void draw_sun(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
              Threads& threads) {
  const auto times = times_of(view, [&](SimTime t) { return seen_sun(view, t).apparent; });
  Disc disc = round_disc(view, seen_sun, times, optics.reach_px());
  const auto air = std::make_shared<const Throughput>(view);
  disc.at = [&, air](SimTime t) -> Radiance {
    const SeenBody sun = seen_sun(view, t), moon = seen_moon(view, t);
    const double distance_m = norm(sun.above_air_m);
    return [=, way = Way(view, t, air), above = AboveAir(view, t, distance_m),
            radiance = SunRadiance(view.sensor().camera.band, distance_m),
            centre = unit(sun.above_air_m), moon_centre = unit(moon.above_air_m),
            moon_rad = moon.radius_rad](const Vec<Gcrs>& apparent) {
      if (way.hides(apparent)) return -1.0;
      const Vec<Gcrs> from = above.of(apparent);
      const double photons = radiance.photons_per_s_m2_sr(angle_rad(from, centre));
      if (photons < 0.0 || angle_rad(from, moon_centre) < moon_rad) return -1.0;
      return photons * way.air(apparent);
    };
  };
  draw(view, disc, times, optics, image, threads);
}

void draw_moon(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
               Threads& threads) {
  const auto times = times_of(view, [&](SimTime t) { return seen_moon(view, t).apparent; });
  Disc disc = round_disc(view, seen_moon, times, optics.reach_px());
  const SimTime middle = view.times().middle;
  const Band& band = view.sensor().camera.band;
  const MoonRadiance moon(band, seen_moon(view, middle).above_air_m,
                          seen_sun(view, middle).above_air_m);
  disc.finest_px *= 1.0 + std::cos(moon.phase_rad());  // a crescent is thin
  const auto air = std::make_shared<const Throughput>(view);
  disc.at = [&, air](SimTime t) -> Radiance {
    const Vec<Gcrs> moon_m = seen_moon(view, t).above_air_m;
    return [=, way = Way(view, t, air), above = AboveAir(view, t, norm(moon_m)),
            radiance = MoonRadiance(band, moon_m, seen_sun(view, t).above_air_m)](
               const Vec<Gcrs>& apparent) {
      if (way.hides(apparent)) return -1.0;
      const double photons = radiance.photons_per_s_m2_sr(above.of(apparent));
      return photons > 0.0 ? photons * way.air(apparent) : photons;
    };
  };
  draw(view, disc, times, optics, image, threads);
}

void draw_planet_discs(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
                       Threads& threads) {
  const StarLight light(view.sensor().camera.band);
  const auto air = std::make_shared<const Throughput>(view);
  for (const Planet planet : view.planets()) {
    const SeenPlanet middle = seen_planet(view, planet, view.times().middle);
    if (!is_drawn_as_disc(view, middle)) continue;
    const SeenAt seen = [planet](const View& by, SimTime t) -> SeenBody {
      const SeenPlanet at = seen_planet(by, planet, t);
      return {at.from_observer_m, at.apparent, at.radius_rad};
    };
    const auto times = times_of(view, [&](SimTime t) { return seen(view, t).apparent; });
    Disc disc = round_disc(view, seen, times, optics.reach_px());
    disc.finest_px *= 1.0 + std::cos(angle_rad(middle.from_sun_m, middle.from_observer_m));
    // The corners of the pixels at the bright limb of a crescent give 2 % too much.
    disc.changes_within_pixels = !disc.is_large;
    disc.at = [&, planet](SimTime t) -> Radiance {
      const SeenPlanet at = seen_planet(view, planet, t);
      const auto& [name, radius_m, bv] = facts_of(planet);
      // Seen through one air, and refracted as one.
      const Vec<Gcrs> centre_m = at.apparent * norm(at.from_observer_m);
      const LitSphere sphere(
          centre_m, centre_m - at.from_sun_m, radius_m,
          light.photons_per_s_m2(at.v_mag, bv) * air->of_sunlight(at.apparent, bv));
      return [=, way = Way(view, t, air)](const Vec<Gcrs>& apparent) {
        return way.hides(apparent) ? -1.0 : sphere.photons_per_s_m2_sr(apparent);
      };
    };
    draw(view, disc, times, optics, image, threads);
  }
}

void draw_earth(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
                Threads& threads) {
  const auto down = [&](SimTime t) { return -unit(view.observer(t).position_m); };
  const auto times = times_of(view, down);
  Disc disc{.box = frame_and_margin(view, optics.reach_px())};
  const SimTime middle = view.times().middle;
  const Vec<Gcrs> here_m = view.observer(middle).position_m;
  const double sine = view.sensor().ellipsoid.equatorial_radius_m / norm(here_m);
  if (sine < 0.5) {
    disc.box = {};
    for (const SimTime t : times_of_box(view, {view.times().start, middle, view.times().end})) {
      const Vec<Gcrs> at_m = view.observer(t).position_m;
      disc.box =
          both(disc.box, box_of(view, {.apparent = -unit(at_m), .radius_rad = std::asin(sine)}, t,
                                optics.reach_px()));
    }
    disc.radius_px = disc.finest_px = std::asin(sine) / pixel_rad_near(view, -unit(here_m), middle);
    disc.changes_within_pixels = disc.finest_px < 4.0;
  }
  disc.is_large = disc.finest_px > min_large_px;
  const double height_m = norm(here_m) - view.sensor().ellipsoid.equatorial_radius_m;
  disc.rows_together = rows_together(
      view, down, norm(view.observer(middle).velocity_m_per_s) / std::max(height_m, 1e3));
  disc.at = [&](SimTime t) -> Radiance {
    return [radiance = EarthRadiance(view.sensor().camera.band, view.observer(t).position_m,
                                     view.environment().sun_m, view.surface(),
                                     view.sensor().earth_albedo)](const Vec<Gcrs>& apparent) {
      return radiance.photons_per_s_m2_sr(apparent);
    };
  };
  draw(view, disc, times, optics, image, threads);
}

void add_disc_facts(const View& view, PlanFacts& f) {
  const SensorConfig& sensor = view.sensor();
  const SceneFacts scene = view.scene();
  f.scene.sun_in_field = scene.sun_in_field;
  f.scene.moon_in_field = scene.moon_in_field;
  f.scene.earth_in_field = scene.earth_in_field;
  f.stray_light_e = stray_light_e(view);
  for (SkySample& s : f.sky) {
    s.sky_e += f.stray_light_e;
    s.noise_e = std::sqrt(s.noise_e * s.noise_e + f.stray_light_e);
  }
  const SimTime t = view.times().middle;
  const Band& band = sensor.camera.band;
  double radiance = 0.0;
  const auto moves_by = [&](const Vec<Gcrs>& velocity_m_per_s) {
    f.light_time_rad = std::max(f.light_time_rad, norm(velocity_m_per_s) / speed_of_light_m_per_s);
  };
  if (scene.sun_in_field) moves_by(view.environment().earth_velocity_m_per_s);
  if (scene.moon_in_field) moves_by(view.environment().moon_velocity_m_per_s);
  if (scene.sun_in_field)
    radiance = SunRadiance(band, norm(seen_sun(view, t).above_air_m)).photons_per_s_m2_sr(0.0);
  if (scene.moon_in_field)
    radiance = std::max(
        radiance, MoonRadiance(band, seen_moon(view, t).above_air_m, seen_sun(view, t).above_air_m)
                      .max_photons_per_s_m2_sr());
  if (scene.earth_in_field)
    radiance = std::max(radiance,
                        EarthRadiance(band, view.observer(t).position_m, view.environment().sun_m,
                                      view.surface(), sensor.earth_albedo)
                            .max_photons_per_s_m2_sr());
  if (!(radiance > 0.0)) return;
  const Optics& optics = sensor.camera.optics;
  f.disc_e = radiance * Throughput(view).electrons_per_photon_m2() * view.times().seconds() *
             pixel_solid_angle_sr(optics, principal_point(optics));
  double noise_e2 = 0.0;
  for (const SkySample& s : f.sky) noise_e2 = std::max(noise_e2, s.noise_e * s.noise_e);
  f.sky.push_back({.sky_e = f.disc_e, .noise_e = std::sqrt(noise_e2 + f.disc_e)});
}

}  // namespace dmise
