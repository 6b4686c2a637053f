#pragma once
#include <cstdint>
#include <variant>

#include "core/frames/vec.h"

namespace dmise {

/// One veil over the whole sky.
struct UniformCloud {
  double transmission = 1.0;  // at the zenith, [0, 1]; elsewhere to the power of the airmass

  bool operator==(const UniformCloud&) const = default;
};

/// Patches of cloud in a thin layer, drifting with the wind.
struct PatchyClouds {
  double cover = 0.5;         // share of the layer, [0, 1]
  double transmission = 0.1;  // in the middle of a cloud at the zenith, [0, 1]
  double patch_m = 3000.0;    // size of the largest pieces
  double height_m = 3000.0;   // the layer above the site
  double wind_east_m_per_s = 8.0;
  double wind_north_m_per_s = 0.0;
  std::uint64_t seed = 1;

  bool operator==(const PatchyClouds&) const = default;
};

/// To add clouds: list them here, give them a pattern in clouds.cpp, test them in
/// tests/sky/test_clouds.cpp.
using Clouds = std::variant<UniformCloud, PatchyClouds>;

/// Clouds as a map of transmission. The same pattern for the same seed, everywhere and in any
/// order.
class CloudMap {
 public:
  /// Throws `Error` for numbers outside their ranges.
  explicit CloudMap(const Clouds& clouds);

  /// Share of the light from a direction (unit) that comes through, [0, 1], at a time since the
  /// start [s]. Smooth; below 1 deg of altitude that of 1 deg.
  double transmission(const Vec<Enu>& direction, double time_s) const;

 private:
  Clouds clouds_;
  double threshold_ = 0.0;  // there is cloud where the pattern is above it
};

}  // namespace dmise
