#pragma once
#include <optional>
#include <string>

#include "core/config/yaml_reader.h"
#include "core/optics/seeing.h"
#include "core/photometry/curve.h"
#include "core/sky/clouds.h"
#include "core/sky/refraction.h"
#include "core/sky/sky_model.h"
#include "core/sky/turbulence.h"

namespace dmise {

/// `sky:` of a sensor or site: the name of a preset, a number for a uniform sky [V mag/arcsec2], or
/// a mapping.
struct SkyConfig {
  std::string preset;  // "urban", "suburban", "dark", "space"; empty: uniform
  SkyParts parts;      // components that are on

  /// Nominal V brightness of the zenith, without Moon and twilight, for which lamps are chosen;
  /// natural components vary.
  double zenith_mag_per_arcsec2 = 21.9;
};

/// Turbulence above a site, and the wind that moves it.
struct TurbulenceConfig {
  TurbulenceProfile profile;
  TurbulenceWind wind;
};

/// `atmosphere:` of a ground sensor or its site: parameters of the place.
struct AtmosphereConfig {
  std::string extinction = "0.17";   // site of the table, or k at 550 nm [mag/airmass]
  Curve extinction_mag_per_airmass;  // over wavelength
  std::optional<bool> refraction;    // switches the effect, if set
  std::optional<TurbulenceConfig> turbulence;
};

/// `weather:` of a ground sensor or its site: parameters of the night.
struct WeatherConfig {
  std::optional<Weather> air;  // none: the standard atmosphere at the site's height
  std::optional<Clouds> clouds;
  std::optional<double> pwv_mm;  // precipitable water
};

/// Sky, atmosphere and weather as far as they are configured.
struct Surroundings {
  std::optional<SkyConfig> sky;
  std::optional<AtmosphereConfig> atmosphere;
  std::optional<WeatherConfig> weather;
};

SkyConfig sky_preset(const std::string& name);
AtmosphereConfig standard_atmosphere(double k_v_mag_per_airmass);

/// Reads `sky`, `atmosphere` and `weather` of a site's or sensor's mapping; missing keys leave
/// `known` unchanged.
void read_surroundings(YamlMap& map, Surroundings& known);

/// Reads `seeing:` of a sensor: r0 and wind, or `{profile: hv57 | FILE.csv, ...}`, whose r0 and
/// wind are those of its turbulence at this airmass.
SensorSeeing read_seeing(const YamlValue& value, double airmass);

/// Throws `ConfigError` at `where` if a component of the sky has no spectrum in the band.
void check_sky_in_band(const YamlValue& where, const SkyConfig& sky, const Band& band, bool in_air);

/// The keys of `seeing`: r0 of the air above, or a profile of its turbulence.
const Section& seeing_section();
/// The keys of the surroundings, for the sections of sites and sensors.
std::vector<Key> surroundings_keys();

}  // namespace dmise
