#pragma once
#include <algorithm>
#include <cmath>

#include "core/optics/waves/otf.h"
#include "core/optics/waves/psf_kernel.h"

// Kernels of known optics, which tests compare others with.
namespace dmise {

/// Sets values that rounding makes negative to 0; the sum is 1 again.
inline PsfKernel without_negatives(PsfKernel kernel) {
  double sum = 0.0;
  for (float& share : kernel.values) sum += share = std::max(0.0f, share);
  for (float& share : kernel.values) share = float(share / sum);
  return kernel;
}

/// Kernel of a transfer function that is even along each axis, integrated over cells.
inline PsfKernel kernel_of(const TransferFunction& otf, double cutoff_per_rad, double cell_rad,
                           int half, double* lost = nullptr) {
  const auto with_cell = [&](double nu_x, double nu_y) {
    return otf(nu_x, nu_y) * pixel_otf(nu_x, cell_rad) * pixel_otf(nu_y, cell_rad);
  };
  return without_negatives(
      signed_kernel_of(with_cell, OtfSymmetry::axes, cutoff_per_rad, cell_rad, half, lost));
}

/// Kernel of the optics: diffraction, long exposure, jitter, defocus, cell integration.
inline PsfKernel optical_kernel(const Blur& blur, double cell_rad, int half,
                                double* lost = nullptr) {
  // Frequency at which diffraction or turbulence alone is below 1e-9.
  const double cutoff = std::min(blur.aperture_m, 2.9 * blur.r0_m) / blur.wavelength_m;
  return kernel_of(
      [&](double nu_x, double nu_y) { return optical_otf(blur, std::hypot(nu_x, nu_y)); }, cutoff,
      cell_rad, half, lost);
}

}  // namespace dmise
