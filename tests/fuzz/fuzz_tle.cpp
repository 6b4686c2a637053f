#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/error.h"
#include "core/orbit/elements/element_text.h"
#include "core/orbit/elements/tle.h"
#include "tests/fuzz/catalogue_invariants.h"

using namespace dmise;

namespace {

/// A set that was read can be written, and reads back as the same orbit.
void require_round_trip(const MeanElements& e) {
  std::string text;
  try {
    text = format_tle(e);
  } catch (const Error&) {
    return;  // a value that no TLE can hold
  }
  const std::size_t middle = text.find('\n');
  const MeanElements again =
      parse_tle(text.substr(0, middle), text.substr(middle + 1, text.size() - middle - 2));
  fuzz::require(again.catalogue_number == e.catalogue_number);
  fuzz::require(std::abs(again.inclination_rad - e.inclination_rad) < 1e-6);
}

}  // namespace

// Both readers that take fixed columns, strict and lenient.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const bool lenient : {false, true}) {
    for (const auto& read : {read_tle, read_gpredict}) {
      CatalogueFile file;
      read(text, lenient, file);
      fuzz::require_sound(file);
      for (const MeanElements& e : file.elements) require_round_trip(e);
    }
  }
  try {
    fuzz::require_sound(parse_catalogue(text, "fuzz"));
  } catch (const ConfigError&) {
  }
  return 0;
}
