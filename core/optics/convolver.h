#pragma once
#include "core/base/image.h"
#include "core/optics/psf_kernel.h"

namespace dmise {

/// Convolves images of one size with one kernel, by one pair of transforms. The kernel's spectrum,
/// the plans and the memory are made once and used again.
///
/// Padded by the kernel's support, so nothing wraps around: light that leaves the frame is lost,
/// and what stays is right to 1e-6 of the frame's brightest pixel (single precision: a source 1e4
/// times brighter than what matters is better deposited on its own). Rounding makes some dark
/// pixels negative by that much; they become 0, and the image is scaled by the light that adds, so
/// that its sum is kept.
class Convolver {
 public:
  Convolver(int columns, int rows, const PsfKernel& kernel, Threads& threads);

  /// In place. `image` has the size given at construction. An image without light is left alone.
  void apply(RateImage& image, Threads& threads);

  std::size_t memory_bytes() const;

 private:
  int columns_, rows_;
  RealFft2 fft_;
  FftBuffer padded_;
  std::vector<std::complex<float>> spectrum_;
};

}  // namespace dmise
