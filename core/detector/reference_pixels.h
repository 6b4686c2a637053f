#pragma once
#include <cstddef>
#include <span>

namespace dmise {

/// Empties the pixels of a border `border_px` wide, of those from `first` on (row-major): they are
/// read like the others but collect nothing.
void empty_reference_pixels(int border_px, int columns, int rows, std::size_t first,
                            std::span<float> electrons);

}  // namespace dmise
