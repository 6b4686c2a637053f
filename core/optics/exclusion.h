#pragma once
#include <optional>
#include <string>

namespace dmise {

/// What a camera does in an exposure in which a body is too near its axis.
enum class ExclusionAction {
  flag,           // products say so, and are otherwise the same
  close_shutter,  // no light comes in
};
inline constexpr const char* exclusion_action_names[] = {"flag", "close_shutter"};

/// Least angles of a camera's optical axis from bright bodies [deg, 0..180]: what is nearer is
/// excluded. None: no limit.
struct Exclusion {
  std::optional<double> sun_deg, moon_deg;  // from their centres
  std::optional<double> earth_limb_deg;     // from the nearest point of the limb; in orbit
  ExclusionAction action = ExclusionAction::flag;

  bool any() const { return sun_deg || moon_deg || earth_limb_deg; }
  bool operator==(const Exclusion&) const = default;
};

/// Which bodies were too near the axis in an exposure.
struct Excluded {
  bool sun = false, moon = false, earth_limb = false;

  bool any() const { return sun || moon || earth_limb; }
  bool operator==(const Excluded&) const = default;
};

inline bool closes_shutter(const Exclusion& exclusion, const Excluded& excluded) {
  return exclusion.action == ExclusionAction::close_shutter && excluded.any();
}

/// "the Sun and the Earth's limb"; empty for none.
inline std::string excluding_text(const Excluded& excluded) {
  std::string text;
  const auto add = [&](bool is, const char* what) {
    if (is) text += (text.empty() ? "" : " and ") + std::string(what);
  };
  add(excluded.sun, "the Sun");
  add(excluded.moon, "the Moon");
  add(excluded.earth_limb, "the Earth's limb");
  return text;
}

}  // namespace dmise
