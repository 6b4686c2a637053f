#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/optics/blur/deposit.h"
#include "core/optics/point_spread.h"
#include "core/optics/waves/psf_kernel.h"

namespace dmise {

/// The convolution of `BlurGrid` summed per source: the same cells, kernel and pixels, but each
/// pixel is accurate to 1e-6 of itself, so that bright sources do not disturb faint neighbours, and
/// only the area covered by sources is computed. Costs (12 k + trail) (12 k) (2 half / k)^2
/// multiplications per source for k cells per pixel.
class DirectBlur {
 public:
  /// Light in a border of the image, `border_px` wide, is not in the frame.
  DirectBlur(int oversampling, int half_cells, PointSpread::Resampling resampling,
             int border_px = 0);

  void set_kernel(const PsfKernel& kernel);

  /// Adds arcs (in pixels) to the image and returns what is inside the frame for each, before
  /// blurring. The bytes do not depend on the number of threads.
  std::vector<Deposited> deposit(std::span<const Arc> arcs, ExpectedElectronImage& light,
                                 Threads& threads);

 private:
  template <class Use>
  void for_pieces(const Arc& arc, const ArcExtent& reach, const Use& use) const;
  void add(const Arc& piece, int row_begin, int row_end, ExpectedElectronImage& light) const;
  Arc on_cells(const Arc& arc) const;

  int k_, half_, reach_px_, side_;  // `side_`: pixels of the summed kernel
  int border_px_;
  PointSpread::Resampling resampling_;
  PsfTable table_;
  std::vector<float> shares_;  // for each of the k x k cells of a pixel: side x side
};

}  // namespace dmise
