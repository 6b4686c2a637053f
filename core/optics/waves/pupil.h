#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "core/optics/waves/phase_screen.h"
#include "core/optics/waves/psf_kernel.h"

namespace dmise {

/// A Zernike term of the optics' wavefront, Noll's index (1 piston, 2 and 3 tilt, 4 defocus, 5 and
/// 6 astigmatism, 7 and 8 coma, ...). Source: Noll 1976, J. Opt. Soc. Am. 66, 207.
struct ZernikeTerm {
  int noll = 4;  // 1..66
  double rms_rad = 0.0;
};

/// Noll's polynomial, rms 1 over the unit disc, at radius `rho` 0..1 and angle `theta_rad`. Throws
/// `Error` for an index outside 1..66.
double zernike(int noll, double rho, double theta_rad);

/// Noll's index as radial order and azimuthal frequency; negative: the sine term.
std::array<int, 2> noll_orders(int noll);

/// The pupil of a telescope.
struct Pupil {
  double aperture_m = 0.1;
  double obscuration = 0.0;  // ratio of diameters, [0, 1)
  int spiders = 0;           // vanes from the centre outwards, at equal angles, the first along x
  double spider_width_m = 0.0;
  std::vector<ZernikeTerm> wavefront;
};

/// Sampling of a pupil for kernels of given cells: the step in the pupil plane follows from
/// wavelength and cells.
struct PupilGrid {
  int side = 0;           // samples of the pupil plane, and of the image it transforms to
  double step_m = 0.0;    // between samples
  double cell_rad = 0.0;  // a cell of the kernel
  int fine = 1;           // image samples per cell and axis, odd
};

/// Finest useful grid for cells of `cell_rad`, kernels of `half` cells and turbulence of `r0_m`
/// (may be infinite): at least three samples per r0 and `samples` across the aperture.
PupilGrid pupil_grid(const Pupil& pupil, double wavelength_m, double cell_rad, int half,
                     double r0_m, int samples = 32);

/// A screen in front of the aperture, with its sample (0, 0) at the aperture's first corner; phase
/// is linear between samples.
struct ScreenAhead {
  const PhaseScreen* screen = nullptr;  // null: no turbulence
  double step_m = 0.0;                  // between samples
  double scale = 1.0;                   // for its phase: wavelength of the screen / of the light
};

/// A real and even transfer function at the frequencies of a grid.
class SampledOtf {
 public:
  SampledOtf(const PupilGrid& grid, const TransferFunction& otf);
  /// At row `y` and column `x` of the transform.
  double at(int x, int y) const {
    return values_[place(std::min(x, side_ - x), std::min(y, side_ - y))];
  }

 private:
  std::size_t place(int x, int y) const {
    return std::size_t(y) * std::size_t(side_ / 2 + 1) + std::size_t(x);
  }
  int side_;
  std::vector<double> values_;  // only frequencies that are not negative
};

/// Kernel of the pupil through a screen, with its transfer function multiplied by `extra` (further
/// blur, real and even). Sums to 1; negative values are kept.
PsfKernel pupil_kernel(const Pupil& pupil, const PupilGrid& grid, int half,
                       const ScreenAhead& ahead, const SampledOtf& extra);

/// Tilt [rad rms of Noll's terms 2 and 3] that centres the light despite the pupil's own terms:
/// minus the mean slope of the wavefront over the open annulus.
std::array<ZernikeTerm, 2> centring_tilt(const Pupil& pupil);

/// Number of samples across the aperture, which a screen must cover.
int aperture_samples(const Pupil& pupil, const PupilGrid& grid);

}  // namespace dmise
