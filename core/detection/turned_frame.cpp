#include "core/detection/turned_frame.h"

#include <algorithm>

#include "core/detection/transpose_tile.h"

namespace dmise {

TurnedFrame::TurnedFrame(const FilteredFrame& frame)
    : columns(frame.columns), rows(frame.rows), snr(frame.snr.size()) {
  const auto to = [&](int x, int y) {
    return snr.data() + std::size_t(x) * std::size_t(rows) + std::size_t(y);
  };
  // By bands of columns, so that what is written to stays in the cache.
  constexpr int side = transpose_side, band = 4 * side;
  for (int x0 = 0; x0 < columns; x0 += band)
    for (int y = 0; y < rows; y += side)
      for (int x = x0; x < std::min(x0 + band, columns); x += side) {
        const int across = std::min(side, columns - x), down = std::min(side, rows - y);
        if (across < side || down < side) {
          for (int j = 0; j < down; ++j)
            for (int i = 0; i < across; ++i) *to(x + i, y + j) = frame.row(y + j)[x + i];
          continue;
        }
        const std::int8_t* from[side];
        std::int8_t* turned[side];
        for (int i = 0; i < side; ++i) {
          from[i] = frame.row(y + i) + x;
          turned[i] = to(x + i, y);
        }
        transpose_tile(from, turned);
      }
}

}  // namespace dmise
