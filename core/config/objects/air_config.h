#pragma once
#include <optional>
#include <string>

#include "core/optics/waves/seeing.h"
#include "core/photometry/curve.h"
#include "core/sky/air/clouds.h"
#include "core/sky/air/refraction.h"
#include "core/sky/air/turbulence.h"

// The air above a site, and the weather in it.
namespace dmise {

class YamlValue;
struct Section;

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
  // Only the day sky depends on these.
  std::optional<double> aerosol_optical_depth;  // at 550 nm; none: as the extinction has it
  std::optional<double> angstrom_exponent, ground_albedo;
};

/// `weather:` of a ground sensor or its site: parameters of the night.
struct WeatherConfig {
  std::optional<Weather> air;  // none: the standard atmosphere at the site's height
  std::optional<Clouds> clouds;
  std::optional<double> pwv_mm;  // precipitable water
};

AtmosphereConfig standard_atmosphere(double k_v_mag_per_airmass);

/// Read `atmosphere` and `weather`; missing keys leave `known` unchanged.
AtmosphereConfig read_atmosphere(const YamlValue& value, AtmosphereConfig known);
WeatherConfig read_weather(const YamlValue& value, WeatherConfig known);

/// Reads `seeing:` of a sensor: r0 and wind, or `{profile: hv57 | FILE.csv, ...}`, whose r0 and
/// wind are those of its turbulence at this airmass.
SensorSeeing read_seeing(const YamlValue& value, double airmass);

/// The keys of `atmosphere` and `weather`.
const Section& atmosphere_section();
const Section& weather_section();
/// The keys of `seeing`: r0 of the air above, or a profile of its turbulence.
const Section& seeing_section();

}  // namespace dmise
