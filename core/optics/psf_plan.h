#pragma once
#include <optional>

#include "core/optics/camera.h"
#include "core/optics/waves/air_turbulence.h"
#include "core/optics/waves/seeing.h"

namespace dmise {

/// Regime of turbulence for the exposure time.
enum class ExposureKind {
  none,     // no turbulence
  brief,    // up to tau0: a single screen
  between,  // the mean of several screens
  lasting,  // the long-exposure transfer function
};

/// How a sensor's point spread is computed.
struct PsfPlan {
  double wavelength_m = 0.0;  // for which it was made
  PointSpread::Method method = PointSpread::Method::deposit;
  ExposureKind exposure = ExposureKind::none;
  int screens = 0;       // for `brief` and `between`
  int oversampling = 1;  // cells a pixel
  int half_cells = 0;    // the kernel has as many on each side of its middle
  double fwhm_px = 0.0;  // diffraction, seeing, jitter and defocus in quadrature
  double beyond = 0.0;   // fraction of light beyond the kernel's end, redistributed
  /// Defocus is the disc of geometrical optics, also of a pupil: its wavefront is too steep.
  bool geometric = false;
};

/// Chooses the method by the width of the blur relative to the pixel:
/// - a Gaussian model, or a diffraction-limited one narrower than a quarter of a pixel without
///   aberrations: analytic deposit;
/// - otherwise the least oversampling that leaves no frequency above 0.4 cycles per cell; up to
///   `largest_grid_cells` by transform, beyond by direct summation.
/// With less turbulence than short exposures have, kernels still reach as far as theirs: what is
/// cut off is no error of a level. Settings of the camera take precedence. Throws `ConfigError`
/// "optics.KEY: reason" for settings that cannot be combined.
PsfPlan plan_psf(const Optics& optics, double wavelength_m,
                 const std::optional<SensorSeeing>& seeing, double exposure_s,
                 AirTurbulence::Level turbulence = AirTurbulence::short_exposure);

/// Plan of the kernels of a source that is out of focus by a disc of `disc_px`, from that of the
/// camera's: cells no finer than such a disc needs, and at least a pixel large, so that a kernel
/// holds it. `optics`: as `blurred_by` returns them. A disc is no wider than `widest_disc_px`.
PsfPlan plan_defocused(const Optics& optics, double wavelength_m, const PsfPlan& in_focus,
                       double disc_px);
/// The optics of which kernels of a plan are: where light is deposited, a Gaussian of its width.
Optics blurred_by(const PsfPlan& plan, const Optics& optics);
inline constexpr double widest_disc_px = 975.0;

inline constexpr double largest_grid_cells = 40e6;
/// A blur that changes over the field is transformed in any case, with up to so many cells.
inline constexpr double largest_field_cells = 160e6;
inline constexpr int largest_oversampling = 16;
/// Gaussian width of deposits on the grid in cells; the kernel is divided by it.
inline constexpr double grid_sigma_cells = 1.0;

}  // namespace dmise
