#include "core/detection/pixels/turned_frame.h"

#include <algorithm>
#include <cstring>

#include "core/base/memory.h"

namespace dmise {
namespace {

constexpr int side = 16;  // rows and columns of a tile

/// Transposes a tile of 16 x 16 numbers: `to[i][j] = from[j][i]`.
void transpose_tile(const std::int8_t* const* from, std::int8_t* const* to) {
  using Row = std::int8_t __attribute__((vector_size(side)));
  Row r[side], s[side];
  for (int i = 0; i < side; ++i) std::memcpy(&r[i], from[i], sizeof(Row));
  // Each of four rounds interleaves rows that are half of the rows apart.
  const auto interleave = [](const Row* a, Row* b) {
    for (int i = 0; i < side / 2; ++i) {
      const Row low = a[i], high = a[i + side / 2];
      b[2 * i] = __builtin_shufflevector(low, high, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22,
                                         7, 23);
      b[2 * i + 1] = __builtin_shufflevector(low, high, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13,
                                             29, 14, 30, 15, 31);
    }
  };
  interleave(r, s);
  interleave(s, r);
  interleave(r, s);
  interleave(s, r);
  for (int i = 0; i < side; ++i) std::memcpy(to[i], &r[i], sizeof(Row));
}

}  // namespace

TurnedFrame::TurnedFrame(const FilteredFrame& frame)
    : columns(frame.columns),
      rows(frame.rows),
      snr(zeros_in_large_pages<std::int8_t>(frame.snr.size())) {
  const auto to = [&](int x, int y) {
    return snr.data() + std::size_t(x) * std::size_t(rows) + std::size_t(y);
  };
  // By bands of columns, so that what is written to stays in the cache.
  constexpr int band = 4 * side;
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
