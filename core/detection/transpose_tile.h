#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace dmise {

inline constexpr int transpose_side = 16;

/// Transposes a tile of 16 x 16 numbers: `to[i][j] = from[j][i]`.
inline void transpose_tile(const std::int8_t* const* from, std::int8_t* const* to) {
  using Row = std::int8_t __attribute__((vector_size(transpose_side)));
  Row r[transpose_side], s[transpose_side];
  for (int i = 0; i < transpose_side; ++i) std::memcpy(&r[i], from[i], sizeof(Row));
  // Each of four rounds interleaves rows that are half of the rows apart.
  const auto interleave = [](const Row* a, Row* b) {
    for (int i = 0; i < transpose_side / 2; ++i) {
      const Row low = a[i], high = a[i + transpose_side / 2];
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
  for (int i = 0; i < transpose_side; ++i) std::memcpy(to[i], &r[i], sizeof(Row));
}

}  // namespace dmise
