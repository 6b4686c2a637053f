#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// Samples of a frame along a line, one in each row or column k from `from` to `to`, between the
/// two pixels at either side of its place there: middle + slope (k - centre) + bend (1/3 - r^2)
/// with r = (k - centre) to_r. 0 is a pixel that is hidden.
struct LineSamples {
  const std::int8_t* pixels = nullptr;
  std::size_t count = 0;                        // pixels: kernels read four at once
  std::size_t along_step = 1, across_step = 1;  // from one row or column to the next, and beside it
  int from = 0, to = -1;
  int across = 0;  // pixels of a row or column
  double centre = 0.0, middle = 0.0, slope = 0.0, bend = 0.0, to_r = 0.0;
};

/// Sum of the samples that are not hidden, and how many these are.
struct SampleSum {
  static constexpr int bits = 12;  // fractional ones: sums are whole numbers, in any order the same

  std::int64_t sum = 0;  // in units of 2^-bits
  int samples = 0;
};

/// Lines beside each other, of the same rows: one begins at each pixel from `reach` before a line
/// to `reach` after it. Arrays have `width` elements, which are 0 at first: every second line from
/// the first on, then, unless they are left out, those between.
struct BandSums {
  static constexpr int bits = 5;    // fractional ones
  static constexpr int block = 64;  // `width` is a multiple of it
  static constexpr int spare = 64;  // pixels that are read after the last, for which `row` has room

  int reach = 0, width = 0;
  bool has_odd = true;  // whether lines between every second one are summed
  std::int32_t *sum = nullptr, *samples = nullptr;      // by line; sums in units of 2^-bits
  std::int16_t *part = nullptr, *part_count = nullptr;  // sums of some rows; 0 afterwards
  std::int8_t* row = nullptr;                           // pixels, with 0 beside the frame

  /// Place of a line in the arrays.
  std::size_t place_of(int line) const {
    return std::size_t(line / 2) + (line % 2 != 0 ? std::size_t(width / 2) : 0);
  }
};

#define DMISE_LINE_KERNELS(level)                                 \
  namespace level {                                               \
  SampleSum sum_samples(const LineSamples& line);                 \
  /* Sums of the lines beside one of which `across_step` is 1. */ \
  void sum_band(const LineSamples& line, const BandSums& band);   \
  }
DMISE_EACH_SIMD_SET(DMISE_LINE_KERNELS)
#undef DMISE_LINE_KERNELS

}  // namespace dmise
