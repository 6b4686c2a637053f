#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/optics/deposit.h"
#include "core/optics/point_spread.h"
#include "core/optics/psf_kernel.h"

namespace dmise {

/// The image plane on cells finer than pixels, with a margin as wide as the kernel: light beside
/// the frame reaches into it, and nothing wraps around. Blurred by one pair of transforms a frame,
/// or by one forward transform a kernel where kernels differ over the field. All memory is made
/// once.
///
/// What stays is right to 1e-6 of the frame's brightest cell (single precision). Rounding makes
/// some dark pixels negative by that much: they become 0, and the rest is scaled by the light that
/// adds, so that the sum is kept.
class BlurGrid {
 public:
  /// `field_columns` x `field_rows` kernels, linear between; 1 x 1: one for the whole frame.
  BlurGrid(int columns, int rows, int oversampling, int half_cells, int field_columns = 1,
           int field_rows = 1);

  /// Kernels row by row; each of the grid's `half_cells`.
  void set_kernels(const std::vector<PsfKernel>& kernels, Threads& threads);

  /// Empties the cells.
  void clear(Threads& threads);
  bool is_empty() const { return empty_; }

  /// The cells, to put light on; told is what falls inside the frame.
  DepositView cells();
  /// Place of a pixel coordinate on the cells, and back.
  PixelPosition cell_of(PixelPosition pixel) const;
  PixelPosition pixel_of(PixelPosition cell) const;
  /// An arc in pixels as one in cells.
  Arc on_cells(const Arc& arc) const;
  int oversampling() const { return oversampling_; }
  int half_cells() const { return half_; }

  /// Blurs what lies on the cells and adds it, resampled, to the frame. Overwrites the cells.
  void blur_into(ExpectedElectronImage& light, PointSpread::Resampling resampling,
                 Threads& threads);

  /// Floats of one transform along columns and rows.
  int transform_columns() const { return fft_.columns(); }
  int transform_rows() const { return fft_.rows(); }
  std::size_t memory_bytes() const;

 private:
  void find_lit_rows(Threads& threads);
  void weigh(int node, Threads& threads);
  FftBuffer& blur(Threads& threads);
  void resample(FftBuffer& cells, PointSpread::Resampling resampling, Threads& threads);
  void add_positive(const FftBuffer& cells, ExpectedElectronImage& light, Threads& threads) const;

  int columns_, rows_, oversampling_, half_, field_columns_, field_rows_;
  RealFft2 fft_;
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
