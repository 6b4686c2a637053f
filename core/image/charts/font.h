#pragma once
#include <array>
#include <cstdint>

namespace dmise {

inline constexpr int glyph_columns = 5;
inline constexpr int glyph_rows = 7;

/// Rows of a printable ASCII character, top first, the leftmost column in bit 4; a box for other
/// characters.
std::array<std::uint8_t, glyph_rows> glyph(char letter);

}  // namespace dmise
