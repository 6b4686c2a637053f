#pragma once
#include <functional>
#include <vector>

#include "core/optics/fft.h"
#include "core/optics/otf.h"

namespace dmise {

/// A point spread function on a grid of cells, centred on the central cell: the fraction of the
/// light that each cell receives. Not negative, sums to 1.
struct PsfKernel {
  int half = 0;               // cells on each side of the central one
  std::vector<float> values;  // side x side, row-major

  int side() const { return 2 * half + 1; }
  float at(int dx, int dy) const { return values[std::size_t((dy + half) * side() + dx + half)]; }
};

/// Transfer function by frequencies along x and y [cycles/rad]; real and even along each axis.
using TransferFunction = std::function<double(double nu_x, double nu_y)>;

/// Kernel of a transfer function, integrated over cells of angular size `cell_rad` and truncated
/// `half` cells from the centre; truncated light (returned in `lost`) is redistributed by scaling.
/// `cutoff` is the frequency above which the function is zero [cycles/rad]; cells may be larger or
/// smaller than its resolution. Values that rounding makes negative are set to 0.
PsfKernel kernel_of(const TransferFunction& otf, double cutoff_per_rad, double cell_rad, int half,
                    double* lost = nullptr);

/// The same without integration over cells and with negative values kept, for functions that are
/// not point spreads.
PsfKernel signed_kernel_of(const TransferFunction& otf, double cutoff_per_rad, double cell_rad,
                           int half, double* lost = nullptr);

/// The same of a function that is point-symmetric alone: f(-x, -y) = f(x, y).
PsfKernel point_symmetric_signed_kernel_of(const TransferFunction& otf, double cutoff_per_rad,
                                           double cell_rad, int half, double* lost = nullptr);

/// Kernel of the optics: diffraction, long exposure, jitter, defocus, cell integration.
PsfKernel optical_kernel(const Blur& blur, double cell_rad, int half, double* lost = nullptr);

/// Fraction of the light within `radius` cells of the centre; cells cut by the circle count by the
/// fraction of 16 x 16 points inside.
double encircled_energy(const PsfKernel& kernel, double radius);

}  // namespace dmise
