#include "sensors/planning/sky_facts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "core/effects/frame_effects.h"
#include "core/frames/sky_frames.h"
#include "core/sky/air/airmass.h"
#include "core/sky/air/cloud_cover.h"
#include "core/sky/air/dispersion.h"
#include "core/sky/air/scintillation.h"
#include "core/sky/scattered_moonlight.h"
#include "core/sky/stars/star_counts.h"
#include "sensors/light/disc_layer.h"
#include "sensors/scene/limb_layer.h"
#include "sensors/scene/throughput.h"
#include "sensors/sky/sky_light.h"
#include "sensors/sky/thermal_optics.h"

namespace dmise {
namespace {

constexpr double near_horizon_rad = 2.0 * deg;

EarthOccultation earth_seen(const View& view, SimTime t) {
  if (view.on_ground()) return {view.up(t), std::nullopt};
  return {view.up(t), FreeSight(view.observer(t).position_m, view.surface())};
}

/// Starlight that is not drawn star by star, by the limit of those that are.
class StarlightByLimit {
 public:
  StarlightByLimit(const View& view, const DrawnStars& drawn)
      : given_(view.sensor().sky.parts.faint_starlight),
        drawn_to_v_mag_(drawn.to_v_mag),
        by_counts_(drawn.by_counts),
        pole_(galactic_from_gcrs().inverse() * Vec<Galactic>{0, 0, 1}) {}

  void look(const Vec<Gcrs>& direction, double starlight_e) {
    if (!(starlight_e > 0.0)) return;
    if (by_counts_) look_by_counts(direction, starlight_e);
    const double sine = dot(pole_, direction);
    least_ = std::min(least_, sine);
    most_ = std::max(most_, sine);
    e_per_s10_ = std::max(e_per_s10_, starlight_e / std::max(s10(drawn_to_v_mag_, sine), 1e-9));
  }
  /// Sets what limits add to a pixel, and how much brighter it is nearest to the galactic plane
  /// than at the samples.
  void add(PlanFacts& f) const {
    if (!(e_per_s10_ > 0.0)) return;
    if (by_counts_) {
      f.starlight_e = counted_e_;
      return;
    }
    const double between = 0.25 * (most_ - least_);
    const double nearest =
        most_ * least_ <= 0.0
            ? 0.0
            : std::max(0.0, std::min(std::abs(most_), std::abs(least_)) - between);
    const double sampled = std::min(std::abs(most_), std::abs(least_));
    double& brighter = f.between_samples[static_cast<std::size_t>(SkyPart::faint_starlight)];
    brighter *= s10(drawn_to_v_mag_, nearest) /
                std::max(s10(drawn_to_v_mag_, most_ * least_ <= 0.0 ? between : sampled), 1e-9);
    for (std::size_t m = 0; m < f.starlight_e.size(); ++m)
      f.starlight_e[m] = 1.25 * e_per_s10_ *
                         std::max(0.0, s10(double(m), nearest) - s10(drawn_to_v_mag_, nearest));
  }

 private:
  double s10(double limit_v_mag, double sine) const {
    FaintStarlight starlight = *given_;
    starlight.brighter_limit_v_mag = limit_v_mag;
    return faint_starlight_s10(starlight, sine);
  }

  void look_by_counts(const Vec<Gcrs>& direction, double starlight_e) {
    const Vec<Galactic> galactic = galactic_from_gcrs() * direction;
    const double left = starlight_of_counts_s10(drawn_to_v_mag_, galactic);
    const double e_per_s10 = starlight_e / std::max(left, 1e-9);
    for (std::size_t m = 0; m < counted_e_.size() && double(m) < drawn_to_v_mag_; ++m)
      counted_e_[m] = std::max(
          counted_e_[m], 1.25 * e_per_s10 * (starlight_of_counts_s10(double(m), galactic) - left));
  }

  std::optional<FaintStarlight> given_;
  double drawn_to_v_mag_;
  bool by_counts_;
  std::array<double, star_limits> counted_e_{};
  Vec<Gcrs> pole_;
  double least_ = 1.0, most_ = -1.0, e_per_s10_ = 0.0;  // sines of the latitude
};

/// Whether the Earth's limb may be in the field of a sensor in space, also between the samples.
bool sees_limb(const View& view, SimTime t) {
  const Vec<Gcrs> here_m = view.observer(t).position_m;
  const double earth_rad = std::asin(
      std::min(1.0, view.sensor().ellipsoid.equatorial_radius_m / std::max(norm(here_m), 1.0)));
  return angle_rad(view.boresight(t), -here_m) <
         earth_rad + half_diagonal_rad(view.sensor().camera.optics) + near_horizon_rad;
}

/// Size of the smallest pieces of patchy clouds in a field that reaches down to `lowest_rad`.
double cloud_detail_px(const View& view, double lowest_rad, double pixel_rad) {
  const auto& clouds = view.sensor().weather.clouds;
  const auto* patches = clouds ? std::get_if<PatchyClouds>(&*clouds) : nullptr;
  if (!patches || !view.sensor().effects.has(CloudCover::facts)) return unbounded;
  constexpr double finest = 1.0 / 16.0;  // size of the last of five octaves, the first being 1
  const double sine = std::max(0.02, std::sin(lowest_rad));
  return finest * patches->patch_m / patches->height_m * sine * sine / pixel_rad;
}

/// How far the field of a sensor on the ground moves over its sky from mid exposure on.
double moves_rad(const View& view) {
  const auto seen = [&](SimTime t) { return view.enu_from_gcrs(t) * view.boresight(t); };
  const Vec<Enu> middle = seen(view.times().middle);
  return std::max(angle_rad(middle, seen(view.times().start)),
                  angle_rad(middle, seen(view.times().end)));
}

constexpr double held_rad = moonlight_held_within_deg * deg;

/// How far the field is from the Moon at mid exposure; 0 where the Moon is in it.
double from_moon_rad(const View& view, const Vec<Gcrs>& moon) {
  const Optics& optics = view.sensor().camera.optics;
  const Vec<CameraFrame> direction = view.camera_from_gcrs(view.times().middle) * moon;
  const auto at = project(optics, direction);
  if (!at) return angle_rad(direction, Vec<CameraFrame>{0, 0, 1}) - half_diagonal_rad(optics);
  const auto nearest = unproject(optics, {std::clamp(at->x_px, 0.0, optics.columns - 1.0),
                                          std::clamp(at->y_px, 0.0, optics.rows - 1.0)});
  return nearest ? angle_rad(direction, *nearest) : 0.0;
}

/// Where twilight or daylight is brightest in a field on the ground, which may be between the
/// samples: over the horizon, towards the Sun (in a wide field), or at the Sun itself. Empty where
/// that is not in the field.
std::optional<PixelPosition> brightest_sunlit_sky(const View& view) {
  constexpr double wide_rad = 10.0 * deg, over_horizon = 0.01;
  const Optics& optics = view.sensor().camera.optics;
  if (!view.on_ground()) return std::nullopt;
  const SimTime middle = view.times().middle;
  const auto enu_from_gcrs = view.enu_from_gcrs(middle);
  Vec<Enu> sun = enu_from_gcrs * unit(view.environment().sun_m);
  const bool is_up = sun.z > over_horizon;
  if (!is_up && half_diagonal_rad(optics) < wide_rad) return std::nullopt;
  if (!is_up) sun.z = over_horizon;
  const auto at =
      project(optics, view.camera_from_gcrs(middle) * enu_from_gcrs.inverse() * unit(sun));
  if (!at || at->x_px < 0.0 || at->y_px < 0.0 || at->x_px > optics.columns - 1.0 ||
      at->y_px > optics.rows - 1.0 || !unproject(optics, *at))
    return std::nullopt;
  return at;
}

}  // namespace

void add_sky_facts(const View& view, const DrawnStars& drawn, PlanFacts& f) {
  const SensorConfig& sensor = view.sensor();
  const Optics& optics = sensor.camera.optics;
  const SimTime middle = view.times().middle;
  const auto gcrs_from_camera = view.camera_from_gcrs(middle).inverse();
  const auto enu_from_gcrs = view.enu_from_gcrs(middle);
  const EarthOccultation earth = earth_seen(view, middle);
  const Throughput throughput(view);
  // Without a sky the band may reach beyond what is known of its light.
  const auto sky = sensor.effects.has(SkyBackground::facts) ? std::optional(sky_over(view, drawn))
                                                            : std::nullopt;
  const double electrons = throughput.electrons_per_photon_m2() * view.times().seconds();
  const double read_e2 =
      f.read_noise_e * f.read_noise_e + std::pow(sensor.camera.detector.gain_e_per_dn, 2) / 12.0;
  StarlightByLimit starlight(view, drawn);
  const Vec<Gcrs> moon = unit(view.environment().moon_m - view.observer(middle).position_m);
  double lowest_rad = pi / 2, sampled_moon_rad = pi;
  const auto look = [&](PixelPosition at, const Vec<CameraFrame>& direction) {
    const Vec<Gcrs> gcrs = gcrs_from_camera * direction;
    if (earth.hides_direction(gcrs)) {
      f.sees_horizon = true;
      return;
    }
    const Vec<Enu> enu = enu_from_gcrs * gcrs;
    sampled_moon_rad = std::min(sampled_moon_rad, angle_rad(gcrs, moon));
    if (view.on_ground()) lowest_rad = std::min(lowest_rad, std::asin(std::clamp(enu.z, 0.0, 1.0)));
    SkySample s;
    if (sky) {
      const auto photons = sky->photons_of_parts(enu);
      const double factor = electrons * pixel_solid_angle_sr(optics, at) * view.illumination(at);
      for (std::size_t part = 0; part < photons.size(); ++part) {
        s.part_e[part] = photons[part] * factor;
        s.sky_e += s.part_e[part];
      }
    }
    s.noise_e = std::sqrt(std::max(s.sky_e + f.dark_e + read_e2, 1e-6));
    starlight.look(gcrs, s.of(SkyPart::faint_starlight));
    f.sky.push_back(s);
  };
  look_over(optics, 0.0, look);
  if (const auto at = brightest_sunlit_sky(view)) look(*at, *unproject(optics, *at));
  starlight.add(f);
  if (f.sky.empty()) f.sky.push_back({.noise_e = std::sqrt(std::max(f.dark_e + read_e2, 1e-6))});
  f.thermal_optics_e = thermal_optics_e(view);
  for (SkySample& s : f.sky) {
    s.sky_e += f.thermal_optics_e;
    s.noise_e = std::sqrt(s.noise_e * s.noise_e + f.thermal_optics_e);
  }
  add_disc_facts(view, f);
  add_limb_facts(view, f);
  if (!view.on_ground()) {
    f.sky_look_s = 0.16e-6;
    f.sees_horizon = f.sees_horizon || sees_limb(view, middle);
    return;
  }
  lowest_rad = std::max(0.0, lowest_rad - moves_rad(view));
  f.sees_horizon = f.sees_horizon || lowest_rad < near_horizon_rad;
  f.cloud_detail_px = cloud_detail_px(view, lowest_rad, f.pixel_rad);
  f.max_airmass = airmass(lowest_rad);
  f.sees_zenith = angle_rad(view.boresight(middle), view.up(middle)) <
                  1.1 * half_diagonal_rad(optics) + moves_rad(view);
  f.zenith_extinction_mag = throughput.extinction_mag_per_airmass();
  if (const auto* gases = throughput.find<GasAbsorption>())
    f.gas_mag = gases->sunlight_mag(f.max_airmass);
  f.scintillation = scintillation_sigma(optics.aperture_m, view.times().seconds(), f.max_airmass,
                                        view.site()->height_m);
  f.refraction_rad = view.refraction().at_apparent_rad(lowest_rad);
  f.dispersion_rad = dispersion_rad(sensor.camera.band, view.refraction(), lowest_rad);
  const double moon_up_rad = elevation_over(view.up(middle), moon);
  f.moon_refraction_rad = view.refraction().apparent_from_true_rad(moon_up_rad) - moon_up_rad;
  f.moon_is_down = moon_up_rad < 0.0;
  f.nearest_moon_rad = from_moon_rad(view, moon) - f.moon_refraction_rad;
  f.nearest_moon_rad = std::max(held_rad, f.nearest_moon_rad);
  f.between_samples[static_cast<std::size_t>(SkyPart::scattered_moonlight)] *=
      std::max(1.0, moonlight_scattering(f.nearest_moon_rad) /
                        moonlight_scattering(std::max(held_rad, sampled_moon_rad)));
}

}  // namespace dmise
