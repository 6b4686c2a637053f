// Any bytes are frames of another camera or one ConfigError; never a crash, a leak or a huge
// allocation.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/ingest/any_frame.h"
#include "tests/ingest/foreign_file.h"

namespace {

void decode(std::string_view bytes) {
  static dmise::Threads one(1);
  try {
    dmise::decode_frames(bytes, "fuzz.fits", {}, one, [](const dmise::Frame&) {});
  } catch (const dmise::ConfigError&) {
  }
}

/// Whole files of each form, which the input overwrites in part: that reaches what plain bytes
/// seldom do.
const std::vector<std::string>& files() {
  using dmise::test::card;
  using dmise::test::ForeignImage;
  static const std::vector<std::string> all = [] {
    const std::vector<std::string> cards = {card("DATE-OBS", "'2024-01-02T03:04:05.678'"),
                                            card("TIMESYS", "'TT'"),
                                            card("EXPTIME", "2.5"),
                                            card("EGAIN", "0.7"),
                                            card("RDNOISE", "3.0"),
                                            card("SATURATE", "5000.0"),
                                            card("SITELAT", "'51 28 38'"),
                                            card("SITELONG", "-3.5"),
                                            card("CTYPE1", "'RA---TAN-SIP'"),
                                            card("CTYPE2", "'DEC--TAN-SIP'"),
                                            card("CRPIX1", "8.0"),
                                            card("CRPIX2", "6.0"),
                                            card("CRVAL1", "10.0"),
                                            card("CRVAL2", "20.0"),
                                            card("CD1_1", "-0.01"),
                                            card("CD2_2", "0.01"),
                                            card("LONPOLE", "170.0"),
                                            card("A_ORDER", "2"),
                                            card("A_2_0", "1E-4"),
                                            card("B_ORDER", "3")};
    std::vector<double> values;
    for (int i = 0; i < 16 * 12 * 3; ++i) values.push_back(100 + i * 37 % 23);
    std::vector<std::string> out;
    for (const int bitpix : {BYTE_IMG, SHORT_IMG, LONG_IMG, FLOAT_IMG})
      for (const int compression : {0, RICE_1, GZIP_1, GZIP_2})
        for (const long planes : {1L, 3L})
          out.push_back(dmise::test::encoded(
              ForeignImage{.bitpix = bitpix,
                           .shape = {16, 12, planes},
                           .values = {values.begin(), values.begin() + 16 * 12 * planes},
                           .cards = cards,
                           .in_extension = planes == 3,
                           .compression = compression}));
    return out;
  }();
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  decode({reinterpret_cast<const char*>(data), size});
  if (size < 4) return 0;
  std::string changed = files()[data[0] % files().size()];
  const std::size_t at = std::size_t(data[1] | data[2] << 8) % changed.size();
  for (std::size_t i = 3; i < size && at + i - 3 < changed.size(); ++i)
    changed[at + i - 3] = static_cast<char>(data[i]);
  decode(changed);
  return 0;
}
