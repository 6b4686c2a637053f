#include "core/report/compact_bytes.h"

#include <sodium.h>
#include <zlib.h>

#include <cstdint>

#include "core/base/error.h"

namespace dmise {
namespace {

template <class Number>
std::string planes(std::span<const Number> numbers) {
  std::string out(numbers.size() * sizeof(Number), '\0');
  char* at = out.data();
  for (unsigned byte = 0; byte < sizeof(Number); ++byte)
    for (const Number n : numbers) *at++ = char((std::uint32_t(n) >> (8 * byte)) & 0xff);
  return out;
}

}  // namespace

std::string byte_planes(std::span<const std::int32_t> numbers) { return planes(numbers); }
std::string byte_planes(std::span<const std::uint16_t> numbers) { return planes(numbers); }

std::string base64(std::string_view bytes) {
  std::string text(sodium_base64_ENCODED_LEN(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), reinterpret_cast<const unsigned char*>(bytes.data()),
                    bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  text.pop_back();  // its zero
  return text;
}

std::string compact(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string deflated(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(deflated.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 6) != Z_OK)
    throw Error("deflate: out of memory");
  deflated.resize(size);
  return base64(deflated);
}

}  // namespace dmise
