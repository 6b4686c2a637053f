#include "core/optics/resample.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.h"

namespace dmise {
namespace {

/// Contributions to a new pixel along one axis: `weights` of old pixels from `first` on.
struct Taken {
  int first = 0;
  std::vector<double> weights;
};

std::vector<Taken> by_area(int from, int to) {
  std::vector<Taken> all(static_cast<std::size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double left = double(i) * from / to, right = double(i + 1) * from / to;
    Taken& t = all[std::size_t(i)];
    t.first = std::min(int(left), from - 1);
    for (int j = t.first; j < from && j < right; ++j)
      t.weights.push_back(std::max(0.0, std::min(right, j + 1.0) - std::max(left, double(j))));
  }
  return all;
}

std::vector<Taken> between_centres(int from, int to) {
  std::vector<Taken> all(static_cast<std::size_t>(to));
  const double ratio = double(from) / to;
  for (int i = 0; i < to; ++i) {
    const double at = std::clamp((i + 0.5) * ratio - 0.5, 0.0, from - 1.0);
    Taken& t = all[std::size_t(i)];
    t.first = std::min(int(at), std::max(0, from - 2));
    const double f = at - t.first;
    t.weights = {ratio * (1 - f)};
    if (from > 1) t.weights.push_back(ratio * f);
  }
  return all;
}

ExpectedElectronImage resample(const ExpectedElectronImage& image, const std::vector<Taken>& across,
                               const std::vector<Taken>& down) {
  ExpectedElectronImage out(int(across.size()), int(down.size()));
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.columns; ++x) {
      const Taken &h = across[std::size_t(x)], &v = down[std::size_t(y)];
      double sum = 0.0;
      for (std::size_t j = 0; j < v.weights.size(); ++j)
        for (std::size_t i = 0; i < h.weights.size(); ++i)
          sum += v.weights[j] * h.weights[i] * image.at(h.first + int(i), v.first + int(j));
      out.at(x, y) = float(sum);
    }
  return out;
}

void check(const ExpectedElectronImage& image, int columns, int rows) {
  if (image.pixels.empty() || columns < 1 || rows < 1) throw Error("resample: an empty image");
}

}  // namespace

ResamplingCells resampling_cells(int k, PointSpread::Resampling resampling) {
  if (resampling == PointSpread::Resampling::area) return {0, k, 1.0f};
  const int count = k % 2 ? 1 : 2;
  return {(k - 1) / 2, count, float(k * k) / float(count * count)};
}

ExpectedElectronImage resample_area(const ExpectedElectronImage& image, int columns, int rows) {
  check(image, columns, rows);
  return resample(image, by_area(image.columns, columns), by_area(image.rows, rows));
}

ExpectedElectronImage resample_bilinear(const ExpectedElectronImage& image, int columns, int rows) {
  check(image, columns, rows);
  return resample(image, between_centres(image.columns, columns),
                  between_centres(image.rows, rows));
}

}  // namespace dmise
