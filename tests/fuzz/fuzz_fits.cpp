// Any bytes are a frame or one ConfigError; never a crash, a leak or a huge allocation.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/image/fits_file.h"
#include "tests/image/sample_frame.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    dmise::decode_frame(bytes, "fuzz.fits");
  } catch (const dmise::ConfigError&) {
  }
  // A whole frame, plain or compressed, partly overwritten from the input: reaches what plain bytes
  // seldom do.
  using dmise::FitsCompression;
  static const auto encoded = [](FitsCompression compression) {
    auto header = dmise::test::sample_header(16, 12);
    if (compression == FitsCompression::rice)  // and with lookup tables
      header.wcs.refraction = dmise::WcsRefraction{
          .zenith = {0, 0, 1}, .focal_length_px = 9, .pressure_hpa = 950, .cell_px = 6};
    return dmise::test::encoded(dmise::test::sample_counts(16, 12), header, compression);
  };
  static const std::string plain = encoded(FitsCompression::none),
                           rice = encoded(FitsCompression::rice);
  if (size < 3) return 0;
  const unsigned place = data[0] | data[1] << 8;
  std::string changed = place & 1 ? rice : plain;
  const std::size_t at = (place >> 1) % changed.size();
  for (std::size_t i = 2; i < size && at + i - 2 < changed.size(); ++i)
    changed[at + i - 2] = static_cast<char>(data[i]);
  try {
    dmise::decode_frame(changed, "fuzz.fits");
  } catch (const dmise::ConfigError&) {
  }
  return 0;
}
