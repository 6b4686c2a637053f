#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace dmise {

/// Empties the pixels of a border `border_px` wide, of those from `first` on (row-major): they are
/// read like the others but collect nothing. Sets `flag_reference` unless `flags` is empty.
void empty_reference_pixels(int border_px, int columns, int rows, std::size_t first,
                            std::span<float> electrons, std::span<std::uint8_t> flags = {});

}  // namespace dmise
