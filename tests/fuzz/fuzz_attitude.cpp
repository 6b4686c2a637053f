#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/error.h"
#include "core/orbit/attitude_table.h"
#include "tests/fuzz/catalogue_invariants.h"

using namespace dmise;

// A table that was read gives a rotation at each of its times and between.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const TableAttitude table = parse_attitude_table(text, "fuzz");
    const double first_s = table.time_s.front(), last_s = table.time_s.back();
    for (const double t_s : {first_s, first_s / 2 + last_s / 2, last_s}) {
      const auto r = gcrs_from_body(table, {.time_s = t_s, .position_m = {1, 0, 0}});
      for (const Vec<Body>& axis : {Vec<Body>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
        fuzz::require(std::abs(norm(r * axis) - 1) < 1e-12);
    }
  } catch (const ConfigError&) {
  }
  return 0;
}
