// Any bytes are a picture of finite pixels or one ConfigError; never a crash, a leak or a huge
// allocation.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/pictures/picture_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto picture = dmise::decode_picture({reinterpret_cast<const char*>(data), size});
    for (const float v : picture.pixels)
      if (!std::isfinite(v)) std::abort();
  } catch (const dmise::ConfigError&) {
  }
  return 0;
}
