#include "core/dataset/npy.h"

namespace dmise {

std::string npy_bytes(std::span<const std::uint16_t> pixels, int columns, int rows) {
  constexpr std::size_t alignment = 64;
  std::string header = "{'descr': '<u2', 'fortran_order': False, 'shape': (" +
                       std::to_string(rows) + ", " + std::to_string(columns) + "), }";
  constexpr std::size_t before = 10;  // magic, version, length of the header
  header.append(alignment - (before + header.size() + 1) % alignment, ' ');
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += char(header.size() & 0xff);
  bytes += char(header.size() >> 8);
  bytes += header;
  const std::size_t begin = bytes.size();
  bytes.resize(begin + 2 * pixels.size());
  char* out = bytes.data() + begin;
  for (const std::uint16_t p : pixels) {
    *out++ = char(p & 0xff);
    *out++ = char(p >> 8);
  }
  return bytes;
}

}  // namespace dmise
