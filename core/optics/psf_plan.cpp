#include "core/optics/psf_plan.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/effects/plan_facts.h"
#include "core/optics/psf_table.h"

namespace dmise {
namespace {

using Method = PointSpread::Method;
using Model = PointSpread::Model;

// Where exp(-3.44 x^(5/3)) and a Gaussian of unit width fall to 1e-4.
constexpr double long_exposure_end = 1.806;  // lambda nu / r0
constexpr double gaussian_end = 0.683;       // sigma nu
constexpr double narrow_px = 0.25;
// Above this, deposits on the grid alias by more than 1e-4 of the peak.
constexpr double max_cycles_per_cell = 0.40;

// Kernel sizes without and with a defocus disc.
constexpr int usual_half_cells = 512, widest_half_cells = 1024;

bool is_aberrated(const PointSpread& s) {
  return !s.wavefront.empty() || s.field.any() || s.defocus_m != 0.0 || s.varying.any() ||
         s.drift.any();
}

// Widths and frequencies of the blur, in pixels.
struct Measures {
  double airy_px, seeing_px, jitter_px, defocus_px, cutoff_per_px;
  double widest_px;  // diameter of defocus and of the tables' spots in the run, over the field
};

Measures measure(const Optics& o, double wavelength_m, const SensorSeeing* seeing, bool lasting) {
  const PointSpread& s = o.spread;
  const double pixel_rad = o.pixel_angle_rad();
  Measures m{};
  const double px_per_m = 1.0 / o.f_number() / o.pixel_pitch_m;
  m.widest_px = (std::abs(s.defocus_m) + s.drift.max_m()) * px_per_m;
  if (s.model == Model::gaussian) {
    m.defocus_px = std::abs(s.defocus_m) * px_per_m;
    m.airy_px = fwhm_per_sigma * psf_sigma_px(o, wavelength_m);
    m.cutoff_per_px = gaussian_end / psf_sigma_px(o, wavelength_m);
    if (s.varying.any()) {
      const GaussianShape axis = gaussian_at(o, {}, wavelength_m);
      const WidthRange range = gaussian_widths(o, wavelength_m);
      m.airy_px = fwhm_per_sigma * std::sqrt(0.5 * (axis.xx + axis.yy));
      m.cutoff_per_px = gaussian_end / range.min_px;
      m.widest_px += 5.0 * fwhm_per_sigma * range.max_px;
    }
    return m;
  }
  if (s.model == Model::file) {
    m.defocus_px = std::abs(s.defocus_m) * px_per_m;
    m.jitter_px = fwhm_per_sigma * s.jitter_rad / pixel_rad;
    m.airy_px = s.measured->fwhm_px();
    m.cutoff_per_px = s.measured->cutoff_per_px();
    return m;
  }
  if (s.varying.any()) m.widest_px += 2.0 * field_spot_px(o);
  m.airy_px = 1.029 * wavelength_m / o.aperture_m / pixel_rad;
  m.jitter_px = fwhm_per_sigma * s.jitter_rad / pixel_rad;
  m.defocus_px = std::abs(s.defocus_m) * px_per_m;
  m.cutoff_per_px = o.aperture_m / wavelength_m * pixel_rad;
  if (seeing) {
    const double r0_m = seeing->r0_at_m(wavelength_m);
    m.seeing_px = 0.976 * wavelength_m / r0_m / pixel_rad;
    if (lasting)
      m.cutoff_per_px =
          std::min(m.cutoff_per_px, long_exposure_end * r0_m / wavelength_m * pixel_rad);
  }
  if (s.jitter_rad > 0.0)
    m.cutoff_per_px = std::min(m.cutoff_per_px, gaussian_end / s.jitter_rad * pixel_rad);
  return m;
}

double width_px(const Measures& m) {
  return std::hypot(std::hypot(m.airy_px, m.seeing_px), std::hypot(m.jitter_px, m.defocus_px));
}

/// How much narrower long exposures are than with an infinite outer scale. Source: Tokovinin 2002,
/// PASP 114, 1156, whose formula goes to 0 at 9 r0.
double narrowing_by_outer_scale(const SensorSeeing& air, double wavelength_m) {
  const double r0_over_scale = air.r0_at_m(wavelength_m) / air.outer_scale_m;
  return std::sqrt(std::max(0.0, 1.0 - 2.183 * std::pow(r0_over_scale, 0.356)));
}

/// Screens of a short exposure; 0: there are too many of them, or no air.
int screens_of(const PointSpread& s, double wavelength_m, const SensorSeeing* air,
               double exposure_s) {
  if (!air) return 0;
  const double screens = std::ceil(exposure_s / air->tau0_s(wavelength_m));
  return screens <= s.max_screens ? std::max(1, int(screens)) : 0;
}

[[noreturn]] void refuse(const char* key, const std::string& reason) {
  throw ConfigError(std::string("optics.") + key + ": " + reason);
}

}  // namespace

double PointSpread::cost_s(int level, const PlanFacts& f) {
  const bool transforms = (f.scene.diffracts && !f.air.still_is_deposited) || f.scene.blur_varies ||
                          f.scene.focus_drifts || f.scene.blur_of_file;
  return transforms ? level * PlanFacts::transform_pixel_s * f.pixels() : 0.0;
}

PsfPlan plan_psf(const Optics& o, double wavelength_m, const std::optional<SensorSeeing>& seeing,
                 double exposure_s, AirTurbulence::Level turbulence) {
  const PointSpread& s = o.spread;
  const bool in_air = seeing && std::isfinite(seeing->r0_m) && s.model == Model::diffraction;
  const SensorSeeing* all_air = in_air ? &*seeing : nullptr;
  const SensorSeeing* air = turbulence == AirTurbulence::off ? nullptr : all_air;
  const int short_screens = screens_of(s, wavelength_m, all_air, exposure_s);
  PsfPlan plan{.wavelength_m = wavelength_m};
  if (turbulence == AirTurbulence::short_exposure) plan.screens = short_screens;
  if (air)
    plan.exposure = plan.screens == 0   ? ExposureKind::lasting
                    : plan.screens == 1 ? ExposureKind::brief
                                        : ExposureKind::between;
  const Measures m = measure(o, wavelength_m, air, plan.exposure == ExposureKind::lasting);
  Measures of_width = m;
  if (air) of_width.seeing_px *= narrowing_by_outer_scale(*air, wavelength_m);
  plan.fwhm_px = width_px(of_width);

  const bool plain = s.model == Model::gaussian;
  const bool even = !s.varying.any() && !s.drift.any() && !(plain && s.defocus_m != 0.0);
  const bool of_file = s.model == Model::file;
  const bool narrow = s.model == Model::diffraction && width_px(m) < narrow_px && !is_aberrated(s);
  if (s.method == Method::deposit && !even)
    refuse("method", "deposit is for a blur without psf_field, focus_drift and focus_distance_m");
  if (s.method == Method::deposit && !plain && !narrow)
    refuse("method", "deposit is for psf: gaussian, or a blur below 0.25 px");
  if (even &&
      (s.method == Method::deposit || (s.method == Method::automatic && (plain || narrow)))) {
    plan.method = Method::deposit;
    return plan;
  }

  const int least = std::max(1, int(std::ceil(m.cutoff_per_px / max_cycles_per_cell - 1e-9)));
  plan.oversampling = s.oversampling > 0 ? s.oversampling : least;
  // Pixels that are in the images are those about the centres of cells.
  if (of_file && s.measured->with_pixel() && plan.oversampling % 2 == 0) ++plan.oversampling;
  if (plan.oversampling > largest_oversampling)
    refuse("oversampling", "the blur needs " + std::to_string(plan.oversampling) +
                               " cells a pixel, more than " + std::to_string(largest_oversampling) +
                               "; add jitter or take psf: gaussian");
  if (plan.oversampling < least)
    refuse("oversampling", "must be at least " + std::to_string(least) +
                               " to sample the blur, got " + std::to_string(plan.oversampling));
  const double cells = double(plan.oversampling) * plan.oversampling * o.columns * o.rows;
  plan.method = s.method != Method::automatic ? s.method
                : cells <= largest_grid_cells || s.varying.any() ||
                        (of_file && s.grid_columns * s.grid_rows > 1)
                    ? Method::transform
                    : Method::direct;
  // Wide kernels are cheap for a transform, expensive for sums and screens.
  const bool cheap = plan.method == Method::transform && short_screens == 0;
  const double airy_widths = cheap ? 64.0 : 24.0;
  const double full_width_px = width_px(measure(o, wavelength_m, all_air, false));
  const double widest_px = std::max({8.0, 1.0 * o.columns, 1.0 * o.rows});
  const double support_px =
      s.support_px > 0 ? s.support_px
      : plain          ? 5.0 * plan.fwhm_px
      : of_file ? s.measured->reach_px() + double(MeasuredPsf::margin_cells) / plan.oversampling
                : std::max(std::min(airy_widths * m.airy_px, widest_px), 5.0 * full_width_px);
  // The defocus disc must be within the inner half, which does not taper.
  const double disc_px = even ? m.defocus_px : m.widest_px;
  const double disc_cells = s.support_px > 0 ? 0.0 : 1.05 * disc_px * plan.oversampling;
  if (disc_cells > widest_half_cells) {
    const bool still = !s.varying.any() && !s.drift.any();
    const char* key = !still ? s.drift.any() ? "focus_drift" : "psf_field"
                      : std::isfinite(s.focus_distance_m) ? "focus_distance_m"
                                                          : "defocus_m";
    refuse(key, (still ? "its disc of " : "its blur of ") + std::to_string(std::lround(disc_px)) +
                    " px is wider than a kernel holds, " +
                    std::to_string(int(widest_half_cells / 1.05 / plan.oversampling)) + " px");
  }
  const int half = std::clamp(int(std::ceil(support_px * plan.oversampling)), 8,
                              of_file ? widest_half_cells : usual_half_cells);
  plan.half_cells = std::max(half, int(std::ceil(disc_cells)));
  // Beyond r: 0.2 (lambda / D) / r of an Airy pattern, more with an obscuration; the kernel tapers
  // off around three quarters of its radius.
  if (s.model == Model::diffraction)
    plan.beyond = std::min(1.0, 0.2 * m.airy_px / (1.0 - o.obscuration) /
                                    (0.75 * plan.half_cells / plan.oversampling));
  if (s.grid_columns * s.grid_rows > 1 && plan.method == Method::direct)
    refuse("psf_grid", "kernels over the field go with method: transform");
  if (s.varying.any() && plan.method == Method::direct)
    refuse("psf_field", "goes with method: transform");
  if (s.varying.any() && cells > largest_field_cells)
    refuse("psf_field", "the blur needs " + std::to_string(plan.oversampling) + " cells a pixel, " +
                            std::to_string(std::lround(1e-6 * cells)) +
                            " million in this frame, more than " +
                            std::to_string(std::lround(1e-6 * largest_field_cells)) + " million");
  return plan;
}

PsfPlan plan_defocused(const Optics& optics, double wavelength_m, const PsfPlan& in_focus,
                       double disc_px) {
  PsfPlan plan = in_focus;
  if (in_focus.method == Method::deposit) {
    const double cutoff_per_px = gaussian_end / psf_sigma_px(optics, wavelength_m);
    const int least = int(std::ceil(cutoff_per_px / max_cycles_per_cell - 1e-9));
    plan.oversampling = std::clamp(least, 1, largest_oversampling);
    plan.half_cells = int(std::ceil(5.0 * plan.fwhm_px * plan.oversampling));
    plan.exposure = ExposureKind::none;  // its width is in the Gaussian's
    plan.screens = 0;
  }
  plan.method = Method::transform;
  // What is wide is not sharp: a disc of d px falls off as (d nu)^(-3/2).
  constexpr double fine_disc_px = 64.0;
  constexpr int enough = 4, step = 16;
  const int of_disc = std::max(enough, int(fine_disc_px / std::max(disc_px, 1e-3)));
  const int held = std::max(1, int(widest_half_cells / (1.05 * std::max(disc_px, 1.0))));
  const int cells = std::min({plan.oversampling, of_disc, held});
  const double disc_cells = 1.05 * disc_px * cells;
  plan.half_cells = plan.half_cells * cells / plan.oversampling;
  plan.oversampling = cells;
  plan.half_cells = std::max({8, plan.half_cells, int(std::ceil(disc_cells / step)) * step});
  plan.half_cells = std::min(plan.half_cells, widest_half_cells);
  return plan;
}

Optics blurred_by(const PsfPlan& plan, const Optics& optics) {
  if (plan.method != Method::deposit) return optics;
  // Narrower, it would take more cells than `largest_oversampling`.
  const double fwhm_px = std::max(plan.fwhm_px, narrow_px);
  const double diffraction_px = fwhm_per_sigma * diffraction_sigma_px(optics, plan.wavelength_m);
  Optics blurred = optics;
  blurred.spread = {};
  blurred.psf_fwhm_px =
      std::sqrt(std::max(0.0, fwhm_px * fwhm_px - diffraction_px * diffraction_px));
  return blurred;
}

}  // namespace dmise
