#pragma once
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/base/numeric/simd_level.h"
#include "core/base/parallel.h"
#include "core/base/pixel.h"
#include "core/optics/psf_table.h"

// Deposits point and moving sources on the pixels analytically: the pixel-integrated Gaussian is
// integrated along the path in the exposure. There is no grid, hence no ringing and no lost light.
namespace dmise {

/// Path of one source during part of the exposure: the parabola in time through three positions,
/// straight and uniform if `middle` is half way, a point if all are equal. Brightness changes
/// linearly with time, from mean (1 - tilt) to mean (1 + tilt).
struct Arc {
  PixelPosition start, middle, end;  // anywhere, also outside the frame
  double signal_e = 0.0;             // light of the whole arc, expected [e-], >= 0
  double tilt = 0.0;                 // [-1, 1]
  double may_miss_e = 0.0;           // in a pixel, >= 0; 0: 2e-6 of its brightest

  bool is_point() const {
    const auto is_middle = [this](PixelPosition p) {
      return p.x_px == middle.x_px && p.y_px == middle.y_px;
    };
    return is_middle(start) && is_middle(end);
  }
};

/// Light of an arc inside the frame: its signal and its centroid over pixel centres. The position
/// is (0, 0) if `signal_e` is 0.
struct Deposited {
  double signal_e = 0.0;
  double x_px = 0.0, y_px = 0.0;
};

/// The sum of both.
Deposited operator+(const Deposited& a, const Deposited& b);

/// Destination of light: `rows` rows of `columns` floats, `stride` apart. `Deposited` counts the
/// part from (left, top), in coordinates of the view.
struct DepositView {
  float* pixels = nullptr;
  int columns = 0, rows = 0;
  std::ptrdiff_t stride = 0;
  int left = 0, top = 0, frame_columns = 0, frame_rows = 0;
};

/// Returns all pixels of an image, which are the frame.
DepositView view_of(ExpectedElectronImage& image);
/// A view of these pixels; `Deposited` does not count a border of the frame, `border` pixels of the
/// view wide.
DepositView without_border(DepositView view, int border);

/// Whose light inside the frame is summed: that of all arcs, or of those that the frame's rim cuts.
/// For the others the sum is then all of their light, and the centroid their middle.
enum class DepositSums { all, cut };

/// Adds arcs to `view` [e-] and returns what is inside the frame for each. Light per pixel is
/// accurate to 2e-6 of the arc's brightest pixel, the sum over pixels to 1e-6, for lengths of 0 to
/// 1e12 px: panels of 2 sigma along the path with five Gauss-Legendre nodes. A short arc that may
/// miss some light is one panel of as few nodes as that allows (`ShortArcRule`). The bytes depend
/// neither on the number of threads nor on the instruction set nor on `sums`. Throws `Error` naming
/// the arc if a value is not finite or the signal is negative.
std::vector<Deposited> deposit(std::span<const Arc> arcs, const PsfTable& psf,
                               const DepositView& view, Threads& threads,
                               SimdLevel level = best_simd_level(),
                               DepositSums sums = DepositSums::all);

/// Returns the part of an arc inside the frame of a view, without writing pixels.
Deposited deposited_in_frame(const Arc& arc, const PsfTable& psf, const DepositView& view);

/// The part of an arc between two times in 0..1.
Arc part_of(const Arc& arc, double tau_begin, double tau_end);

/// A rectangle in the image plane [px].
struct ArcExtent {
  double left, top, right, bottom;

  bool meets(const ArcExtent& b) const {
    return left <= b.right && b.left <= right && top <= b.bottom && b.top <= bottom;
  }
};
/// Bounding rectangle of the arc's path.
ArcExtent extent(const Arc& arc);

/// Length of the way by the arc's middle, straight to and from it.
double length_px(const Arc& arc);

/// Position on the arc at time `tau`, 0 at the start, 1 at the end.
PixelPosition place(const Arc& arc, double tau);

}  // namespace dmise
