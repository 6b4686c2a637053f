#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dmise {

/// A bit for each pixel of a frame.
class BitMask {
 public:
  BitMask(int columns, int rows)
      : words_(std::size_t(columns + 63) / 64), bits_(words_ * std::size_t(rows)) {}

  bool at(int x, int y) const {
    return bits_[std::size_t(y) * words_ + std::size_t(x) / 64] >> (unsigned(x) % 64) & 1;
  }
  void set(int x, int y) {
    bits_[std::size_t(y) * words_ + std::size_t(x) / 64] |= std::uint64_t(1) << (unsigned(x) % 64);
  }
  /// Sets the pixels of a row, from a column on, whose bits are set; all are in the frame.
  void set_bits(int x, int y, std::uint64_t bits) {
    if (bits == 0) return;
    std::uint64_t* word = bits_.data() + std::size_t(y) * words_ + std::size_t(x) / 64;
    const unsigned shift = unsigned(x) % 64;
    word[0] |= bits << shift;
    if (shift != 0 && bits >> (64 - shift) != 0) word[1] |= bits >> (64 - shift);
  }
  /// Returns up to 64 pixels of a row from a column on, all in the frame.
  std::uint64_t bits(int x, int y, int count) const {
    const std::uint64_t* word = bits_.data() + std::size_t(y) * words_ + std::size_t(x) / 64;
    const unsigned shift = unsigned(x) % 64;
    std::uint64_t out = word[0] >> shift;
    if (int(shift) + count > 64) out |= word[1] << (64 - shift);
    return count < 64 ? out & ((std::uint64_t(1) << count) - 1) : out;
  }
  /// Calls `visit` with the columns of a row that are set, from `begin` to before `end`.
  template <class Visit>
  void for_set(int y, int begin, int end, Visit&& visit) const {
    const std::uint64_t* row = bits_.data() + std::size_t(y) * words_;
    for (int first = begin / 64 * 64; first < end; first += 64) {
      std::uint64_t word = row[first / 64];
      if (first < begin) word &= ~std::uint64_t(0) << (begin - first);
      for (; word != 0; word &= word - 1) {
        const int x = first + std::countr_zero(word);
        if (x >= end) return;
        visit(x);
      }
    }
  }

 private:
  std::size_t words_;  // in each row
  std::vector<std::uint64_t> bits_;
};

}  // namespace dmise
