#pragma once
#include <optional>
#include <string>

#include "core/config/objects/air_config.h"
#include "core/config/yaml/section.h"
#include "core/sky/sky_model.h"

namespace dmise {

class YamlMap;
class YamlValue;

/// `sky:` of a sensor or site: the name of a preset, a number for a uniform sky [V mag/arcsec2], or
/// a mapping.
struct SkyConfig {
  std::string preset;  // "urban", "suburban", "dark", "space"; empty: uniform
  SkyParts parts;      // components that are on

  /// Nominal V brightness of the zenith, without Moon and twilight, for which lamps are chosen;
  /// natural components vary.
  double zenith_mag_per_arcsec2 = 21.9;
};

/// Sky, atmosphere and weather as far as they are configured.
struct Surroundings {
  std::optional<SkyConfig> sky;
  std::optional<AtmosphereConfig> atmosphere;
  std::optional<WeatherConfig> weather;
};

SkyConfig sky_preset(const std::string& name);

/// Reads `sky`, `atmosphere` and `weather` of a site's or sensor's mapping; missing keys leave
/// `known` unchanged.
void read_surroundings(YamlMap& map, Surroundings& known);

/// Throws `ConfigError` at `where` if a component of the sky has no spectrum in the band, or its
/// heat is not known there: beyond 25 um, and beyond 2.5 um without water vapour.
void check_sky_in_band(const YamlValue& where, const SkyConfig& sky, const Band& band, bool in_air,
                       bool knows_water);

/// The keys of the surroundings, for the sections of sites and sensors.
std::vector<Key> surroundings_keys();

}  // namespace dmise
