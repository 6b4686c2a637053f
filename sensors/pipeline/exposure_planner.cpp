#include "sensors/pipeline/exposure_planner.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/config/effect_list.h"
#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "core/optics/psf_table.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/star_light.h"
#include "core/sky/airmass.h"
#include "core/sky/scintillation.h"
#include "core/sky/shadow.h"
#include "core/sky/sky_frames.h"
#include "sensors/pipeline/object_sampler.h"
#include "sensors/pipeline/sky_layer.h"
#include "sensors/pipeline/throughput.h"

namespace dmise {
namespace {

/// Pixels along each side at which a field is looked at.
constexpr int looks = 5;
constexpr double near_horizon_rad = 2.0 * deg;
/// In longer exposures an object may pass the shadow between the instants that are looked at.
constexpr double short_exposure_s = 60.0;
constexpr double aberration_constant_rad = 20.8 / 3600.0 * deg;  // at perihelion
/// B - V of the stars by whose light the brightest that is left out is known.
constexpr double colours_bv[] = {0.0, 0.6, 1.4};
constexpr double solid_angle_of_sky_sr = 4.0 * pi;

/// Share of a point's light in the pixel on which it is centred.
double peak_share(double fwhm_px) {
  const double sigma_px = std::max(fwhm_px, 1e-3) / fwhm_per_sigma;
  const double along = std::erf(0.5 / (std::sqrt(2.0) * sigma_px));
  return along * along;
}

/// Largest sine of the angle to `axis` of directions within `half_rad` of `boresight`.
double largest_sine(const Vec<Gcrs>& axis, const Vec<Gcrs>& boresight, double half_rad) {
  const double angle = angle_rad(axis, boresight);
  const double least = std::max(0.0, angle - half_rad), most = std::min(pi, angle + half_rad);
  if (least <= pi / 2 && most >= pi / 2) return 1.0;
  return std::max(std::sin(least), std::sin(most));
}

Vec<Gcrs> boresight(const View& view) {
  return view.camera_from_gcrs(view.times().middle).inverse() * Vec<CameraFrame>{0, 0, 1};
}

}  // namespace

ExposurePlanner::ExposurePlanner(const SensorConfig& sensor, const StarMap* stars,
                                 double faintest_star_mag, const ObjectShapes* shapes)
    : sensor_(sensor), stars_(stars), shapes_(shapes), faintest_star_mag_(faintest_star_mag) {
  SceneFacts scene = scene_facts(sensor);
  scene.stars = stars != nullptr;
  scene.shapes = shapes && !shapes->empty();
  effects_ = plannable_effects(sensor, scene);
  PlanFacts& f = of_sensor_;
  const Optics& optics = sensor.camera.optics;
  const Band& band = sensor.camera.band;
  f.scene = scene;
  f.columns = optics.columns;
  f.rows = optics.rows;
  f.relative_bandwidth = band.width_m / band.centre_m;
  const PsfPlan blur = plan_psf(optics, band.centre_m, sensor.seeing, sensor.exposure_s);
  f.fwhm_px = blur.fwhm_px;
  f.peak_share = peak_share(blur.fwhm_px);
  f.read_noise_e = sensor.camera.detector.read_noise_e;
  f.dark_e = dark_rate_e_per_s(sensor.camera.detector) * sensor.exposure_s;
  if (blur.method != PointSpread::Method::deposit) {
    constexpr double cell_s = 300e-9;
    const double cells = 4.0 * blur.half_cells * blur.half_cells;
    f.kernels_change = blur.screens > 0;
    f.kernel_s = cell_s * cells * std::max(1, blur.screens) * optics.spread.grid_columns *
                 optics.spread.grid_rows;
  }
  // The finest scale: neighbours of pixels from the centre to a corner.
  f.pixel_rad = optics.pixel_angle_rad();
  for (int i = 0; i < looks; ++i)
    for (int j = 0; j < looks; ++j) {
      const PixelPosition at{i * (optics.columns - 2.0) / (looks - 1),
                             j * (optics.rows - 2.0) / (looks - 1)};
      const auto here = unproject(optics, at);
      if (!here) continue;
      for (const PixelPosition next :
           {PixelPosition{at.x_px + 1, at.y_px}, PixelPosition{at.x_px, at.y_px + 1}})
        if (const auto there = unproject(optics, next))
          f.pixel_rad = std::min(f.pixel_rad, std::max(angle_rad(*here, *there), 1e-12));
      f.least_illumination = std::min(
          f.least_illumination, optics.vignetting.any() ? relative_illumination(optics, at) : 1.0);
    }
  const StarLight light(band);
  for (const double bv : colours_bv)
    zero_photons_per_s_m2_ = std::max(zero_photons_per_s_m2_, light.photons_per_s_m2(0.0, bv));
  if (!stars) return;
  const StarTable& table = stars->stars;
  faintest_filled_v_mag_ = dmise::faintest_filled_v_mag(table.v_mag);
  for (std::size_t i = 0; i < table.v_mag.size(); ++i) {
    if (table.v_mag[i] > faintest_star_mag) continue;
    const auto first = std::size_t(std::clamp(std::ceil(double(table.v_mag[i])), 0.0, 31.0));
    catalogue_brighter_[first] += 1.0;
    fastest_rad_per_yr_ = std::max(fastest_rad_per_yr_, std::hypot(table.pm_ra_cosdec_rad_per_yr[i],
                                                                   table.pm_dec_rad_per_yr[i]));
    largest_parallax_rad_ = std::max(largest_parallax_rad_, double(table.parallax_rad[i]));
  }
  for (std::size_t m = 1; m < catalogue_brighter_.size(); ++m)
    catalogue_brighter_[m] += catalogue_brighter_[m - 1];
  if (stars->file) stars->file->release();  // the columns that only this has read
}

void ExposurePlanner::look_at_sky(const View& view, PlanFacts& f) const {
  const Optics& optics = sensor_.camera.optics;
  const SimTime middle = view.times().middle;
  const auto gcrs_from_camera = view.camera_from_gcrs(middle).inverse();
  const auto enu_from_gcrs = view.enu_from_gcrs(middle);
  std::optional<EarthOccultation> earth;
  if (view.on_ground())
    earth.emplace(view.up(middle), std::nullopt);
  else
    earth.emplace(view.up(middle),
                  FreeSight(view.observer(middle).position_m, oblate_earth(view.earth())));
  const bool with_sky = sensor_.effects.has(SkyBackground::facts);
  const Throughput throughput(view);
  const double drawn_to_v_mag = stars_ && sensor_.effects.has(StarBackground::facts)
                                    ? std::min(faintest_star_mag_, faintest_filled_v_mag_)
                                    : -unbounded;
  const SkyModel sky = sky_over(view, drawn_to_v_mag);
  const double electrons = throughput.electrons_per_photon_m2() * view.times().seconds();
  const double read_e2 =
      f.read_noise_e * f.read_noise_e + std::pow(sensor_.camera.detector.gain_e_per_dn, 2) / 12.0;
  const Vec<Gcrs> galactic_pole = galactic_from_gcrs().inverse() * Vec<Galactic>{0, 0, 1};
  const auto faint_s10 = [&](double limit_v_mag, double sine) {
    FaintStarlight starlight = *sensor_.sky.parts.faint_starlight;
    starlight.brighter_limit_v_mag = limit_v_mag;
    return faint_starlight_s10(starlight, sine);
  };
  double nearest_to_galaxy = 1.0, e_per_s10 = 0.0;
  double lowest_rad = pi / 2;
  for (int i = 0; i < looks; ++i)
    for (int j = 0; j < looks; ++j) {
      const PixelPosition at{i * (optics.columns - 1.0) / (looks - 1),
                             j * (optics.rows - 1.0) / (looks - 1)};
      const auto direction = unproject(optics, at);
      if (!direction) continue;
      const Vec<Gcrs> gcrs = gcrs_from_camera * *direction;
      if (earth->hides_direction(gcrs)) {
        f.sees_horizon = true;
        continue;
      }
      const Vec<Enu> enu = enu_from_gcrs * gcrs;
      if (view.on_ground())
        lowest_rad = std::min(lowest_rad, std::asin(std::clamp(enu.z, 0.0, 1.0)));
      SkySample s;
      if (with_sky) {
        const auto photons = sky.photons_of_parts(enu);
        const double factor = electrons * pixel_solid_angle_sr(optics, at) * view.illumination(at);
        for (std::size_t part = 0; part < photons.size(); ++part) {
          s.part_e[part] = photons[part] * factor;
          s.sky_e += s.part_e[part];
        }
      }
      s.noise_e = std::sqrt(std::max(s.sky_e + f.dark_e + read_e2, 1e-6));
      if (s.part_e[3] > 0.0) {
        const double sine = dot(galactic_pole, gcrs);
        nearest_to_galaxy = std::min(nearest_to_galaxy, std::abs(sine));
        e_per_s10 =
            std::max(e_per_s10, s.part_e[3] / std::max(faint_s10(drawn_to_v_mag, sine), 1e-9));
      }
      f.sky.push_back(s);
    }
  for (std::size_t m = 0; e_per_s10 > 0.0 && m < f.starlight_e.size(); ++m)
    f.starlight_e[m] = 1.25 * e_per_s10 *
                       std::max(0.0, faint_s10(double(m), nearest_to_galaxy) -
                                         faint_s10(drawn_to_v_mag, nearest_to_galaxy));
  if (f.sky.empty()) f.sky.push_back({.noise_e = std::sqrt(std::max(f.dark_e + read_e2, 1e-6))});
  if (!view.on_ground()) {
    f.sky_look_s = 0.16e-6;
    // A limb between the samples: the field against the Earth's disc.
    const Vec<Gcrs> here_m = view.observer(middle).position_m;
    const double earth_rad =
        std::asin(std::min(1.0, wgs84.equatorial_radius_m / std::max(norm(here_m), 1.0)));
    f.sees_horizon = f.sees_horizon || angle_rad(boresight(view), -here_m) <
                                           earth_rad + half_diagonal_rad(optics) + near_horizon_rad;
    return;
  }
  f.sees_horizon =
      f.sees_horizon || lowest_rad < near_horizon_rad || sensor_.tracking != Tracking::fixed;
  f.most_airmass = airmass(lowest_rad);
  f.zenith_extinction_mag = throughput.extinction_mag_per_airmass();
  f.scintillation = scintillation_sigma(optics.aperture_m, view.times().seconds(), f.most_airmass,
                                        view.site()->height_m);
  f.refraction_rad = view.refraction().at_apparent_rad(lowest_rad);
}

void ExposurePlanner::look_at_stars(const View& view, PlanFacts& f) const {
  const Optics& optics = sensor_.camera.optics;
  const auto& environment = view.environment();
  const Vec<Gcrs> axis = boresight(view);
  const double half_rad = half_diagonal_rad(optics);
  const SimTime middle = view.times().middle;
  f.nearest_sun_rad = std::max(
      0.0, angle_rad(axis, environment.sun_m - view.observer(middle).position_m) - half_rad);
  f.annual_aberration_rad =
      aberration_constant_rad * largest_sine(environment.earth_velocity_m_per_s, axis, half_rad);
  const Vec<Gcrs> velocity = view.observer(middle).velocity_m_per_s;
  f.diurnal_aberration_rad =
      1.01 * norm(velocity) / speed_of_light_m_per_s * largest_sine(velocity, axis, half_rad);
  if (!stars_) return;
  const double share = std::min(1.0, 0.5 * (1.0 - std::cos(std::min(half_rad, pi))));  // of the sky
  for (std::size_t m = 0; m < f.stars_brighter.size(); ++m)
    f.stars_brighter[m] = catalogue_brighter_[m] * share;
  f.stars = f.stars_brighter.back();
  const double years = 2000.0 +
                       julian_years_since_j2000(Tt{environment.tt_jd1, environment.tt_jd2}) -
                       stars_->stars.epoch_jyear;
  f.star_shift_rad = fastest_rad_per_yr_ * std::abs(years);
  f.star_parallax_rad = 1.02 * largest_parallax_rad_;
  const Throughput throughput(view);
  f.star_zero_e = zero_photons_per_s_m2_ * throughput.electrons_per_photon_m2() *
                  view.times().seconds() *
                  (view.on_ground() ? light_of_magnitude(0.9 * f.zenith_extinction_mag) : 1.0);
  // The shortest trail: of the directions at which the sky is looked at.
  const auto start = view.camera_from_gcrs(view.times().start);
  const auto end = view.camera_from_gcrs(view.times().end);
  double trail_px = unbounded;
  for (int i = 0; i < looks; ++i)
    for (int j = 0; j < looks; ++j) {
      const auto direction = unproject(optics, {i * (optics.columns - 1.0) / (looks - 1),
                                                j * (optics.rows - 1.0) / (looks - 1)});
      if (!direction) continue;
      const auto there = project(optics, end * (start.inverse() * *direction));
      const auto here = project(optics, *direction);
      if (here && there)
        trail_px =
            std::min(trail_px, std::hypot(there->x_px - here->x_px, there->y_px - here->y_px));
    }
  f.star_peak_share = f.peak_share;
  if (std::isfinite(trail_px) && trail_px > 2.0)
    f.star_peak_share = std::min(f.peak_share, std::sqrt(f.peak_share) / (0.5 * trail_px));
  // The brightest star: the cone is asked for more as long as it holds none.
  std::vector<std::uint32_t> found;
  for (const double limit : {0.0, 2.0, 4.0, 6.0, 8.0, faintest_star_mag_}) {
    if (!found.empty()) break;
    query_cone(stars_->stars.v_mag, stars_->index, axis, std::min(pi, half_rad + 1.3 * deg),
               std::min(limit, faintest_star_mag_), found);
  }
  f.brightest_star_mag = found.empty() ? 99.0 : 30.0;
  for (const std::uint32_t star : found)
    f.brightest_star_mag = std::min(f.brightest_star_mag, double(stars_->stars.v_mag[star]));
  if (found.empty()) f.stars = 0.0, f.stars_brighter = {};
}

void ExposurePlanner::look_at_objects(const View& view, const std::vector<std::size_t>& objects,
                                      PlanFacts& f) const {
  f.objects = objects.size();
  if (objects.empty()) return;
  const auto& times = view.times();
  const ExposureInstant middle(view, times.middle);
  const ObjectSampler sampler(view, shapes_);
  const EarthShadow shadow(view.environment().sun_m, oblate_earth(view.earth()));
  const Throughput throughput(view);
  const double electrons = object_photons_per_s_m2(0.0, sensor_.camera.band) *
                           throughput.electrons_per_photon_m2() * times.seconds();
  f.near_shadow = times.seconds() > short_exposure_s;
  for (const std::size_t object : objects) {
    const Motion motion = view.world().motion(object, times.middle);
    const Vec<Gcrs> line_m = motion.position_m - middle.observer.position_m;
    const double range_m = norm(line_m);
    if (range_m > 0.0)
      f.light_time_rad =
          std::max(f.light_time_rad, 1.01 * norm(cross(motion.slope_m_per_s, line_m)) / range_m /
                                         speed_of_light_m_per_s);
    for (const SimTime t : {times.start, times.middle, times.end})
      f.near_shadow =
          f.near_shadow || shadow.sunlit_fraction(view.world().motion(object, t).position_m) < 1.0;
    if (sampler.shape(object)) {
      ++f.shapes;
      ++f.resolved;
    }
    const double magnitude = sampler.magnitude(object, motion, middle);
    f.brightest_object_e =
        std::max(f.brightest_object_e, 1.5 * electrons * std::pow(10.0, -0.4 * magnitude));
  }
}

PlanFacts ExposurePlanner::facts(const View& view, const std::vector<std::size_t>& objects) const {
  PlanFacts f = of_sensor_;
  look_at_sky(view, f);
  look_at_stars(view, f);
  look_at_objects(view, objects, f);
  return f;
}

EffectPlan ExposurePlanner::plan(const View& view, const std::vector<std::size_t>& objects) const {
  const PlanFacts known = facts(view, objects);
  if (sensor_.recorded_plans.empty())
    return plan_effects(effects_, known, sensor_.effects, sensor_.accuracy);
  return plan_effects(effects_, known, recorded_effects(effects_, sensor_, view.times().frame),
                      sensor_.accuracy);
}

}  // namespace dmise
