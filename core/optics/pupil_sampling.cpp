#include "core/optics/pupil_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

using Model = PointSpread::Model;

/// Samples across the aperture of a pupil without turbulence: the kernel is accurate to 1e-3 of its
/// peak.
constexpr int still_samples = 128, turbulent_samples = 48;

bool needs_pupil(const PointSpread& s, const PsfPlan& plan) {
  const bool aberrated = s.spiders != 0 || !s.wavefront.empty() || s.defocus_m != 0.0 ||
                         !s.varying.wavefront.empty() || s.drift.any();
  return has_screens(plan) || (s.model == Model::diffraction && (aberrated || s.field.any()));
}

/// The steepest slope over the field. Terms grow outwards, so centre and corners suffice.
double steepest_in_field(const Optics& optics, double wavelength_m) {
  if (optics.spread.drift.any()) {
    double steepest = 0.0;
    for (const double sign : {-1.0, 1.0}) {
      Optics drifted = optics;
      drifted.spread.defocus_m += sign * optics.spread.drift.max_m();
      drifted.spread.drift = {};
      steepest = std::max(steepest, steepest_in_field(drifted, wavelength_m));
    }
    return steepest;
  }
  double steepest = steepest_slope(pupil_at(optics, {}, wavelength_m));
  if (!optics.spread.varying.wavefront.empty())
    for (const double height : table_heights(optics)) {
      const Pupil pupil = pupil_at(optics, {height, 0.0}, wavelength_m);
      steepest = std::max({steepest, steepest_slope(pupil), steepest_slope_of(pupil.wavefront)});
    }
  if (!optics.spread.field.any()) return steepest;
  constexpr int directions = 8;
  for (int i = 0; i < directions; ++i)
    steepest = std::max(
        steepest, steepest_slope(pupil_at(optics, {1.0, 2 * pi * i / directions}, wavelength_m)));
  return steepest;
}

/// The key of the largest contribution to the slope.
std::string steepest_key(const Optics& optics, double wavelength_m) {
  Optics plain = optics;
  plain.spread.field = {};
  plain.spread.wavefront = {};
  plain.spread.varying = {};
  plain.spread.drift = {};
  plain.spread.defocus_m = 0.0;
  Optics wavefront = plain, field = plain, defocus = plain, drift = plain, varying = plain;
  wavefront.spread.wavefront = optics.spread.wavefront;
  field.spread.field = optics.spread.field;
  defocus.spread.defocus_m = optics.spread.defocus_m;
  drift.spread.drift = optics.spread.drift;
  varying.spread.varying = optics.spread.varying;
  const char* defocus_key =
      std::isfinite(optics.spread.focus_distance_m) ? "focus_distance_m" : "defocus_m";
  const std::pair<const char*, const Optics*> parts[] = {{"zernike_nm", &wavefront},
                                                         {"field_nm", &field},
                                                         {defocus_key, &defocus},
                                                         {"focus_drift", &drift},
                                                         {"psf_field", &varying}};
  std::string largest;
  double steepest = -1.0;
  for (const auto& [key, part] : parts)
    if (const double slope = steepest_in_field(*part, wavelength_m); slope > steepest) {
      steepest = slope;
      largest = key;
    }
  return "optics." + largest;
}

}  // namespace

bool has_screens(const PsfPlan& plan) {
  return plan.exposure == ExposureKind::brief || plan.exposure == ExposureKind::between;
}

Pupil pupil_at(const Optics& optics, const FieldPlace& place, double wavelength_m) {
  const PointSpread& s = optics.spread;
  const double rad_per_m = 2 * pi / wavelength_m;
  Pupil p{.aperture_m = optics.aperture_m,
          .obscuration = optics.obscuration,
          .spiders = s.spiders,
          .spider_width_m = s.spider_width_m};
  const auto add = [&](int noll, double rms_m) {
    if (rms_m != 0.0) p.wavefront.push_back({noll, rms_m * rad_per_m});
  };
  for (const WavefrontTerm& t : s.wavefront) add(t.noll, t.rms_m);
  // A defocused detector sees rho^2 delta / (8 N^2) of path; Noll's term 4 is sqrt(3) (2 rho^2 -
  // 1).
  const double n = optics.f_number();
  add(4, s.defocus_m / (16 * std::sqrt(3.0) * n * n));
  const double r = place.radius, a = place.angle_rad;
  add(8, s.field.coma_m * r * std::cos(a));
  add(7, s.field.coma_m * r * std::sin(a));
  add(6, s.field.astigmatism_m * r * r * std::cos(2 * a));
  add(5, s.field.astigmatism_m * r * r * std::sin(2 * a));
  add(4, s.field.curvature_m * r * r);
  for (const WavefrontTerm& t : terms_of_field(optics, place)) add(t.noll, t.rms_m);
  return p;
}

double steepest_slope(const Pupil& pupil) {
  if (pupil.wavefront.empty()) return 0.0;
  std::vector<ZernikeTerm> terms = pupil.wavefront;
  const auto tilt = centring_tilt(pupil);
  terms.insert(terms.end(), tilt.begin(), tilt.end());
  return steepest_slope_of(terms);
}

double steepest_slope_of(const std::vector<ZernikeTerm>& terms) {
  if (terms.empty()) return 0.0;
  constexpr int radii = 16, angles = 64;  // Noll's term 66 has ten periods around the edge
  constexpr double h = 1e-4;
  double steepest = 0.0;
  for (int i = 1; i <= radii; ++i)
    for (int j = 0; j < angles; ++j) {
      const double rho = double(i) / radii, theta = 2 * pi * j / angles;
      double outwards = 0.0, around = 0.0;
      for (const ZernikeTerm& t : terms) {
        const double here = zernike(t.noll, rho, theta);
        outwards += t.rms_rad * (here - zernike(t.noll, rho - h, theta)) / h;
        around += t.rms_rad * (zernike(t.noll, rho, theta + h) - here) / (h * rho);
      }
      steepest = std::max(steepest, std::hypot(outwards, around));
    }
  return steepest;
}

namespace {

PupilGrid sample_pupil(const Optics& optics, double wavelength_m, const PsfPlan& plan,
                       const std::optional<SensorSeeing>& seeing) {
  const bool screens = has_screens(plan);
  constexpr double margin = 1.05;  // for positions between the sampled ones
  const double slope = steepest_in_field(optics, wavelength_m);
  const double steep = std::ceil(margin * 2 * slope / pi);
  if (steep > max_pupil_samples)
    throw ConfigError(steepest_key(optics, wavelength_m) + ": a wavefront of " +
                      std::to_string(std::lround(slope / (2 * pi))) +
                      " waves over the aperture's radius is too steep to sample: needs " +
                      std::to_string(std::llround(steep)) + " samples across, more than " +
                      std::to_string(max_pupil_samples));
  const double r0_m =
      screens ? seeing->r0_at_m(wavelength_m) : std::numeric_limits<double>::infinity();
  const int samples = std::max(screens ? turbulent_samples : still_samples, int(steep));
  try {
    return pupil_grid(pupil_at(optics, {}, wavelength_m), wavelength_m,
                      optics.pixel_angle_rad() / plan.oversampling, plan.half_cells, r0_m, samples);
  } catch (const Error& e) {
    throw ConfigError((screens ? std::string("seeing.r0_m") : std::string("optics.oversampling")) +
                      ": " + e.what());
  }
}

}  // namespace

PupilGrid sample_screens(const Optics& optics, const PsfPlan& plan,
                         const std::optional<SensorSeeing>& seeing) {
  const PupilGrid grid = sample_pupil(optics, plan.wavelength_m, plan, seeing);
  const int across = aperture_samples(pupil_at(optics, {}, plan.wavelength_m), grid);
  if (across > max_pupil_samples)
    throw ConfigError("seeing.r0_m: turbulence too strong for the aperture: needs a screen of " +
                      std::to_string(across) + " samples across, more than " +
                      std::to_string(max_pupil_samples));
  return grid;
}

std::vector<PupilGrid> sample_pupils(const Optics& optics, const std::vector<WavelengthShare>& band,
                                     const PsfPlan& plan,
                                     const std::optional<SensorSeeing>& seeing) {
  std::vector<PupilGrid> grids;
  if (!needs_pupil(optics.spread, plan)) return grids;
  for (const WavelengthShare& w : band)
    grids.push_back(sample_pupil(optics, w.wavelength_m, plan, seeing));
  if (has_screens(plan))
    sample_screens(optics, plan, seeing);  // refuses screens that are too large
  return grids;
}

}  // namespace dmise
