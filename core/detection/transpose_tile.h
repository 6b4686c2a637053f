#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace dmise {

inline constexpr int transpose_side = 8;

/// Transposes a tile of 8 x 8 numbers: `to[i][j] = from[j][i]`.
inline void transpose_tile(const std::int16_t* const* from, std::int16_t* const* to) {
  using Row = std::int16_t __attribute__((vector_size(2 * transpose_side)));
  Row r[transpose_side], s[transpose_side];
  for (int i = 0; i < transpose_side; ++i) std::memcpy(&r[i], from[i], sizeof(Row));
  // Each of three rounds interleaves rows that are half of the rows apart.
  const auto interleave = [](const Row* a, Row* b) {
    for (int i = 0; i < transpose_side / 2; ++i) {
      const Row low = a[i], high = a[i + transpose_side / 2];
      b[2 * i] = __builtin_shufflevector(low, high, 0, 8, 1, 9, 2, 10, 3, 11);
      b[2 * i + 1] = __builtin_shufflevector(low, high, 4, 12, 5, 13, 6, 14, 7, 15);
    }
  };
  interleave(r, s);
  interleave(s, r);
  interleave(r, s);
  for (int i = 0; i < transpose_side; ++i) std::memcpy(to[i], &s[i], sizeof(Row));
}

/// Copies `count` numbers in the opposite order.
inline void copy_reversed(const std::int16_t* from, std::size_t count, std::int16_t* to) {
  using Row = std::int16_t __attribute__((vector_size(2 * transpose_side)));
  std::size_t done = 0;
  for (; done + transpose_side <= count; done += transpose_side) {
    Row r;
    std::memcpy(&r, from + count - done - transpose_side, sizeof(Row));
    r = __builtin_shufflevector(r, r, 7, 6, 5, 4, 3, 2, 1, 0);
    std::memcpy(to + done, &r, sizeof(Row));
  }
  for (; done < count; ++done) to[done] = from[count - 1 - done];
}

}  // namespace dmise
