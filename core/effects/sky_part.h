#pragma once
#include <cstddef>

namespace dmise {

/// Parts of the sky, in the order in which they are listed.
enum class SkyPart {
  uniform,
  airglow,
  zodiacal_light,
  faint_starlight,
  scattered_moonlight,
  twilight,
  light_pollution,
  thermal_sky,
  daylight,
  count
};
inline constexpr std::size_t sky_part_count = static_cast<std::size_t>(SkyPart::count);

}  // namespace dmise
