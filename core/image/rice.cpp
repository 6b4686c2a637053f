#include "core/image/rice.h"

#include <algorithm>

namespace dmise {
namespace {

/// Sizes in bits that depend on the size of a pixel.
struct Form {
  unsigned pixel_bits;
  unsigned split_bits;     // length of a block's code
  unsigned largest_split;  // code of uncompressed differences, less 1
};
constexpr Form byte_form{8, 3, 6}, short_form{16, 4, 14}, int_form{32, 5, 25};

/// Reads bits, most significant first.
class Bits {
 public:
  explicit Bits(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool failed() const { return failed_; }

  /// The next `count` <= 32 bits as a number.
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
    return unsigned(store_ >> held_ & ((std::uint64_t(1) << count) - 1));
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

/// Calls `take(index, value)` for each pixel; returns false if the bytes end too early.
template <class Take>
bool decode(std::span<const std::uint8_t> bytes, std::size_t block, const Form& form,
            std::size_t pixels, const Take& take) {
  Bits bits(bytes);
  const unsigned longest_run = 1u << std::min(form.pixel_bits, 31u);
  unsigned last = bits.take(form.pixel_bits);
  for (std::size_t begin = 0; begin < pixels && !bits.failed(); begin += block) {
    const std::size_t end = std::min(begin + block, pixels);
    const unsigned code = bits.take(form.split_bits);
    for (std::size_t i = begin; i < end && !bits.failed(); ++i) {
      unsigned folded = 0;  // 0, -1, 1, -2, 2, ... as 0, 1, 2, 3, 4, ...
      if (code == form.largest_split + 1) {
        folded = bits.take(form.pixel_bits);
      } else if (code > 0) {
        const unsigned high = bits.zeros(longest_run);
        folded = high << (code - 1) | bits.take(code - 1);
      }
      last += folded & 1 ? ~(folded >> 1) : folded >> 1;
      take(i, last);
    }
  }
  return !bits.failed();
}

}  // namespace

bool rice_decode(std::span<const std::uint8_t> bytes, std::size_t block,
                 std::span<std::int16_t> pixels) {
  return decode(bytes, block, short_form, pixels.size(), [&](std::size_t i, unsigned value) {
    pixels[i] = std::int16_t(std::uint16_t(value));
  });
}

bool rice_is_whole(std::span<const std::uint8_t> bytes, std::size_t block, int bytes_per_pixel,
                   std::size_t pixels) {
  const Form& form = bytes_per_pixel == 1   ? byte_form
                     : bytes_per_pixel == 2 ? short_form
                                            : int_form;
  return decode(bytes, block, form, pixels, [](std::size_t, unsigned) {});
}

}  // namespace dmise
