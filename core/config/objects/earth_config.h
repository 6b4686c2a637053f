#pragma once
#include <optional>

#include "core/config/yaml/section.h"
#include "core/frames/geodesy.h"
#include "core/sky/bodies/earth_disc.h"

namespace dmise {

/// The Earth of a scenario: `simulation: {ellipsoid, origin, earth_albedo}`.
struct EarthConfig {
  Ellipsoid ellipsoid;                 // of sites, heights, shadow, occultation and limb
  std::optional<Site> origin;          // of the scenario's east, north and up; on the ellipsoid
  double albedo = usual_earth_albedo;  // of its disc and of earthshine
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
