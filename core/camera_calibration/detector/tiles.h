#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/numeric/quantile.h"

namespace dmise {

/// A frame in whole tiles, over which light is nearly even, and in strips of tiles along columns,
/// which a jackknife leaves out one at a time. What is left at the right and below is not used.
struct Tiles {
  int columns = 0, rows = 0;    // the frame's size
  int width = 0, height = 0;    // a tile's size [px]
  int across = 0, down = 0;     // tiles
  int strips = 0;               // groups of tiles side by side
  std::vector<char> straddles;  // by tile across: it holds two kinds of a mosaic's pixels

  static constexpr int max_strips = 64, min_strips = 8;

  /// `columns` and `rows` at least 64. `split_x`, `split_y`: where another kind of pixels begins.
  Tiles(int columns_, int rows_, int split_x = 0, int split_y_ = 0)
      : columns(columns_),
        rows(rows_),
        width(std::clamp(columns_ / max_strips, 8, 32)),
        height(std::clamp(rows_ / 4, 8, 32)),
        across(columns / width),
        down(rows / height),
        strips(std::min(across, max_strips)),
        straddles(std::size_t(across), 0),
        split_y(split_y_) {
    for (int i = 0; i < across; ++i)
      straddles[std::size_t(i)] = split_x > i * width && split_x < (i + 1) * width;
  }

  std::size_t count() const { return std::size_t(across) * std::size_t(down); }
  int column_of(std::size_t tile) const { return int(tile % std::size_t(across)); }
  int row_of(std::size_t tile) const { return int(tile / std::size_t(across)); }
  int x0(std::size_t tile) const { return column_of(tile) * width; }
  int y0(std::size_t tile) const { return row_of(tile) * height; }
  std::size_t strip_of(std::size_t tile) const {
    return std::size_t(column_of(tile)) * std::size_t(strips) / std::size_t(across);
  }
  /// Strip of a column of pixels.
  std::size_t strip_of_column(int x) const {
    return std::size_t(std::min(x / width, across - 1)) * std::size_t(strips) / std::size_t(across);
  }
  bool is_whole(std::size_t tile) const {
    const int y = y0(tile);
    return !straddles[std::size_t(column_of(tile))] && !(split_y > y && split_y < y + height);
  }

  int split_y = 0;
};

/// Median and standard deviation of about `most` of the values that are finite, evenly spread, by
/// their median absolute deviation; {NaN, 0} if there are none.
struct RobustLevel {
  double level = 0.0, sigma = 0.0;
};
inline RobustLevel robust_level(std::span<const float> values, std::size_t most = 1 << 18) {
  std::vector<float> sample;
  const std::size_t every = std::max<std::size_t>(1, values.size() / most);
  for (std::size_t i = 0; i < values.size(); i += every)
    if (std::isfinite(values[i])) sample.push_back(values[i]);
  if (sample.empty()) return {std::nan(""), 0.0};
  const float middle = median_of(sample);
  for (float& v : sample) v = std::abs(v - middle);
  return {double(middle), sigma_of_median * double(median_of(std::move(sample)))};
}

}  // namespace dmise
