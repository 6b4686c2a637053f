#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/error.h"
#include "core/orbit/oem.h"

using namespace dmise;

// A trajectory that was read answers within its span, and with an error outside.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const Trajectory trajectory = parse_oem(text, "fuzz");
    for (const double t_s : {-1.0, 0.0, 1.0, 1e4, 1e9}) {
      try {
        state_at(trajectory, {trajectory.reference.jd1, trajectory.reference.jd2 + t_s / 86400});
      } catch (const Error&) {
      }
    }
  } catch (const ConfigError&) {
  }
  return 0;
}
