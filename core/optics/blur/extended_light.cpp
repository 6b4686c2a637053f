#include "core/optics/blur/extended_light.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dmise {
namespace {

constexpr double of_pixel = 1.0 / 12.0;  // second moment

/// Weights from -half to half whose second moment is that of a Gaussian; they sum to 1.
std::vector<double> weights(double variance) {
  const double inner = std::max(0.0, variance - of_pixel);
  if (!(inner > 1e-6)) return {1.0};
  const double width = std::sqrt(2.0 * inner);
  const int half = int(std::ceil(5.0 * std::sqrt(inner))) + 1;
  std::vector<double> w;
  double sum = 0.0;
  for (int k = -half; k <= half; ++k) {
    w.push_back(0.5 * (std::erf((k + 0.5) / width) - std::erf((k - 0.5) / width)));
    sum += w.back();
  }
  for (double& weight : w) weight /= sum;
  return w;
}

}  // namespace

int gaussian_reach_px(double sigma_px) { return int(weights(sigma_px * sigma_px).size() / 2); }

void add_by_gaussian(const ExtendedLight& source, double sigma_px, ExpectedElectronImage& image,
                     Threads& threads) {
  const auto w = weights(sigma_px * sigma_px);
  const int half = int(w.size() / 2), columns = image.columns;
  const auto& light = source.light;
  std::vector<float> along(std::size_t(light.rows) * std::size_t(columns));
  threads.for_ranges(std::size_t(light.rows), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const float* in = light.row(int(y));
      float* out = along.data() + y * std::size_t(columns);
      const int first = std::max(0, source.left - half);
      const int last = std::min(columns, source.left + light.columns + half);
      for (int x = first; x < last; ++x) {
        const int at = x - source.left;
        double sum = 0.0;
        for (int k = std::max(-half, -at); k <= std::min(half, light.columns - 1 - at); ++k)
          sum += w[std::size_t(k + half)] * double(in[at + k]);
        out[x] = float(sum);
      }
    }
  });
  threads.for_ranges(std::size_t(image.rows), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<double> sum(static_cast<std::size_t>(columns));
    for (int y = int(begin); y < int(end); ++y) {
      const int at = y - source.top;
      const int first = std::max(-half, -at), last = std::min(half, light.rows - 1 - at);
      if (first > last) continue;
      std::fill(sum.begin(), sum.end(), 0.0);
      for (int k = first; k <= last; ++k) {
        const float* in = along.data() + std::size_t(at + k) * std::size_t(columns);
        for (int x = 0; x < columns; ++x)
          sum[std::size_t(x)] += w[std::size_t(k + half)] * double(in[x]);
      }
      float* out = image.row(y);
      for (int x = 0; x < columns; ++x) out[x] += float(sum[std::size_t(x)]);
    }
  });
}

void lay_on(const ExtendedLight& source, BlurGrid& grid, Threads& threads) {
  const int k = grid.oversampling();
  // Pixels are integrated over once by the source and once more by the grid.
  const auto w = weights(std::max(0.0, 1.0 - double(k * k) * of_pixel));
  const int half = int(w.size() / 2);
  const auto& light = source.light;
  const DepositView cells = grid.cells();
  const int width = light.columns * k + 2 * half, height = light.rows * k;
  std::vector<float> along(std::size_t(light.rows) * std::size_t(width));
  threads.for_ranges(std::size_t(light.rows), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      float* out = along.data() + y * std::size_t(width);
      for (int x = 0; x < light.columns; ++x) {
        const double of_cell = double(light.row(int(y))[x]) / double(k * k);
        if (of_cell == 0.0) continue;
        for (int i = x * k; i < (x + 1) * k; ++i)
          for (std::size_t j = 0; j < w.size(); ++j) out[i + int(j)] += float(w[j] * of_cell);
      }
    }
  });
  const int left = source.left * k + grid.half_cells() - half;
  const int top = source.top * k + grid.half_cells();
  threads.for_ranges(std::size_t(cells.rows), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y) {
      const int at = y - top;
      if (at + half < 0 || at - half >= height) continue;
      float* out = cells.pixels + std::ptrdiff_t(y) * cells.stride;
      for (int j = std::max(-half, -at); j <= std::min(half, height - 1 - at); ++j) {
        const float* in = along.data() + std::size_t((at + j) / k) * std::size_t(width);
        const auto weight = float(w[std::size_t(j + half)]);
        for (int x = std::max(0, -left); x < std::min(width, cells.columns - left); ++x)
          out[x + left] += weight * in[x];
      }
    }
  });
}

}  // namespace dmise
