#include "core/image/rice.h"

#include <algorithm>

namespace dmise {
namespace {

constexpr unsigned split_bits = 4;      // of a block's code
constexpr unsigned largest_split = 14;  // code of uncompressed differences
constexpr unsigned pixel_bits = 16;

/// Reads bits, most significant first.
class Bits {
 public:
  explicit Bits(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool failed() const { return failed_; }

  /// The next `count` <= 24 bits as a number.
  unsigned take(unsigned count) {
    while (held_ < count) {
      if (at_ == bytes_.size()) {
        failed_ = true;
        return 0;
      }
      store_ = store_ << 8 | bytes_[at_++];
      held_ += 8;
    }
    held_ -= count;
    return unsigned(store_ >> held_) & ((1u << count) - 1);
  }

  /// Number of zeros before the next one, which is consumed too; at most `limit`.
  unsigned zeros(unsigned limit) {
    unsigned count = 0;
    while (!failed_ && take(1) == 0)
      if (++count > limit) failed_ = true;
    return count;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::uint64_t store_ = 0;
  unsigned held_ = 0;
  bool failed_ = false;
};

}  // namespace

bool rice_decode(std::span<const std::uint8_t> bytes, std::size_t block,
                 std::span<std::int16_t> pixels) {
  Bits bits(bytes);
  unsigned last = bits.take(pixel_bits);
  for (std::size_t begin = 0; begin < pixels.size() && !bits.failed(); begin += block) {
    const std::size_t end = std::min(begin + block, pixels.size());
    const unsigned code = bits.take(split_bits);
    for (std::size_t i = begin; i < end && !bits.failed(); ++i) {
      unsigned folded = 0;  // 0, -1, 1, -2, 2, ... as 0, 1, 2, 3, 4, ...
      if (code == largest_split + 1) {
        folded = bits.take(pixel_bits);
      } else if (code > 0) {
        const unsigned high = bits.zeros(1u << pixel_bits);
        folded = high << (code - 1) | bits.take(code - 1);
      }
      last += folded & 1 ? ~(folded >> 1) : folded >> 1;
      pixels[i] = std::int16_t(std::uint16_t(last));
    }
  }
  return !bits.failed();
}

}  // namespace dmise
