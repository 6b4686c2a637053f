#pragma once
#include <sodium.h>
#include <zlib.h>

#include <stdexcept>
#include <string>

namespace dmise {

/// The bytes of what `compact` wrote, as a page reads them.
inline std::string inflated(const std::string& text, std::size_t size) {
  std::string packed(text.size(), '\0');
  std::size_t length = 0;
  if (sodium_base642bin(reinterpret_cast<unsigned char*>(packed.data()), packed.size(), text.data(),
                        text.size(), nullptr, &length, nullptr, sodium_base64_VARIANT_ORIGINAL))
    throw std::runtime_error("no base64");
  std::string bytes(size, '\0');
  uLongf got = size;
  if (uncompress(reinterpret_cast<Bytef*>(bytes.data()), &got,
                 reinterpret_cast<const Bytef*>(packed.data()), uLong(length)) != Z_OK ||
      got != size)
    throw std::runtime_error("no deflated bytes, or of another size");
  return bytes;
}

}  // namespace dmise
