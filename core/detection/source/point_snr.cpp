#include "core/detection/source/point_snr.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/detection/pixels/components.h"

namespace dmise {
namespace {

/// Half of a Gaussian that sums to 1 as a whole.
std::vector<float> half_of_gaussian(double sigma_px) {
  std::vector<float> half;
  double sum = 0.0;
  for (int i = 0; i <= int(std::ceil(3 * sigma_px)); ++i) {
    half.push_back(float(std::exp(-0.5 * i * i / (sigma_px * sigma_px))));
    sum += (i ? 2.0 : 1.0) * double(half.back());
  }
  for (float& v : half) v /= float(sum);
  return half;
}

/// Convolves a row with half a kernel; there is no light beyond.
void convolve_row(const float* from, float* to, int count, const std::vector<float>& half) {
  for (int i = 0; i < count; ++i) to[i] = half[0] * from[i];
  for (int k = 1; k < std::min(count, int(half.size())); ++k) {
    const float weight = half[std::size_t(k)];
    for (int i = k; i < count; ++i) to[i] += weight * from[i - k];
    for (int i = 0; i + k < count; ++i) to[i] += weight * from[i + k];
  }
}

/// One row of the convolution of columns, in whole rows, as they lie in memory.
void convolve_columns(const PointSnrImage& from, float* to, int y, const std::vector<float>& half) {
  const auto add = [&](const float* values, float weight) {
    for (int x = 0; x < from.columns; ++x) to[x] += weight * values[x];
  };
  std::fill_n(to, from.columns, 0.0F);
  add(from.row(y), half[0]);
  for (int k = 1; k < int(half.size()); ++k) {
    if (y >= k) add(from.row(y - k), half[std::size_t(k)]);
    if (y + k < from.rows) add(from.row(y + k), half[std::size_t(k)]);
  }
}

}  // namespace

PointSnrImage point_snr(const Scene& scene) {
  const int columns = scene.counts.columns, rows = scene.counts.rows;
  const auto unit = float(std::sqrt(kernel_square_sum(scene.sigma_px)));
  const auto half = half_of_gaussian(scene.sigma_px);
  PointSnrImage smoothed(columns, rows), out(columns, rows);
  std::vector<float> sky(std::size_t(columns), 0.0F), excess = sky;
  for (int y = 0; y < rows; ++y) {
    scene.background.level_row(y, 0, columns, sky.data());
    for (int x = 0; x < columns; ++x)
      excess[std::size_t(x)] =
          scene.has_value(x, y) ? float(scene.counts.at(x, y)) - sky[std::size_t(x)] : 0.0F;
    convolve_row(excess.data(), smoothed.row(y), columns, half);
  }
  for (int y = 0; y < rows; ++y) {
    float* snr = out.row(y);
    convolve_columns(smoothed, snr, y, half);
    scene.background.sigma_row(y, 0, columns, sky.data());
    for (int x = 0; x < columns; ++x) snr[x] /= unit * sky[std::size_t(x)];
  }
  return out;
}

}  // namespace dmise
