#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace dmise {

/// What magnitude 0 is.
/// - V-solar: the V (Vega) of a source of the Sun's colour that is as bright in the band. Truth is
///   in it, and cameras that ask for nothing else.
/// - Vega: Vega has 0.03 in every band.
/// - AB: 3631 Jy at every wavelength.
enum class MagnitudeSystem : std::uint8_t { v_solar, vega, ab };

/// Their names in products and cameras, in the order of the enumeration.
inline constexpr std::array<const char*, 3> magnitude_system_names{"V-solar", "Vega", "AB"};

constexpr std::span<const char* const> names_of(MagnitudeSystem) { return magnitude_system_names; }

constexpr const char* magnitude_system_name(MagnitudeSystem system) {
  return magnitude_system_names[std::size_t(system)];
}

constexpr std::optional<MagnitudeSystem> magnitude_system_of(std::string_view name) {
  for (std::size_t i = 0; i < magnitude_system_names.size(); ++i)
    if (name == magnitude_system_names[i]) return MagnitudeSystem(i);
  return std::nullopt;
}

/// The system of a frame's magnitudes.
struct MagnitudeScale {
  MagnitudeSystem system = MagnitudeSystem::v_solar;
  double solar_colour_mag = 0.0;  // a magnitude in it less the V-solar one of the same source

  bool operator==(const MagnitudeScale&) const = default;
};

}  // namespace dmise
