#pragma once
#include <optional>

#include "core/config/section.h"
#include "core/frames/geodesy.h"

namespace dmise {

/// The Earth of a scenario: `simulation: {ellipsoid, origin}`.
struct EarthConfig {
  Ellipsoid ellipsoid;         // of sites, heights, shadow, occultation and limb
  std::optional<Site> origin;  // of the scenario's east, north and up; on the ellipsoid
};

/// These keys, for the section of `simulation`.
std::vector<Key> earth_keys();

class YamlMap;
/// Reads both keys of `simulation`. Throws `ConfigError`.
EarthConfig read_earth(YamlMap& simulation);

class JsonWriter;
/// Writes what differs from an Earth of WGS 84 without an origin.
void write_earth(JsonWriter& json, const EarthConfig& earth);

}  // namespace dmise
