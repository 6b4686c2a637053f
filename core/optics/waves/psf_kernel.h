#pragma once
#include <functional>
#include <vector>

#include "core/optics/waves/fft.h"
#include "core/optics/waves/otf.h"

namespace dmise {

/// A point spread function on a grid of cells, centred on the central cell: the fraction of the
/// light that each cell receives. Sums to 1.
struct PsfKernel {
  int half = 0;               // cells on each side of the central one
  std::vector<float> values;  // side x side, row-major

  int side() const { return 2 * half + 1; }
  float at(int dx, int dy) const { return values[std::size_t((dy + half) * side() + dx + half)]; }
};

/// Real transfer function by frequencies along x and y [cycles/rad].
using TransferFunction = std::function<double(double nu_x, double nu_y)>;

/// How a transfer function is symmetric.
enum class OtfSymmetry {
  axes,   // even along each axis
  point,  // f(-x, -y) = f(x, y) alone
};

/// Kernel of a transfer function at the centres of cells of angular size `cell_rad`, truncated
/// `half` cells from the centre; truncated light (returned in `lost`) is redistributed by scaling.
/// Values may be negative. `cutoff` is the frequency above which the function is zero [cycles/rad];
/// cells may be larger or smaller than its resolution.
PsfKernel signed_kernel_of(const TransferFunction& otf, OtfSymmetry symmetry, double cutoff_per_rad,
                           double cell_rad, int half, double* lost = nullptr);

/// The kernel in the first real numbers of `field`, side x side complex ones, `fine` a cell along
/// each axis, with its centre at (0, 0), wrapped around. Truncated and scaled as above.
PsfKernel kernel_in(const FftBuffer& field, int side, int fine, int half, double* lost = nullptr);

}  // namespace dmise
