#include "sensors/planning/exposure_planner.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/config/sensors/effect_list.h"
#include "core/detector/detector.h"
#include "core/effects/frame_effects.h"
#include "core/optics/psf_plan.h"
#include "core/photometry/magnitude.h"
#include "core/sky/bodies/shadow.h"
#include "sensors/light/planet_layer.h"
#include "sensors/objects/object_sampler.h"
#include "sensors/planning/defocus_facts.h"
#include "sensors/planning/error_facts.h"
#include "sensors/planning/sky_facts.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

/// In longer exposures an object may pass the shadow between the instants that are looked at.
constexpr double short_exposure_s = 60.0;
/// Factors by which an object may be brighter or fainter than its estimate.
constexpr double brighter = 1.5, fainter = 0.1;

/// Share of a point's light in the pixel on which it is centred.
double peak_share(double fwhm_px) {
  const double sigma_px = std::max(fwhm_px, 1e-3) / fwhm_per_sigma;
  const double along = std::erf(0.5 / (std::sqrt(2.0) * sigma_px));
  return along * along;
}

/// Wavelength / aperture.
double airy_px(const Optics& optics, double wavelength_m) {
  return wavelength_m / optics.aperture_m / optics.pixel_angle_rad();
}

/// What pixels, jitter and seeing leave of the rings of diffraction, which are as far from each
/// other as wavelength / aperture. Speckles of short exposures stay.
double ring_contrast(const Optics& optics, double wavelength_m, const PsfPlan& blur) {
  if (blur.screens > 0) return 1.0;
  const double ring_px = airy_px(optics, wavelength_m);
  const double of_optics_px = 1.03 * ring_px;
  const double wider_px =
      std::sqrt(std::max(0.0, blur.fwhm_px * blur.fwhm_px - of_optics_px * of_optics_px));
  const double phase = pi * wider_px / ring_px / fwhm_per_sigma;
  return std::exp(-2.0 * phase * phase) * std::min(1.0, ring_px / pi);
}

/// A pixel's share of a point's light `r_px` from it, but for the taper of kernels: beyond r an
/// Airy pattern has 0.2 (lambda / D) / r of the light, more with an obscuration; seeing falls off
/// as r^(-11/3), to 1e-4 of its peak at five widths.
double kernel_end_share(const Optics& optics, double wavelength_m, const PsfPlan& blur,
                        double r_px) {
  const double of_rings = 0.2 * airy_px(optics, wavelength_m) / (1.0 - optics.obscuration) /
                          (2.0 * pi * r_px * r_px * r_px);
  if (blur.exposure == ExposureKind::none) return of_rings;
  const double widths = r_px / (5.0 * blur.fwhm_px);
  return of_rings + 1e-4 * peak_share(blur.fwhm_px) * std::pow(widths, -11.0 / 3.0);
}

/// Charge that pixels do not exceed; unbounded where blooming carries the excess to others.
double saturated_e(const SensorConfig& sensor) {
  const Detector& detector = sensor.camera.detector;
  const bool limited = detector.well_is_limited && sensor.effects.has(FullWell::facts);
  return limited && !detector.blooming ? detector.full_well_e : unbounded;
}

/// Turbulence before a sensor, whatever level of it the scenario asks for.
AirFacts air_facts(const SensorConfig& sensor) {
  const Optics& optics = sensor.camera.optics;
  const double wavelength_m = sensor.camera.band.centre_m;
  const SensorSeeing& seeing = *sensor.seeing;
  const auto plan = [&](AirTurbulence::Level level) {
    return plan_psf(optics, wavelength_m, seeing, sensor.exposure_s, level);
  };
  AirFacts air{.airy_px = airy_px(optics, wavelength_m),
               .apertures_per_r0 = optics.aperture_m / seeing.r0_at_m(wavelength_m),
               .apertures_blown = seeing.wind_m_per_s * sensor.exposure_s / optics.aperture_m};
  const Detector& detector = sensor.camera.detector;
  if (detector.blooming) air.bleeds_at_e = detector.full_well_e;
  try {
    const PsfPlan whole = plan(AirTurbulence::short_exposure);
    if (whole.method != PointSpread::Method::deposit) air.screens = whole.screens;
    const PsfPlan still = plan(AirTurbulence::off);
    air.still_peak_share = peak_share(still.fwhm_px);
    air.still_is_deposited = still.method == PointSpread::Method::deposit &&
                             whole.method != PointSpread::Method::deposit;
  } catch (const ConfigError&) {  // a blur so narrow takes more cells than there may be
    air.can_be_off = false;
  }
  return air;
}

/// Facts about a blur that changes over the field, and about a focus that drifts.
void add_blur_facts(const Optics& optics, double wavelength_m, PlanFacts& f) {
  const PointSpread& s = optics.spread;
  if (f.scene.blur_varies) {
    const std::size_t reference = FieldBlur::places.size() - 1;
    const FieldGridError left =
        field_grid_error(optics, wavelength_m, FieldBlur::places[reference]);
    for (std::size_t level = 0; level < reference; ++level) {
      const FieldGridError error = field_grid_error(optics, wavelength_m, FieldBlur::places[level]);
      f.field_misplaced[level] = error.misplaced + left.misplaced;
      f.field_shift_px[level] = error.shift_px + left.shift_px;
    }
  }
  if (!f.scene.focus_drifts) return;
  f.kernels_change = true;
  f.defocus_px = s.drift.max_m() / optics.f_number() / optics.pixel_pitch_m;
}

}  // namespace

ExposurePlanner::ExposurePlanner(const SensorConfig& sensor, const StarMap* stars,
                                 double faintest_star_mag, const ObjectShapes* shapes)
    : sensor_(sensor), shapes_(shapes), stars_(sensor, stars, faintest_star_mag) {
  SceneFacts& scene = of_sensor_.scene;
  scene = scene_facts(sensor);
  scene.stars = stars != nullptr;
  tell_shapes(scene, shapes);
  effects_ = plannable_effects(sensor, scene);
  SceneFacts dark = scene;
  dark.shutter_closed = true;
  effects_in_the_dark_ = plannable_effects(sensor, dark);
  look_at_sensor();
}

void ExposurePlanner::look_at_sensor() {
  PlanFacts& f = of_sensor_;
  const Optics& optics = sensor_.camera.optics;
  const Band& band = sensor_.camera.band;
  const Detector& detector = sensor_.camera.detector;
  f.columns = optics.columns;
  f.rows = optics.rows;
  f.relative_bandwidth = band.width_m / band.centre_m;
  const PsfPlan blur = plan_psf(optics, band.centre_m, sensor_.seeing, sensor_.exposure_s,
                                AirTurbulence::level(sensor_.effects));
  if (f.scene.turbulent) f.air = air_facts(sensor_);
  f.fwhm_px = blur.fwhm_px;
  f.peak_share = peak_share(blur.fwhm_px);
  if (f.scene.diffracts && !f.scene.blur_of_file)
    f.ring_contrast = ring_contrast(optics, band.centre_m, blur);
  const LensGhost& ghost = optics.image;
  if (ghost.ghost_fraction > 0.0)
    f.ghost_pixel_share =
        ghost.ghost_fraction / std::max(1.0, pi * ghost.ghost_radius_px * ghost.ghost_radius_px);
  f.airy_px = airy_px(optics, band.centre_m);
  f.speckle_px = std::hypot(1.0, f.airy_px);
  f.read_noise_e = detector.fitted_noise_e(detector.read_noise_e);
  f.read_later = reads_after_others(detector);
  f.saturated_e = saturated_e(sensor_);
  f.dark_e = detector.dark_e_per_s * detector.thermal_factor() * sensor_.exposure_s;
  if (blur.method != PointSpread::Method::deposit) {
    f.screens = blur.screens;
    constexpr double cell_s = 200e-9;
    const double cells = 4.0 * blur.half_cells * blur.half_cells;
    f.kernels_change = blur.screens > 0;
    f.min_wavelengths = optics.spread.wavelengths;
    f.kernel_end_px = double(blur.half_cells) / blur.oversampling;
    f.kernel_end_share = kernel_end_share(optics, band.centre_m, blur, f.kernel_end_px);
    f.kernel_s = cell_s * cells * std::max(1, blur.screens) * optics.spread.grid_columns *
                 optics.spread.grid_rows;
  }
  add_blur_facts(optics, band.centre_m, f);
  // The scales: neighbours of pixels from the centre to a corner.
  f.pixel_rad = f.widest_pixel_rad = optics.pixel_angle_rad();
  look_over(optics, 1.0, [&](PixelPosition at, const Vec<CameraFrame>& here) {
    for (const PixelPosition next :
         {PixelPosition{at.x_px + 1, at.y_px}, PixelPosition{at.x_px, at.y_px + 1}})
      if (const auto there = unproject(optics, next)) {
        const double step_rad = std::max(angle_rad(here, *there), 1e-12);
        f.pixel_rad = std::min(f.pixel_rad, step_rad);
        f.widest_pixel_rad = std::max(f.widest_pixel_rad, step_rad);
      }
    if (optics.vignetting.any())
      f.min_illumination = std::min(f.min_illumination, relative_illumination(optics, at));
  });
  f.illumination_slope_per_px = illumination_slope_per_px(optics);
}

void ExposurePlanner::look_at_objects(const View& view, const std::vector<std::size_t>& objects,
                                      PlanFacts& f) const {
  f.objects = objects.size();
  if (objects.empty()) return;
  const auto& times = view.times();
  const Optics& optics = sensor_.camera.optics;
  const ExposureInstant middle(view, times.middle);
  const ObjectSampler sampler(view, shapes_);
  const EarthShadow shadow(view.environment().sun_m, view.surface());
  const EarthShadow shadow_of_air(view.environment().sun_m, view.surface(), EarthShadow::Edge::air,
                                  sensor_.camera.band);
  const Throughput throughput(view);
  const double electrons = object_photons_per_s_m2(0.0, sensor_.camera.band) *
                           throughput.electrons_per_photon_m2() * times.seconds();
  struct End {
    SimTime time;
    Vec<Gcrs> here_m;
    Rotation<CameraFrame, Gcrs> camera;
  };
  const auto end_at = [&](SimTime t) {
    return End{t, view.observer(t).position_m, view.camera_from_gcrs(t)};
  };
  const End start = end_at(times.start), end = end_at(times.end);
  const double diagonal_px = std::hypot(double(optics.columns), double(optics.rows));
  double faintest_e = unbounded, narrowest_px = unbounded;
  const DefocusFacts defocus(sensor_, times.middle);
  f.near_shadow = f.near_shadow_of_air = times.seconds() > short_exposure_s;
  for (const std::size_t object : objects) {
    const Motion motion = view.states().motion(object, times.middle);
    const Vec<Gcrs> line_m = motion.position_m - middle.observer.position_m;
    const double range_m = norm(line_m);
    if (range_m > 0.0)
      f.light_time_rad =
          std::max(f.light_time_rad, 1.01 * norm(cross(motion.slope_m_per_s, line_m)) / range_m /
                                         speed_of_light_m_per_s);
    const Vec<Gcrs> passing_m_per_s = motion.slope_m_per_s - middle.observer.velocity_m_per_s;
    f.object_rate_rad_per_s =
        std::max(f.object_rate_rad_per_s,
                 f.star_rate_rad_per_s + 1.25 * norm(cross(passing_m_per_s, line_m)) /
                                             std::max(range_m * range_m, 1.0));
    const auto sees = [&](const Vec<Gcrs>& position_m) {
      f.near_shadow = f.near_shadow || shadow.sunlit_fraction(position_m) < 1.0;
      if (f.near_shadow_of_air) return;
      const double light = shadow_of_air.sunlit_fraction(position_m);
      f.near_shadow_of_air = light < 1.0 && (light > 0.0 || shadow.sunlit_fraction(position_m) > 0);
    };
    sees(motion.position_m);
    const auto pixel = [&](const End& at) {
      const Vec<Gcrs> position_m = view.states().motion(object, at.time).position_m;
      sees(position_m);
      return project(optics, at.camera * unit(position_m - at.here_m));
    };
    const auto from = pixel(start), to = pixel(end);
    const double trail_px =
        from && to ? std::min(diagonal_px, std::hypot(from->x_px - to->x_px, from->y_px - to->y_px))
                   : diagonal_px;
    f.longest_trail_px = std::max(f.longest_trail_px, trail_px);
    const ObjectShape* shape = sampler.shape(object);
    if (shape) {
      ++f.shapes;
      f.shape_radius_px.push_back(shape->radius_m / std::max(range_m, 1e-3) /
                                  optics.pixel_angle_rad());
      const double pixel_m = std::max(range_m, 1.0) * f.pixel_rad;
      f.hidden_sky_px = std::max(f.hidden_sky_px, shape->silhouette_m2 / (pixel_m * pixel_m));
    }
    const double widening = defocus.add(range_m, trail_px, f);
    narrowest_px = std::min(
        narrowest_px, shape ? 2.0 * shape->radius_m / std::max(range_m, 1.0) / f.pixel_rad : 0.0);
    const double light_e =
        electrons * light_of_magnitude(sampler.magnitude(object, motion, middle));
    f.brightest_object_e =
        std::max(f.brightest_object_e, brighter * most_by_scintillation(f) * light_e);
    faintest_e = std::min(faintest_e, fainter * light_e / widening);
  }
  f.narrowest_object_px = narrowest_px;
  const double air = light_of_magnitude(f.zenith_extinction_mag * f.max_airmass);
  f.faint_objects = f.near_shadow || f.shapes > 0 || f.scene.clouds ||
                    faintest_e * air < PlanFacts::min_snr_of_source * f.min_noise_e() /
                                           f.pattern_share(f.longest_trail_px);
}

PlanFacts ExposurePlanner::dark_facts() const {
  PlanFacts f = of_sensor_;
  f.scene.shutter_closed = true;
  const double quantum_e = sensor_.camera.detector.gain_e_per_dn;
  const double noise_e2 = f.dark_e + f.read_noise_e * f.read_noise_e + quantum_e * quantum_e / 12.0;
  f.sky.push_back({.noise_e = std::sqrt(std::max(noise_e2, 1e-6))});
  return f;
}

PlanFacts ExposurePlanner::facts(const View& view, const std::vector<std::size_t>& objects) const {
  if (view.shutter_closed()) return dark_facts();
  PlanFacts f = of_sensor_;
  add_sky_facts(view, stars_.drawn(), f);
  stars_.add(view, f);
  add_planet_facts(view, f);
  add_error_facts(view, f);
  look_at_objects(view, objects, f);
  return f;
}

EffectPlan ExposurePlanner::plan(const View& view, const std::vector<std::size_t>& objects) const {
  const PlanFacts known = facts(view, objects);
  const auto& effects = view.shutter_closed() ? effects_in_the_dark_ : effects_;
  if (!sensor_.recorded_plans.empty())
    return replayed_plan(effects, known, sensor_.effects,
                         recorded_effects(effects, sensor_, view.times().frame));
  EffectPlan plan{.effects = sensor_.effects};
  if (sensor_.accuracy.is_planned())
    plan = plan_effects(effects, known, sensor_.effects, sensor_.accuracy);
  set_frame_limit(known, plan.effects);
  return plan;
}

void ExposurePlanner::set_frame_limit(const PlanFacts& known, EffectSet& effects) const {
  const EffectFacts& stars = SyntheticBackground::facts;
  if (stars_.to_frame_limit() && effects.level(stars) == stars.reference())
    effects.set_level(stars, SyntheticBackground::whole_level(known));
}

EffectSet ExposurePlanner::asked_effects(const View& view) const {
  EffectSet effects = sensor_.effects;
  if (stars_.to_frame_limit()) set_frame_limit(facts(view, {}), effects);
  return effects;
}

}  // namespace dmise
