#pragma once
#include <memory>
#include <vector>

#include "core/base/image.h"
#include "core/optics/blur/deposit.h"
#include "core/optics/point_spread.h"
#include "core/optics/waves/psf_kernel.h"

namespace dmise {

/// The image plane on cells smaller than pixels, with a margin as wide as the kernel, so that light
/// beside the frame contributes and nothing wraps around. Blurred with one pair of transforms per
/// frame, or with one forward transform per kernel if kernels vary over the field, of the whole
/// grid or, in tiles, of the part that the kernel has. All memory is allocated in the constructor.
///
/// Accurate to 1e-6 of the frame's brightest cell (single precision). Dark pixels that rounding
/// makes negative are set to 0, and the rest is rescaled to keep the sum.
class BlurGrid {
 public:
  /// `field_columns` x `field_rows` kernels with linear interpolation; 1 x 1: one for the whole
  /// frame.
  BlurGrid(int columns, int rows, int oversampling, int half_cells, int field_columns = 1,
           int field_rows = 1, bool in_tiles = false);

  /// Kernels in row-major order; each must have the grid's `half_cells`.
  void set_kernels(const std::vector<PsfKernel>& kernels, Threads& threads);

  /// Sets all cells to 0.
  void clear(Threads& threads);

  /// View of the cells for depositing light; `Deposited` reports the part inside the frame.
  DepositView cells();
  /// Converts a pixel coordinate to cells, and back.
  PixelPosition cell_of(PixelPosition pixel) const;
  PixelPosition pixel_of(PixelPosition cell) const;
  /// Converts an arc from pixels to cells.
  Arc on_cells(const Arc& arc) const;
  int oversampling() const { return oversampling_; }
  int half_cells() const { return half_; }

  /// Blurs the cells and adds the result, resampled, to the frame. Overwrites the cells.
  void blur_into(ExpectedElectronImage& light, PointSpread::Resampling resampling,
                 Threads& threads);

 private:
  void find_lit_rows(Threads& threads);
  void weigh(int node, Threads& threads);
  struct Range {
    int begin, end;
  };
  Range tile_along(int node, int count, int length, int cells) const;
  void blur_tile(int node, Threads& threads);
  FftBuffer& blur(Threads& threads);
  void resample(FftBuffer& cells, PointSpread::Resampling resampling, Threads& threads);
  void add_positive(const FftBuffer& cells, ExpectedElectronImage& light, Threads& threads) const;

  int columns_, rows_, oversampling_, half_, field_columns_, field_rows_;
  RealFft2 fft_;
  std::unique_ptr<RealFft2> tile_;  // null: kernels are of the whole grid
  FftBuffer cells_, part_, sum_;
  std::vector<RealFft2::Spectrum> spectra_;
  std::vector<char> lit_;
  struct Light {
    double bright = 0.0, dark = 0.0;
  };
  std::vector<Light> of_row_;
  bool empty_ = true;
};

}  // namespace dmise
