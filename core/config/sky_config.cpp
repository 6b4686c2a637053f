#include "core/config/sky_config.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text_file.h"
#include "core/base/units.h"
#include "core/config/cn2_file.h"
#include "core/config/search_path.h"
#include "core/sky/extinction.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

const Bounds brightness = Bounds::between(-10.0, 30.0);
const Bounds share = Bounds::between(0.0, 1.0);

SkyConfig one_brightness(double v_mag_per_arcsec2) {
  SkyConfig sky{.zenith_mag_per_arcsec2 = v_mag_per_arcsec2};
  sky.parts.uniform = UniformSky{v_mag_per_arcsec2};
  return sky;
}

bool is_number(const YamlValue& value) {
  return value.is_scalar() && value.text().find_first_not_of("+-.0123456789") == std::string::npos;
}

/// Adds lamps that bring the zenith to `zenith` together with the natural sky.
void read_zenith(const YamlValue& value, SkyConfig& sky) {
  const double zenith = value.number(brightness);
  sky.zenith_mag_per_arcsec2 = zenith;
  if (sky.preset == "space") {
    sky.parts.uniform = UniformSky{zenith};
    return;
  }
  const double natural_mag = *zenith_brightness_named("dark");
  if (zenith >= natural_mag)
    value.fail("must be brighter (less) than the natural sky's 21.9, or without preset");
  if (!sky.parts.light_pollution) sky.parts.light_pollution = LightPollution{};
  sky.parts.light_pollution->zenith_v_mag_per_arcsec2 =
      mag_per_arcsec2_of_s10(s10_of_mag_per_arcsec2(zenith) - s10_of_mag_per_arcsec2(natural_mag));
}

LampMix read_lamps(const YamlValue& value) {
  YamlMap map(value);
  LampMix lamps{.lps = map.number_or("lps", 0.0, share),
                .hps = map.number_or("hps", 0.0, share),
                .led = map.number_or("led", 0.0, share)};
  map.done();
  if (lamps.lps + lamps.hps + lamps.led <= 0) value.fail("one share must be > 0", false);
  return lamps;
}

CityGlow read_city(const YamlValue& value) {
  YamlMap map(value);
  const CityGlow usual;
  CityGlow city;
  city.azimuth_rad = map.number("azimuth_deg", Bounds::between(-360.0, 360.0)) * deg;
  city.half_width_rad =
      map.number_or("half_width_deg", usual.half_width_rad / deg, Bounds::between(1.0, 180.0)) *
      deg;
  city.height_rad =
      map.number_or("height_deg", usual.height_rad / deg, Bounds::between(1.0, 90.0)) * deg;
  city.horizon_over_zenith =
      map.number_or("horizon_over_zenith", usual.horizon_over_zenith, Bounds::between(0.0, 1e4));
  map.done();
  return city;
}

void read_parts(const YamlValue& value, SkyParts& parts) {
  YamlMap map(value);
  const auto switch_part = [&](std::string_view name, auto& part) {
    const auto flag = map.find(name);
    if (!flag) return;
    if (!flag->flag()) {
      part.reset();
    } else if (!part) {
      part.emplace();
    }
  };
  switch_part("uniform", parts.uniform);
  switch_part("airglow", parts.airglow);
  switch_part("zodiacal_light", parts.zodiacal_light);
  switch_part("faint_starlight", parts.faint_starlight);
  switch_part("scattered_moonlight", parts.scattered_moonlight);
  switch_part("twilight", parts.twilight);
  switch_part("light_pollution", parts.light_pollution);
  map.done();
}

SkyConfig read_sky(const YamlValue& value) {
  if (is_number(value)) return one_brightness(value.number(brightness));
  if (value.is_scalar()) return sky_preset(value.choice({"urban", "suburban", "dark", "space"}));
  YamlMap map(value);
  const auto zenith = map.find("zenith_mag_per_arcsec2");
  const auto preset = map.find("preset");
  if (!preset) {
    const double figure = map.number("zenith_mag_per_arcsec2", brightness);
    map.done();
    return one_brightness(figure);
  }
  SkyConfig sky = sky_preset(preset->choice({"urban", "suburban", "dark", "space"}));
  if (zenith) read_zenith(*zenith, sky);
  if (const auto parts = map.find("parts")) read_parts(*parts, sky.parts);
  const auto lit = [&](const YamlValue& key) -> LightPollution& {
    if (!sky.parts.light_pollution) key.fail("there is no light pollution in this sky", false);
    return *sky.parts.light_pollution;
  };
  if (const auto lamps = map.find("lamps")) lit(*lamps).lamps = read_lamps(*lamps);
  if (const auto cities = map.find("cities"))
    for (const auto& city : cities->list()) lit(city).cities.push_back(read_city(city));
  if (const auto airglow = map.find("airglow_zenith_mag_per_arcsec2")) {
    if (!sky.parts.airglow) airglow->fail("there is no airglow in this sky", false);
    sky.parts.airglow->zenith_v_mag_per_arcsec2 = airglow->number(brightness);
  }
  map.done();
  return sky;
}

TurbulenceProfile read_profile(YamlMap& map) {
  const auto profile = map.require("profile");
  const HufnagelValley usual;
  if (profile.text() == "hv57")
    return HufnagelValley{
        map.number_or("high_wind_m_per_s", usual.high_wind_m_per_s, Bounds::between(0.0, 200.0)),
        map.number_or("ground_cn2", usual.ground_cn2, Bounds::between(0.0, 1e-10))};
  const std::string path = find_beside(profile.text(), profile.file());
  if (path.empty()) profile.fail("must be hv57 or the path of a CSV file of height_m, cn2");
  return parse_cn2(read_text_file(path, 4u << 20), path);
}

TurbulenceConfig read_turbulence_keys(YamlMap& map) {
  const TurbulenceWind usual;
  TurbulenceConfig config{.profile = read_profile(map), .wind = {}};
  const Bounds speed = Bounds::between(0.0, 200.0);
  config.wind.ground_m_per_s = map.number_or("ground_wind_m_per_s", usual.ground_m_per_s, speed);
  config.wind.jet_m_per_s = map.number_or("jet_wind_m_per_s", usual.jet_m_per_s, speed);
  return config;
}

TurbulenceConfig read_turbulence(const YamlValue& value) {
  if (value.is_scalar()) {
    value.choice({"hv57"});
    return {};
  }
  YamlMap map(value);
  TurbulenceConfig config = read_turbulence_keys(map);
  map.done();
  return config;
}

AtmosphereConfig read_atmosphere(const YamlValue& value, AtmosphereConfig known) {
  YamlMap map(value);
  if (const auto extinction = map.find("extinction")) {
    if (is_number(*extinction)) {
      known = standard_atmosphere(extinction->number(Bounds::between(0.0, 5.0)));
    } else if (auto curve = extinction_of_site(extinction->text())) {
      known.extinction = extinction->text();
      known.extinction_mag_per_airmass = std::move(*curve);
    } else {
      std::string all;
      for (const auto& name : extinction_site_names()) all += name + ", ";
      const std::string hint = nearest_name(extinction->text(), extinction_site_names());
      extinction->fail("must be one of " + all + "or k at 550 nm [mag/airmass]" +
                       (hint.empty() ? "" : "; did you mean " + hint + "?"));
    }
  }
  if (const auto refraction = map.find("refraction")) known.refraction = refraction->flag();
  if (const auto turbulence = map.find("turbulence"))
    known.turbulence = read_turbulence(*turbulence);
  map.done();
  return known;
}

Clouds read_clouds(const YamlValue& value) {
  if (value.is_scalar()) return UniformCloud{value.number(share)};
  YamlMap map(value);
  const auto cover = map.find("cover");
  if (!cover) {
    const UniformCloud veil{map.number("transmission", share)};
    map.done();
    return veil;
  }
  PatchyClouds p{.cover = cover->number(share)};
  const Bounds wind = Bounds::between(-200.0, 200.0);
  p.transmission = map.number_or("transmission", p.transmission, share);
  p.patch_m = map.number_or("patch_m", p.patch_m, Bounds::between(10.0, 1e6));
  p.height_m = map.number_or("height_m", p.height_m, Bounds::between(10.0, 20e3));
  p.wind_east_m_per_s = map.number_or("wind_east_m_per_s", p.wind_east_m_per_s, wind);
  p.wind_north_m_per_s = map.number_or("wind_north_m_per_s", p.wind_north_m_per_s, wind);
  p.seed = std::uint64_t(map.integer_or("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
  map.done();
  return p;
}

WeatherConfig read_weather(const YamlValue& value, WeatherConfig known) {
  YamlMap map(value);
  const auto pressure = map.find("pressure_hpa");
  const auto temperature = map.find("temperature_c");
  const auto humidity = map.find("humidity");
  if (pressure || temperature || humidity) {
    Weather air = known.air.value_or(Weather{});
    if (!pressure && !known.air)
      value.fail("temperature and humidity need pressure_hpa beside them", false);
    if (pressure) air.pressure_hpa = pressure->number(Bounds::between(0.0, 1100.0));
    if (temperature) air.temperature_c = temperature->number(Bounds::between(-90.0, 60.0));
    if (humidity) air.humidity = humidity->number(share);
    known.air = air;
  }
  if (const auto clouds = map.find("clouds")) known.clouds = read_clouds(*clouds);
  map.done();
  return known;
}

}  // namespace

SkyConfig sky_preset(const std::string& name) {
  return {.preset = name,
          .parts = sky_parts_named(name).value(),
          .zenith_mag_per_arcsec2 = zenith_brightness_named(name).value()};
}

AtmosphereConfig standard_atmosphere(double k_v_mag_per_airmass) {
  AtmosphereConfig atmosphere;
  atmosphere.extinction = std::to_string(k_v_mag_per_airmass);
  atmosphere.extinction_mag_per_airmass = extinction_scaled_to(k_v_mag_per_airmass);
  return atmosphere;
}

void read_surroundings(YamlMap& map, Surroundings& known) {
  constexpr double usual_k_v = 0.17;
  if (const auto sky = map.find("sky")) known.sky = read_sky(*sky);
  if (const auto atmosphere = map.find("atmosphere"))
    known.atmosphere = read_atmosphere(
        *atmosphere, known.atmosphere ? *known.atmosphere : standard_atmosphere(usual_k_v));
  if (const auto weather = map.find("weather"))
    known.weather = read_weather(*weather, known.weather.value_or(WeatherConfig{}));
}

bool names_profile(const YamlValue& seeing) {
  return seeing.is_map() && YamlMap(seeing).find("profile").has_value();
}

SensorSeeing read_seeing_profile(const YamlValue& value, double airmass,
                                 std::optional<TurbulenceConfig>& turbulence_over) {
  constexpr double wavelength_m = 500 * nm;  // of `SensorSeeing::r0_m`
  YamlMap map(value);
  turbulence_over = read_turbulence_keys(map);
  SensorSeeing seeing;
  if (const auto v = map.find("outer_scale_m"))
    seeing.outer_scale_m = v->number(Bounds::between(0.1, 1e6));
  seeing.wind_direction_deg =
      map.number_or("wind_direction_deg", 0.0, Bounds::between(-360.0, 360.0));
  map.done();
  const Turbulence t =
      turbulence(turbulence_over->profile, wavelength_m, airmass, turbulence_over->wind);
  seeing.r0_m = t.r0_m;
  seeing.wind_m_per_s = t.wind_m_per_s;
  return seeing;
}

void check_sky_in_band(const YamlValue& where, const SkyConfig& sky, const Band& band,
                       bool in_air) {
  try {
    SkyModel(sky.parts, SkyScene{.in_air = in_air}, band, Curve{});
  } catch (const Error& e) {
    where.fail(std::string("the sky can't be drawn in this band: ") + e.what(), false);
  }
}

}  // namespace dmise
