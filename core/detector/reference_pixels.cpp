#include "core/detector/reference_pixels.h"

#include <algorithm>

#include "core/detector/pixel_flags.h"

namespace dmise {

void empty_reference_pixels(int border_px, int columns, int rows, std::size_t first,
                            std::span<float> electrons, std::span<std::uint8_t> flags) {
  const auto width = std::size_t(columns), size = electrons.size();
  const auto empty = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      electrons[i] = 0.0f;
      if (!flags.empty()) flags[i] |= flag_reference;
    }
  };
  // Row by row: whole ones at the top and bottom, both ends of the others.
  for (std::size_t i = 0; i < size;) {
    const std::size_t x = (first + i) % width, y = (first + i) / width;
    const std::size_t end = std::min(size, i + width - x);
    const auto border = std::size_t(border_px);
    if (y < border || y + border >= std::size_t(rows) || 2 * border >= width) {
      empty(i, end);
    } else {
      const auto at = [&](std::size_t column) {  // of this row, in `electrons`
        return std::min(end, column > x ? i + (column - x) : i);
      };
      empty(i, at(border));
      empty(at(width - border), end);
    }
    i = end;
  }
}

}  // namespace dmise
