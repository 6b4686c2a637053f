// Any bytes are a catalogue of stars or one ConfigError; never a crash, a leak or a huge
// allocation.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/sky/stars/star_file.h"
#include "core/sky/stars/star_map.h"
#include "tests/sky/deep_file.h"
#include "tests/sky/gaia_table.h"

namespace {

void read(std::string_view bytes) {
  try {
    dmise::star_map_of(dmise::parse_stars(bytes, "fuzz").catalogue);
  } catch (const dmise::ConfigError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read({reinterpret_cast<const char*>(data), size});
  // Whole files, partly overwritten from the input: reaches what plain bytes seldom do.
  static const std::array<std::string, 2> whole = {
      dmise::test::deep_file({{.vt = 900}, {.vt = 1000, .bt_vt = 200}}),
      dmise::test::barnards_table()};
  if (size < 3) return 0;
  std::string changed = whole[data[0] & 1];
  const std::size_t at = std::size_t((data[0] | data[1] << 8) >> 1) % changed.size();
  for (std::size_t i = 2; i < size && at + i - 2 < changed.size(); ++i)
    changed[at + i - 2] = static_cast<char>(data[i]);
  read(changed);
  return 0;
}
