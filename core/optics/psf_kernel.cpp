#include "core/optics/psf_kernel.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace dmise {
namespace {

PsfKernel make(const TransferFunction& otf, double cutoff_per_rad, double cell_rad, int half,
               bool point_spread, bool even_along_axes, double* lost) {
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
  std::vector<double> cell(std::size_t(n) / 2 + 1);
  for (int i = 0; i <= n / 2; ++i)
    cell[std::size_t(i)] = point_spread ? pixel_otf(frequency(i), cell_rad) : 1.0;
  for (int y = 0; y <= n / 2; ++y)
    for (int x = 0; x <= n / 2; ++x) {
      const auto value_at = [&](double nu_x) {
        return float(otf(nu_x, frequency(y)) * cell[std::size_t(x)] * cell[std::size_t(y)] /
                     (double(period_cells) * period_cells));
      };
      const float value = value_at(frequency(x)),
                  mirrored = even_along_axes ? value : value_at(-frequency(x));
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

  PsfKernel kernel{half, std::vector<float>(std::size_t(2 * half + 1) * std::size_t(2 * half + 1))};
  double sum = 0.0;
  for (int dy = -half; dy <= half; ++dy)
    for (int dx = -half; dx <= half; ++dx) {
      const auto v = std::size_t((dy * fine + n) % n), u = std::size_t((dx * fine + n) % n);
      const float value = data.data()[2 * (v * std::size_t(n) + u)];
      const float share = point_spread ? std::max(0.0f, value) : value;
      kernel.values[std::size_t((dy + half) * kernel.side() + dx + half)] = share;
      sum += share;
    }
  if (lost) *lost = 1.0 - sum;
  for (float& share : kernel.values) share = float(share / sum);
  return kernel;
}

}  // namespace

PsfKernel kernel_of(const TransferFunction& otf, double cutoff_per_rad, double cell_rad, int half,
                    double* lost) {
  return make(otf, cutoff_per_rad, cell_rad, half, true, true, lost);
}

PsfKernel signed_kernel_of(const TransferFunction& otf, double cutoff_per_rad, double cell_rad,
                           int half, double* lost) {
  return make(otf, cutoff_per_rad, cell_rad, half, false, true, lost);
}

PsfKernel point_symmetric_signed_kernel_of(const TransferFunction& otf, double cutoff_per_rad,
                                           double cell_rad, int half, double* lost) {
  return make(otf, cutoff_per_rad, cell_rad, half, false, false, lost);
}

PsfKernel optical_kernel(const Blur& blur, double cell_rad, int half, double* lost) {
  // Frequency at which diffraction, turbulence or jitter alone is below 1e-9.
  double cutoff = std::min(blur.aperture_m, 2.9 * blur.r0_m) / blur.wavelength_m;
  if (blur.jitter_rad > 0.0) cutoff = std::min(cutoff, 1.03 / blur.jitter_rad);
  return kernel_of(
      [&](double nu_x, double nu_y) { return optical_otf(blur, std::hypot(nu_x, nu_y)); }, cutoff,
      cell_rad, half, lost);
}

double encircled_energy(const PsfKernel& kernel, double radius) {
  constexpr int points = 16;
  double sum = 0.0;
  for (int dy = -kernel.half; dy <= kernel.half; ++dy)
    for (int dx = -kernel.half; dx <= kernel.half; ++dx) {
      const double nearest = std::hypot(dx, dy) - 0.75, farthest = std::hypot(dx, dy) + 0.75;
      if (nearest > radius) continue;
      int inside = points * points;
      if (farthest > radius) {
        inside = 0;
        for (int j = 0; j < points; ++j)
          for (int i = 0; i < points; ++i)
            inside +=
                std::hypot(dx + (i + 0.5) / points - 0.5, dy + (j + 0.5) / points - 0.5) <= radius;
      }
      sum += kernel.at(dx, dy) * double(inside) / (points * points);
    }
  return sum;
}

}  // namespace dmise
