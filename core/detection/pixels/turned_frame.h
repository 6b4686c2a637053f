#pragma once
#include <cstdint>
#include <vector>

#include "core/detection/pixels/filtered_frame.h"

namespace dmise {

/// A filtered frame with columns as rows, along which lines are summed that pass more columns than
/// rows: samples of lines beside each other then share lines of the cache.
struct TurnedFrame {
  int columns = 0, rows = 0;     // as in the filtered frame
  std::vector<std::int8_t> snr;  // columns x rows

  explicit TurnedFrame(const FilteredFrame& frame);

  /// Hides a pixel.
  void hide(int x, int y) { snr[std::size_t(x) * std::size_t(rows) + std::size_t(y)] = 0; }
};

}  // namespace dmise
