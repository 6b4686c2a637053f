#include "core/config/objects/air_config.h"

#include "core/base/files/text_file.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/cn2_file.h"
#include "core/config/yaml/search_path.h"
#include "core/sky/air/extinction.h"
#include "core/sky/day_sky.h"

namespace dmise {
namespace {

Forms air_share() { return form::number(0.0, 1.0); }

std::vector<Key> turbulence_keys() {
  return {optional("profile", form::text({"hv57"}),
                   "`hv57` (Hufnagel-Valley), or a CSV file of height_m, cn2."),
          bound<&HufnagelValley::high_wind_m_per_s>("high_wind_m_per_s", form::number(0.0, 200.0),
                                                    "Rms wind at 5 to 20 km, of `hv57` [m/s]."),
          bound<&HufnagelValley::ground_cn2>("ground_cn2", form::number(0.0, 1e-10),
                                             "Cn2 at the ground, of `hv57` [m^-2/3]."),
          bound<&TurbulenceWind::ground_m_per_s>("ground_wind_m_per_s", form::number(0.0, 200.0),
                                                 "Wind at the ground [m/s]."),
          bound<&TurbulenceWind::jet_m_per_s>("jet_wind_m_per_s", form::number(0.0, 200.0),
                                              "Wind of the jet stream [m/s].")};
}

const Section& turbulence_section() {
  static const Section section{"turbulence", "The turbulence of the air, by height.",
                               turbulence_keys()};
  return section;
}

const Section& clouds_section() {
  static const Section section{
      "clouds",
      "Clouds: a veil of one transmission, or patches that the wind carries.",
      {optional("cover", air_share(), "Share of the sky that patches cover. Without it: a veil."),
       bound<&PatchyClouds::transmission>("transmission", air_share(),
                                          "Of a veil, or of the middle of a patch at the zenith."),
       bound<&PatchyClouds::patch_m>("patch_m", form::number(10.0, 1e6),
                                     "Size of the largest patches [m]."),
       bound<&PatchyClouds::height_m>("height_m", form::number(10.0, 20e3),
                                      "Height above the site [m]."),
       bound<&PatchyClouds::wind_east_m_per_s>("wind_east_m_per_s", form::number(-200.0, 200.0),
                                               "Wind towards east [m/s]."),
       bound<&PatchyClouds::wind_north_m_per_s>("wind_north_m_per_s", form::number(-200.0, 200.0),
                                                "Wind towards north [m/s]."),
       bound<&PatchyClouds::seed>("seed", form::seed(), "Seed of the pattern.")}};
  return section;
}

TurbulenceProfile read_profile(YamlMap& map) {
  const auto profile = map.require("profile");
  if (profile.text() == "hv57") {
    HufnagelValley model;
    read_bound(map, model);
    return model;
  }
  const std::string path = find_beside(profile.text(), profile.file());
  if (path.empty()) profile.fail("must be hv57 or the path of a CSV file of height_m, cn2");
  return parse_cn2(read_text_file(path, 4u << 20), path);
}

TurbulenceConfig read_turbulence_keys(YamlMap& map) {
  TurbulenceConfig config{.profile = read_profile(map), .wind = {}};
  read_bound(map, config.wind);
  return config;
}

TurbulenceConfig read_turbulence(const YamlValue& value) {
  if (value.is_scalar()) {
    value.choice();
    return {};
  }
  YamlMap map(value, turbulence_section());
  TurbulenceConfig config = read_turbulence_keys(map);
  map.done();
  return config;
}

Clouds read_clouds(const YamlValue& value) {
  if (value.is_scalar()) return UniformCloud{value.number()};
  YamlMap map(value, clouds_section());
  const auto cover = map.find("cover");
  if (!cover) {
    const UniformCloud veil{map.number("transmission")};
    map.done();
    return veil;
  }
  PatchyClouds p{.cover = cover->number()};
  read_bound(map, p);
  map.done();
  return p;
}

}  // namespace

const Section& atmosphere_section() {
  static const Section section{
      "atmosphere",
      "What the air does to light.",
      {optional("extinction", form::number(0.0, 5.0) | form::text(extinction_site_names()),
                "A site's curve, or k at 550 nm [mag/airmass].", "0.17"),
       optional("refraction", form::flag(),
                "Whether the air bends light. The plan decides if not given."),
       optional("turbulence", form::choice({"hv57"}) | form::map(turbulence_section),
                "Turbulence over the site, for scintillation."),
       optional("aerosol_optical_depth", form::number(0.0, 5.0),
                "Optical depth of haze towards the zenith at 550 nm, for the day sky alone.",
                "what `extinction` has beyond molecules and ozone"),
       bound<&AtmosphereConfig::angstrom_exponent>(
           "angstrom_exponent", form::number(-1.0, 4.0),
           "Haze's depth goes by the wavelength to minus this, for the day sky alone.",
           shortest_text(Haze().angstrom_exponent)),
       bound<&AtmosphereConfig::ground_albedo>("ground_albedo", air_share(),
                                               "Share of light that the ground reflects by day.",
                                               shortest_text(DayAir().ground_albedo))}};
  return section;
}

const Section& weather_section() {
  static const Section section{
      "weather",
      "The weather at the site. Without pressure a standard atmosphere by height is taken.",
      {optional("pressure_hpa", form::number(0.0, 1100.0), "Air pressure [hPa]."),
       optional("temperature_c", form::number(-90.0, 60.0), "Air temperature [deg C]."),
       optional("humidity", air_share(), "Relative humidity."),
       optional("clouds", air_share() | form::map(clouds_section),
                "Transmission of a veil, or clouds."),
       optional("pwv_mm", form::number(0.0, 100.0),
                "Precipitable water [mm]; with it water vapour and oxygen absorb in their bands.",
                "as measured in the extinction curve, to 1.1 um")}};
  return section;
}

AtmosphereConfig standard_atmosphere(double k_v_mag_per_airmass) {
  AtmosphereConfig atmosphere;
  atmosphere.extinction = std::to_string(k_v_mag_per_airmass);
  atmosphere.extinction_mag_per_airmass = extinction_scaled_to(k_v_mag_per_airmass);
  return atmosphere;
}

AtmosphereConfig read_atmosphere(const YamlValue& value, AtmosphereConfig known) {
  YamlMap map(value, atmosphere_section());
  if (const auto extinction = map.find("extinction")) {
    if (extinction->is_like_number()) {
      AtmosphereConfig even = standard_atmosphere(extinction->number());
      known.extinction = std::move(even.extinction);
      known.extinction_mag_per_airmass = std::move(even.extinction_mag_per_airmass);
    } else if (auto curve = extinction_of_site(extinction->text())) {
      known.extinction = extinction->text();
      known.extinction_mag_per_airmass = std::move(*curve);
    } else {
      const auto& names = extinction_site_names();
      extinction->fail("must be one of " + joined(names) + " or k at 550 nm [mag/airmass]" +
                       did_you_mean(extinction->text(), names));
    }
  }
  if (const auto refraction = map.find("refraction")) known.refraction = refraction->flag();
  if (const auto turbulence = map.find("turbulence"))
    known.turbulence = read_turbulence(*turbulence);
  if (const auto depth = map.find("aerosol_optical_depth"))
    known.aerosol_optical_depth = depth->number();
  read_bound(map, known);
  map.done();
  return known;
}

WeatherConfig read_weather(const YamlValue& value, WeatherConfig known) {
  YamlMap map(value, weather_section());
  const auto pressure = map.find("pressure_hpa");
  const auto temperature = map.find("temperature_c");
  const auto humidity = map.find("humidity");
  if (pressure || temperature || humidity) {
    Weather air = known.air.value_or(Weather{});
    if (!pressure && !known.air)
      value.fail("temperature and humidity need pressure_hpa beside them", false);
    if (pressure) air.pressure_hpa = pressure->number();
    if (temperature) air.temperature_c = temperature->number();
    if (humidity) air.humidity = humidity->number();
    known.air = air;
  }
  if (const auto clouds = map.find("clouds")) known.clouds = read_clouds(*clouds);
  if (const auto water = map.find("pwv_mm")) known.pwv_mm = water->number();
  map.done();
  return known;
}

const Section& seeing_section() {
  static const Section section{
      "seeing",
      "Turbulence as a camera with `psf: diffraction` sees it: `r0_m`, or a profile over "
      "height.",
      with_keys(
          {optional(
               "r0_m", form::number(1e-3, 1e6),
               "Fried's parameter at 500 nm in the direction of the camera [m]; needed without "
               "a profile."),
           optional("outer_scale_m", form::number(0.1, 1e6), "Outer scale [m].", "infinite"),
           optional("wind_m_per_s", form::number(0.0, 1e4),
                    "Wind that carries the turbulence past the pupil [m/s].",
                    shortest_text(SensorSeeing().wind_m_per_s)),
           bound<&SensorSeeing::wind_direction_deg>(
               "wind_direction_deg", form::number(-360.0, 360.0),
               "Direction of the wind across the image [deg].")},
          turbulence_keys())};
  return section;
}

SensorSeeing read_seeing(const YamlValue& value, double airmass) {
  constexpr double wavelength_m = 500 * nm;  // `SensorSeeing::r0_m` is stated at it
  YamlMap map(value, seeing_section());
  SensorSeeing seeing;
  if (map.find("profile")) {
    const TurbulenceConfig over = read_turbulence_keys(map);
    const Turbulence t = turbulence(over.profile, wavelength_m, airmass, over.wind);
    seeing.r0_m = t.r0_m;
    seeing.wind_m_per_s = t.wind_m_per_s;
  } else {
    seeing.r0_m = map.number("r0_m");
    seeing.wind_m_per_s = map.number("wind_m_per_s");
  }
  if (const auto v = map.find("outer_scale_m")) seeing.outer_scale_m = v->number();
  read_bound(map, seeing);
  map.done();
  return seeing;
}

}  // namespace dmise
