#pragma once
#include <string>
#include <vector>

#include "sensors/indi/indi_devices.h"

// How properties are written down.
namespace dmise {

inline constexpr const char *main_group = "Main Control", *motion_group = "Motion Control",
                            *site_group = "Site Management", *options_group = "Options",
                            *image_group = "Image Settings", *info_group = "Image Info",
                            *satellite_group = "Satellite";

inline IndiTitle numbers(const char* name, const char* label, const char* group) {
  return {name, label, group, IndiKind::number};
}
inline IndiTitle texts(const char* name, const char* label, const char* group) {
  return {name, label, group, IndiKind::text};
}
inline IndiTitle one_of(const char* name, const char* label, const char* group) {
  return {name, label, group, IndiKind::toggle, IndiRule::one_of_many};
}
inline IndiTitle at_most_one(const char* name, const char* label, const char* group) {
  return {name, label, group, IndiKind::toggle, IndiRule::at_most_one};
}

inline IndiItem number_item(const char* name, const char* label, double value,
                            const IndiRange& range = {}) {
  return {name, label, value, range};
}
inline IndiItem switch_item(const char* name, const char* label, bool on) {
  return {name, label, on};
}
inline IndiItem text_item(const char* name, const char* label, const std::string& value) {
  return {name, label, value};
}

/// A switch that does something when it is set, and is off.
inline IndiReading button(const char* name, const char* label) {
  return {{switch_item(name, label, false)}};
}

/// Refuses what a property has but cannot be changed to.
[[noreturn]] inline void refuse_value(const std::string& reason) {
  throw DeviceError(DeviceFault::invalid_value, reason);
}

}  // namespace dmise
