#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/detection/pixels/bit_mask.h"

namespace dmise {

/// A frame through the matched filter of a point source: SNR in steps of 1/5, clipped at +-6.2.
/// 0 stands for pixels of which nothing is known, because they were hidden; what rounds to 0 is 1
/// where column plus row is odd, else -1.
struct FilteredFrame {
  static constexpr int steps = 5, most = 31;

  int columns = 0, rows = 0;
  double sigma_px = 1.0;         // width of the matched filter
  std::vector<std::int8_t> snr;  // rows x columns

  /// A cell of a mesh over the frame, as `flatten` found it.
  struct Cell {
    float middle = 0.0f, scatter = 1.0f;  // median and divisor of the pixels that are not hidden
    float hidden = 0.0f;  // share of the pixels that are hidden or have light of stars
  };
  std::vector<Cell> mesh;  // empty until the frame is flat

  FilteredFrame(int columns_, int rows_, double sigma)
      : columns(columns_),
        rows(rows_),
        sigma_px(sigma),
        snr(zeros_in_large_pages<std::int8_t>(std::size_t(columns_) * std::size_t(rows_))) {}

  std::int8_t* row(int y) { return snr.data() + std::size_t(y) * std::size_t(columns); }
  const std::int8_t* row(int y) const { return snr.data() + std::size_t(y) * std::size_t(columns); }
  /// Hides pixels [first, last] of a row, as far as they are in the frame.
  void hide(int y, int first, int last) {
    if (y < 0 || y >= rows) return;
    first = std::max(first, 0);
    last = std::min(last, columns - 1);
    if (first <= last) std::fill(row(y) + first, row(y) + last + 1, std::int8_t(0));
  }
  /// Subtracts the local median of the pixels that are not hidden and divides by their scatter.
  /// Stars too faint to be hidden and the remains of others then count as light and scatter of the
  /// sky; where stars made the noise seem too large when it was measured, the scatter is below 1.
  /// `lit`, if not null: pixels with light of stars that were subtracted.
  void flatten(Threads& threads, const BitMask* lit = nullptr);
  /// Returns the cell around a place; before `flatten` one of noise alone.
  Cell cell_at(double x_px, double y_px) const;

  /// Returns the steps that `flatten` has made of an SNR around a place.
  int steps_of(double snr_before, int x, int y) const {
    const Cell cell = cell_at(x, y);
    const double flat = (snr_before * steps - double(cell.middle)) / double(cell.scatter);
    return int(std::clamp(flat, 1.0, double(most)));
  }

  /// Correlation of noise at `distance_px`.
  double correlation(double distance_px) const {
    return std::exp(-distance_px * distance_px / (4 * sigma_px * sigma_px));
  }
  /// Variance of a sum of `samples` along a line over that of uncorrelated ones, `spacing_px`
  /// apart.
  double sum_variance(double spacing_px, int samples) const {
    double sum = 1.0;
    for (int k = 1; k < samples && k * spacing_px < 8 * sigma_px; ++k)
      sum += 2 * correlation(k * spacing_px) * (1.0 - double(k) / samples);
    return sum;
  }
};

}  // namespace dmise
