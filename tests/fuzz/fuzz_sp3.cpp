#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/error.h"
#include "core/orbit/sp3.h"

using namespace dmise;

// An orbit that was read answers within its span, and with an error outside.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const char* satellite : {"", "L71"}) {
    try {
      const Trajectory orbit = parse_sp3(text, "fuzz", satellite);
      for (const double t_s : {-1.0, 0.0, 1.0, 130.0, 1e4, 1e9}) {
        try {
          state_at(orbit, {orbit.reference.jd1, orbit.reference.jd2 + t_s / 86400});
        } catch (const Error&) {
        }
      }
    } catch (const ConfigError&) {
    }
  }
  return 0;
}
