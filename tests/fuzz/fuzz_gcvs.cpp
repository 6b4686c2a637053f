// Any bytes are a catalogue of variable stars or one ConfigError; and its stars have magnitudes.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/sky/variables/variable_stars.h"
#include "tests/sky/gcvs_rows.h"

namespace {

void read(std::string_view bytes) {
  try {
    const dmise::VariableReading reading = dmise::parse_gcvs(bytes, "fuzz");
    dmise::StarCatalogue catalogue;
    for (const dmise::VariableRecord& record : reading.stars)
      dmise::append_star(catalogue, {.ra_rad = record.ra_rad,
                                     .dec_rad = record.dec_rad,
                                     .v_mag = record.brightest_mag.value_or(8.0)});
    if (catalogue.size() == 0) return;
    const dmise::StarMap map = dmise::star_map_of(std::move(catalogue));
    const dmise::VariableStars stars(map, reading);
    for (const auto& star : stars.stars()) {
      const double v_mag =
          stars.v_mag(star.place, map.stars.v_mag[star.place], {2458139.6, {0, 0, 0}}, {1, 0, 0});
      const double below = 1e-5 * (1.0 + star.curve.depth_mag);
      if (!(v_mag >= star.brightest_v_mag - below) || !(v_mag < 1e3)) std::abort();
    }
  } catch (const dmise::ConfigError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read({reinterpret_cast<const char*>(data), size});
  // Real rows, partly overwritten from the input: reaches what plain bytes seldom do.
  if (size < 3) return 0;
  std::string changed = dmise::test::gcvs_rows;
  const std::size_t at = std::size_t(data[0] | data[1] << 8) % changed.size();
  for (std::size_t i = 2; i < size && at + i - 2 < changed.size(); ++i)
    changed[at + i - 2] = static_cast<char>(data[i]);
  read(changed);
  return 0;
}
