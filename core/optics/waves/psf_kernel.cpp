#include "core/optics/waves/psf_kernel.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace dmise {

PsfKernel kernel_in(const FftBuffer& field, int side, int fine, int half, double* lost) {
  PsfKernel kernel{half, std::vector<float>(std::size_t(2 * half + 1) * std::size_t(2 * half + 1))};
  double sum = 0.0;
  for (int dy = -half; dy <= half; ++dy)
    for (int dx = -half; dx <= half; ++dx) {
      const auto v = std::size_t((dy * fine + side) % side),
                 u = std::size_t((dx * fine + side) % side);
      const float share = field.data()[2 * (v * std::size_t(side) + u)];
      kernel.values[std::size_t((dy + half) * kernel.side() + dx + half)] = share;
      sum += share;
    }
  if (lost) *lost = 1.0 - sum;
  for (float& share : kernel.values) share = float(share / sum);
  return kernel;
}

PsfKernel signed_kernel_of(const TransferFunction& otf, OtfSymmetry symmetry, double cutoff_per_rad,
                           double cell_rad, int half, double* lost) {
  if (!(cell_rad > 0.0) || half < 0 || half > 2048) throw Error("psf kernel: cell or size");
  // Fine grid: an odd number of samples per cell, so that a sample is at each cell's centre, and
  // enough that the transfer function ends below the Nyquist frequency. The period is twice the
  // kernel's side, so that aliased light comes from far outside.
  int fine = int(std::ceil(2.0 * cutoff_per_rad * cell_rad));
  fine = std::max(1, fine + (fine + 1) % 2);
  const int period_cells = good_fft_size(2 * (2 * half + 1) + 16, true);
  const int n = period_cells * fine;
  if (n > 16384) throw Error("psf kernel: cells too coarse for the optics' resolution");
  FftBuffer data(2 * std::size_t(n) * std::size_t(n));
  const double step = 1.0 / (period_cells * cell_rad);
  const auto frequency = [&](int i) { return step * (i <= n / 2 ? i : i - n); };
  // Symmetric in both axes: a quarter is enough; else half.
  for (int y = 0; y <= n / 2; ++y)
    for (int x = 0; x <= n / 2; ++x) {
      const auto value_at = [&](double nu_x) {
        return float(otf(nu_x, frequency(y)) / (double(period_cells) * period_cells));
      };
      const float value = value_at(frequency(x)),
                  mirrored = symmetry == OtfSymmetry::axes ? value : value_at(-frequency(x));
      if (value == 0.0f && mirrored == 0.0f) continue;
      const int y2 = (n - y) % n, x2 = (n - x) % n;
      const auto put = [&](int v, int u, float share) {
        data.data()[2 * (std::size_t(v) * std::size_t(n) + std::size_t(u))] = share;
      };
      put(y, x2, mirrored);
      put(y2, x, mirrored);
      put(y, x, value);
      put(y2, x2, value);
    }
  ComplexFft2(n).transform(data);
  return kernel_in(data, n, fine, half, lost);
}

}  // namespace dmise
