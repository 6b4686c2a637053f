#pragma once
#include <optional>
#include <string>

#include "core/optics/camera.h"
#include "core/optics/seeing.h"

namespace dmise {

/// Turbulence as an exposure sees it.
enum class ExposureKind {
  none,     // no turbulence
  brief,    // up to tau0: one screen
  between,  // the mean of several
  lasting,  // the long exposure's transfer function
};

/// How a sensor's points are blurred, decided once, and why.
struct PsfPlan {
  PointSpread::Method method = PointSpread::Method::deposit;
  ExposureKind exposure = ExposureKind::none;
  int screens = 0;           // of `brief` and `between`
  int oversampling = 1;      // cells a pixel
  int half_cells = 0;        // of the kernel
  double fwhm_px = 0.0;      // of diffraction, seeing, jitter and defocus in quadrature
  double cutoff_per_px = 0;  // frequency above which nothing is left, or less than 1e-4
  double error = 0.0;        // bound or measure of what the method leaves out, share of the peak
  double beyond = 0.0;       // light beyond the kernel's end, which goes back to the rest
  std::string why;           // one line for people
};

/// Chooses by the width of the blur against the pixel:
/// - a Gaussian model, or a diffraction-limited one narrower than a quarter of a pixel without
///   aberrations: analytic deposit;
/// - otherwise the least oversampling that leaves nothing beyond 0.4 cycles a cell; up to
///   `largest_grid_cells` the transform, beyond them direct summation.
/// What the camera itself asks for goes first. Throws `ConfigError` "optics.KEY: reason" for what
/// cannot be combined.
PsfPlan plan_psf(const Optics& optics, double wavelength_m,
                 const std::optional<SensorSeeing>& seeing, double exposure_s);

inline constexpr double largest_grid_cells = 40e6;
inline constexpr int largest_oversampling = 16;
/// Deposits on the grid have a Gaussian of this many cells, which the kernel takes off again.
inline constexpr double grid_sigma_cells = 1.0;

/// "deposit", ...
const char* name(PointSpread::Method method);

}  // namespace dmise
