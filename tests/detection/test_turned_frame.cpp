#include "core/detection/pixels/turned_frame.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace dmise {
namespace {

// Frames of one row, of less than a tile, of whole ones and of more.
TEST(TurnedFrame, HasColumnsAsRows) {
  for (const auto& [columns, rows] : {std::pair{1, 1}, {40, 1}, {3, 70}, {64, 32}, {131, 49}}) {
    FilteredFrame frame(columns, rows, 0.9);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) frame.row(y)[x] = std::int8_t((7 * x + 13 * y) % 63 - 31);
    TurnedFrame turned(frame);
    turned.hide(columns - 1, rows / 2);
    frame.hide(rows / 2, columns - 1, columns - 1);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x)
        ASSERT_EQ(turned.snr[std::size_t(x * rows + y)], frame.row(y)[x]) << x << " " << y;
  }
}

}  // namespace
}  // namespace dmise
