#pragma once
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

 private:
  std::size_t words_;  // of a row
  std::vector<std::uint64_t> bits_;
};

}  // namespace dmise
