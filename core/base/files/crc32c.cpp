#include "core/base/files/crc32c.h"

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

#include <array>
#include <cstring>

namespace dmise {
namespace {

using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Tables make_tables() {
  Tables t{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1) ? (c >> 1) ^ 0x82F63B78u : c >> 1;
    t[0][i] = c;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t i = 0; i < 256; ++i) t[k][i] = (t[k - 1][i] >> 8) ^ t[0][t[k - 1][i] & 255];
  return t;
}

constexpr Tables tables = make_tables();

std::uint32_t by_tables(const unsigned char* p, std::size_t size, std::uint32_t c) {
  for (; size >= 8; size -= 8, p += 8) {
    const std::uint32_t low = c ^ (std::uint32_t(p[0]) | std::uint32_t(p[1]) << 8 |
                                   std::uint32_t(p[2]) << 16 | std::uint32_t(p[3]) << 24);
    c = tables[7][low & 255] ^ tables[6][(low >> 8) & 255] ^ tables[5][(low >> 16) & 255] ^
        tables[4][low >> 24] ^ tables[3][p[4]] ^ tables[2][p[5]] ^ tables[1][p[6]] ^
        tables[0][p[7]];
  }
  for (; size > 0; --size, ++p) c = (c >> 8) ^ tables[0][(c ^ *p) & 255];
  return c;
}

#if defined(__x86_64__)
/// With the SSE 4.2 instruction.
__attribute__((target("sse4.2"))) std::uint32_t by_instruction(const unsigned char* p,
                                                               std::size_t size, std::uint32_t c) {
  std::uint64_t wide = c;
  for (; size >= 8; size -= 8, p += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, p, 8);
    wide = _mm_crc32_u64(wide, word);
  }
  c = std::uint32_t(wide);
  for (; size > 0; --size, ++p) c = _mm_crc32_u8(c, *p);
  return c;
}

auto fastest(SimdLevel level) {
  static const bool has_instruction = __builtin_cpu_supports("sse4.2");
  return level != SimdLevel::sse2 && has_instruction ? by_instruction : by_tables;
}
#else
auto fastest(SimdLevel) { return by_tables; }
#endif

}  // namespace

std::uint32_t crc32c(const void* data, std::size_t size, std::uint32_t previous, SimdLevel level) {
  return ~fastest(level)(static_cast<const unsigned char*>(data), size, ~previous);
}

}  // namespace dmise
