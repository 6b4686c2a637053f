#pragma once
#include <optional>
#include <string>

#include "core/config/yaml_reader.h"
#include "core/effects/effects.h"
#include "core/optics/seeing.h"
#include "core/photometry/curve.h"
#include "core/sky/clouds.h"
#include "core/sky/refraction.h"
#include "core/sky/sky_model.h"
#include "core/sky/turbulence.h"

namespace dmise {

/// `sky:` of a sensor or site: the name of a preset, a figure for a sky of one brightness
/// [V mag/arcsec2], or a mapping.
struct SkyConfig {
  std::string preset;  // "urban", "suburban", "dark", "space"; empty: one brightness
  SkyParts parts;      // those switched on

  /// V brightness of the zenith that the parts are made for, without Moon and twilight; the natural
  /// parts move around theirs.
  double zenith_mag_per_arcsec2 = 21.9;
};

/// Turbulence over a site, and the wind that carries it.
struct TurbulenceConfig {
  TurbulenceProfile profile;
  TurbulenceWind wind;
};

/// `atmosphere:` of a ground sensor or its site: what changes with the place.
struct AtmosphereConfig {
  std::string extinction = "0.17";   // site of the table, or k at 550 nm [mag/airmass]
  Curve extinction_mag_per_airmass;  // over wavelength
  std::optional<bool> refraction;    // switches the effect
  std::optional<TurbulenceConfig> turbulence;
};

/// `weather:` of a ground sensor or its site: what changes with the night.
struct WeatherConfig {
  std::optional<Weather> air;  // none: the standard atmosphere at the site's height
  std::optional<Clouds> clouds;
};

/// A sensor's surroundings, as far as its configuration gives them.
struct Surroundings {
  std::optional<SkyConfig> sky;
  std::optional<AtmosphereConfig> atmosphere;
  std::optional<WeatherConfig> weather;
};

SkyConfig sky_preset(const std::string& name);
AtmosphereConfig standard_atmosphere(double k_v_mag_per_airmass);

/// Reads `sky`, `atmosphere` and `weather` of a site's or sensor's mapping; what is not there is
/// left as it is in `known`.
void read_surroundings(YamlMap& map, Surroundings& known);

/// Whether a sensor's `seeing:` names a profile of turbulence: then it is read here.
bool names_profile(const YamlValue& seeing);
/// `seeing: {profile: hv57 | FILE.csv, ...}`: r0 and wind of the profile's turbulence towards a
/// pointing at this airmass; the profile itself goes to `turbulence_over`.
SensorSeeing read_seeing_profile(const YamlValue& value, double airmass,
                                 std::optional<TurbulenceConfig>& turbulence_over);

/// Throws `ConfigError` at `where` when a part of the sky has no spectrum in the band.
void check_sky_in_band(const YamlValue& where, const SkyConfig& sky, const Band& band, bool in_air);

}  // namespace dmise
