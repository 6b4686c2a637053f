#pragma once
#include <optional>

#include "core/config/yaml/section.h"
#include "core/frames/geodesy.h"
#include "core/sky/bodies/earth_disc.h"

namespace dmise {

/// The Earth of a scenario: `simulation: {ellipsoid, origin, earth_albedo}`.
struct EarthConfig {
  Ellipsoid ellipsoid;                 // sites, heights, shadow, occultation and limb refer to it
  std::optional<Site> origin;          // where east, north and up are 0; on the ellipsoid
  double albedo = usual_earth_albedo;  // its disc and earthshine have it
};

/// These keys, for the section of `simulation`.
std::vector<Key> earth_keys();

class YamlMap;
/// Reads these keys of `simulation`. Throws `ConfigError`.
EarthConfig read_earth(YamlMap& simulation);

class JsonWriter;
/// Writes what differs from the usual Earth of WGS 84 without an origin.
void write_earth(JsonWriter& json, const EarthConfig& earth);

}  // namespace dmise
