#include "core/image/rice.h"

#include <algorithm>
#include <vector>

namespace dmise {
namespace {

constexpr unsigned split_bits = 4;      // of a block's code
constexpr unsigned largest_split = 14;  // this code means: differences as they are
constexpr unsigned pixel_bits = 16;

/// Bits of a byte string, the highest first.
class Bits {
 public:
  explicit Bits(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool failed() const { return failed_; }

  /// `count` <= 24 bits as a number.
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

  /// How many zeros stand before the next one, which is taken too; at most `limit`.
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

/// Appends bits to bytes, the highest first.
class BitWriter {
 public:
  explicit BitWriter(std::string& bytes) : bytes_(bytes) {}

  /// The low `count` <= 32 bits of a number below 2^count.
  void put(std::uint32_t bits, unsigned count) {
    store_ = store_ << count | bits;
    held_ += count;
    for (; held_ >= 8; held_ -= 8) bytes_ += char(store_ >> (held_ - 8));
  }
  void put_zeros_and_one(unsigned zeros) {
    for (; zeros >= 32; zeros -= 32) put(0, 32);
    put(1, zeros + 1);
  }
  void finish() {
    if (held_ > 0) put(0, 8 - held_);
  }

 private:
  std::string& bytes_;
  std::uint64_t store_ = 0;
  unsigned held_ = 0;
};

/// What the standard fixes for integers of one size.
template <class Pixel>
struct Code;
template <>
struct Code<std::uint16_t> {
  using Signed = std::int16_t;
  static constexpr unsigned split_bits = 4, largest_split = 14, pixel_bits = 16;
};
template <>
struct Code<std::uint8_t> {
  using Signed = std::int8_t;
  static constexpr unsigned split_bits = 3, largest_split = 6, pixel_bits = 8;
};

template <class Pixel>
void encode(std::span<const Pixel> pixels, std::size_t block, std::string& bytes) {
  using C = Code<Pixel>;
  if (pixels.empty()) return;
  BitWriter out(bytes);
  std::vector<std::uint32_t> folded(block);
  Pixel last = pixels[0];
  out.put(last, C::pixel_bits);
  for (std::size_t begin = 0; begin < pixels.size(); begin += block) {
    const std::size_t size = std::min(block, pixels.size() - begin);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const Pixel next = pixels[begin + i];
      const auto d = typename C::Signed(Pixel(next - last));
      last = next;
      folded[i] = std::uint32_t(d < 0 ? ~(std::int32_t(d) * 2) : std::int32_t(d) * 2);
      sum += folded[i];
    }
    if (sum == 0) {
      out.put(0, C::split_bits);
      continue;
    }
    // Low bits that stand as they are: about the logarithm of the mean difference.
    unsigned split = 0;
    const std::uint64_t mean = sum > size / 2 ? (sum - size / 2 - 1) / size : 0;
    for (std::uint64_t m = mean / 2; m > 0; m /= 2) ++split;
    if (split >= C::largest_split) {
      out.put(C::largest_split + 1, C::split_bits);
      for (std::size_t i = 0; i < size; ++i) out.put(folded[i], C::pixel_bits);
      continue;
    }
    out.put(split + 1, C::split_bits);
    for (std::size_t i = 0; i < size; ++i) {
      out.put_zeros_and_one(folded[i] >> split);
      out.put(folded[i] & ((1u << split) - 1), split);
    }
  }
  out.finish();
}

}  // namespace

void rice_encode(std::span<const std::uint16_t> pixels, std::size_t block, std::string& bytes) {
  encode(pixels, block, bytes);
}
void rice_encode(std::span<const std::uint8_t> pixels, std::size_t block, std::string& bytes) {
  encode(pixels, block, bytes);
}

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
