#include "core/detector/reference_pixels.h"

namespace dmise {

void empty_reference_pixels(int border_px, int columns, int rows, std::size_t first,
                            std::span<float> electrons) {
  const auto width = std::size_t(columns);
  for (std::size_t i = 0; i < electrons.size(); ++i) {
    const auto x = int((first + i) % width), y = int((first + i) / width);
    if (x < border_px || y < border_px || x >= columns - border_px || y >= rows - border_px)
      electrons[i] = 0.0f;
  }
}

}  // namespace dmise
