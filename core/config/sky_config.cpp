#include "core/config/sky_config.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/base/text_file.h"
#include "core/base/units.h"
#include "core/config/cn2_file.h"
#include "core/config/search_path.h"
#include "core/sky/extinction.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

constexpr std::int64_t most_seed = std::numeric_limits<std::int64_t>::max();

Forms brightness() { return form::number(-10.0, 30.0); }
Forms share() { return form::number(0.0, 1.0); }
Forms sky_names() { return form::choice({"urban", "suburban", "dark", "space"}); }

const Section& parts_section() {
  static const Section section{
      "parts",
      "Parts of the sky's light, each switched on or off.",
      {optional("uniform", form::flag(), "One brightness everywhere."),
       optional("airglow", form::flag(), "Light of the upper atmosphere."),
       optional("zodiacal_light", form::flag(), "Sunlight scattered by dust between the planets."),
       optional("faint_starlight", form::flag(), "Stars fainter than the catalogue's limit."),
       optional("scattered_moonlight", form::flag(), "Moonlight scattered by the air."),
       optional("twilight", form::flag(), "Sunlight scattered by the air after sunset."),
       optional("light_pollution", form::flag(), "Light of lamps scattered by the air.")}};
  return section;
}

const Section& lamps_section() {
  static const Section section{"lamps",
                               "Shares of lamps in the light pollution; one must be above 0.",
                               {optional("lps", share(), "Low-pressure sodium.", "0"),
                                optional("hps", share(), "High-pressure sodium.", "0"),
                                optional("led", share(), "White LED.", "0")}};
  return section;
}

const Section& city_section() {
  static const Section section{
      "cities",
      "The glow of a city at the horizon.",
      {required("azimuth_deg", form::number(-360.0, 360.0), "From north through east [deg]."),
       optional("half_width_deg", form::number(1.0, 180.0), "Standard deviation in azimuth [deg].",
                "40.1"),
       optional("height_deg", form::number(1.0, 90.0),
                "Altitude at which the glow has fallen to 1/e [deg].", "14.9"),
       optional("horizon_over_zenith", form::number(0.0, 1e4),
                "Its peak, in units of the zenith's even light pollution.", "5")}};
  return section;
}

const Section& sky_section() {
  static const Section section{
      "sky",
      "The light of the sky: one brightness, or a preset with changes.",
      {optional("preset", sky_names(), "A sky to start from."),
       optional("zenith_mag_per_arcsec2", brightness(),
                "Brightness of the zenith [V mag/arcsec^2]; alone, that of the whole sky."),
       optional("parts", form::map(parts_section), "Parts switched on or off."),
       optional("lamps", form::map(lamps_section), "The lamps that make the light pollution."),
       optional("cities", form::list(form::map(city_section)), "Glows at the horizon."),
       optional("airglow_zenith_mag_per_arcsec2", brightness(),
                "Brightness of the airglow at the zenith [V mag/arcsec^2].", "22.4"),
       optional("solar_flux_sfu", form::number(50.0, 400.0),
                "The Sun's flux at 10.7 cm, monthly mean [10^-22 W/m^2/Hz]: 70 at its minimum, 200 "
                "at its maximum. Airglow follows it.",
                "130")}};
  return section;
}

std::vector<Key> turbulence_keys() {
  return {
      optional("profile", form::text({"hv57"}),
               "`hv57` (Hufnagel-Valley), or a CSV file of height_m, cn2."),
      optional("high_wind_m_per_s", form::number(0.0, 200.0),
               "Rms wind at 5 to 20 km, of `hv57` [m/s].", "21"),
      optional("ground_cn2", form::number(0.0, 1e-10), "Cn2 at the ground, of `hv57` [m^-2/3].",
               "1.7e-14"),
      optional("ground_wind_m_per_s", form::number(0.0, 200.0), "Wind at the ground [m/s].", "5"),
      optional("jet_wind_m_per_s", form::number(0.0, 200.0), "Wind of the jet stream [m/s].",
               "30")};
}

const Section& turbulence_section() {
  static const Section section{"turbulence", "The turbulence of the air, by height.",
                               turbulence_keys()};
  return section;
}

const Section& atmosphere_section() {
  static const Section section{
      "atmosphere",
      "What the air does to light.",
      {optional("extinction", form::number(0.0, 5.0) | form::text(extinction_site_names()),
                "A site's curve, or k at 550 nm [mag/airmass].", "0.17"),
       optional("refraction", form::flag(),
                "Whether the air bends light. The plan decides if not given."),
       optional("turbulence", form::choice({"hv57"}) | form::map(turbulence_section),
                "Turbulence over the site, for scintillation.")}};
  return section;
}

const Section& clouds_section() {
  static const Section section{
      "clouds",
      "Clouds: a veil of one transmission, or patches that the wind carries.",
      {optional("cover", share(), "Share of the sky that patches cover. Without it: a veil."),
       optional("transmission", share(), "Of a veil, or of the middle of a patch at the zenith.",
                "0.1"),
       optional("patch_m", form::number(10.0, 1e6), "Size of the largest patches [m].", "3000"),
       optional("height_m", form::number(10.0, 20e3), "Height above the site [m].", "3000"),
       optional("wind_east_m_per_s", form::number(-200.0, 200.0), "Wind towards east [m/s].", "8"),
       optional("wind_north_m_per_s", form::number(-200.0, 200.0), "Wind towards north [m/s].",
                "0"),
       optional("seed", form::integer(0, most_seed), "Seed of the pattern.", "1")}};
  return section;
}

const Section& weather_section() {
  static const Section section{
      "weather",
      "The weather at the site. Without pressure a standard atmosphere by height is taken.",
      {optional("pressure_hpa", form::number(0.0, 1100.0), "Air pressure [hPa]."),
       optional("temperature_c", form::number(-90.0, 60.0), "Air temperature [deg C]."),
       optional("humidity", share(), "Relative humidity."),
       optional("clouds", share() | form::map(clouds_section),
                "Transmission of a veil, or clouds."),
       optional("pwv_mm", form::number(0.0, 100.0),
                "Precipitable water [mm]; with it water vapour and oxygen absorb in their bands.",
                "as measured in the extinction curve, to 1.1 um")}};
  return section;
}

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
  const double zenith = value.number();
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
  YamlMap map(value, lamps_section());
  LampMix lamps{.lps = map.number_or("lps", 0.0),
                .hps = map.number_or("hps", 0.0),
                .led = map.number_or("led", 0.0)};
  map.done();
  if (lamps.lps + lamps.hps + lamps.led <= 0) value.fail("one share must be > 0", false);
  return lamps;
}

CityGlow read_city(const YamlValue& value) {
  YamlMap map(value, city_section());
  CityGlow city;
  city.azimuth_rad = map.number("azimuth_deg") * deg;
  if (const auto width = map.find("half_width_deg")) city.half_width_rad = width->number() * deg;
  if (const auto height = map.find("height_deg")) city.height_rad = height->number() * deg;
  city.horizon_over_zenith = map.number_or("horizon_over_zenith", city.horizon_over_zenith);
  map.done();
  return city;
}

void read_parts(const YamlValue& value, SkyParts& parts) {
  YamlMap map(value, parts_section());
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
  SkyPartEffects::for_each(
      [&]<class Part>() { switch_part(Part::facts.name, parts.*sky_part<Part>); });
  map.done();
}

SkyConfig read_sky(const YamlValue& value) {
  if (is_number(value)) return one_brightness(value.number());
  if (value.is_scalar()) return sky_preset(value.choice());
  YamlMap map(value, sky_section());
  const auto zenith = map.find("zenith_mag_per_arcsec2");
  const auto preset = map.find("preset");
  if (!preset) {
    const double figure = map.number("zenith_mag_per_arcsec2");
    map.done();
    return one_brightness(figure);
  }
  SkyConfig sky = sky_preset(preset->choice());
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
    sky.parts.airglow->zenith_v_mag_per_arcsec2 = airglow->number();
  }
  if (const auto flux = map.find("solar_flux_sfu")) {
    if (!sky.parts.airglow) flux->fail("there is no airglow in this sky", false);
    sky.parts.airglow->solar_flux_sfu = flux->number();
  }
  map.done();
  return sky;
}

TurbulenceProfile read_profile(YamlMap& map) {
  const auto profile = map.require("profile");
  const HufnagelValley usual;
  if (profile.text() == "hv57")
    return HufnagelValley{map.number_or("high_wind_m_per_s", usual.high_wind_m_per_s),
                          map.number_or("ground_cn2", usual.ground_cn2)};
  const std::string path = find_beside(profile.text(), profile.file());
  if (path.empty()) profile.fail("must be hv57 or the path of a CSV file of height_m, cn2");
  return parse_cn2(read_text_file(path, 4u << 20), path);
}

TurbulenceConfig read_turbulence_keys(YamlMap& map) {
  const TurbulenceWind usual;
  TurbulenceConfig config{.profile = read_profile(map), .wind = {}};
  config.wind.ground_m_per_s = map.number_or("ground_wind_m_per_s", usual.ground_m_per_s);
  config.wind.jet_m_per_s = map.number_or("jet_wind_m_per_s", usual.jet_m_per_s);
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

AtmosphereConfig read_atmosphere(const YamlValue& value, AtmosphereConfig known) {
  YamlMap map(value, atmosphere_section());
  if (const auto extinction = map.find("extinction")) {
    if (is_number(*extinction)) {
      known = standard_atmosphere(extinction->number());
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
  map.done();
  return known;
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
  p.transmission = map.number_or("transmission", p.transmission);
  p.patch_m = map.number_or("patch_m", p.patch_m);
  p.height_m = map.number_or("height_m", p.height_m);
  p.wind_east_m_per_s = map.number_or("wind_east_m_per_s", p.wind_east_m_per_s);
  p.wind_north_m_per_s = map.number_or("wind_north_m_per_s", p.wind_north_m_per_s);
  p.seed = std::uint64_t(map.integer_or("seed", 1));
  map.done();
  return p;
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

std::vector<Key> surroundings_keys() {
  return {optional("sky", brightness() | sky_names() | form::map(sky_section),
                   "Light of the sky: a brightness [V mag/arcsec^2], a preset, or parts.",
                   "dark on the ground, space in orbit"),
          optional("atmosphere", form::map(atmosphere_section), "The air, on the ground."),
          optional("weather", form::map(weather_section), "The weather, on the ground.")};
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
                    "Wind that carries the turbulence past the pupil [m/s].", "10"),
           optional("wind_direction_deg", form::number(-360.0, 360.0),
                    "Direction of the wind across the image [deg].", "0")},
          turbulence_keys())};
  return section;
}

SensorSeeing read_seeing(const YamlValue& value, double airmass) {
  constexpr double wavelength_m = 500 * nm;  // of `SensorSeeing::r0_m`
  YamlMap map(value, seeing_section());
  SensorSeeing seeing;
  if (map.find("profile")) {
    const TurbulenceConfig over = read_turbulence_keys(map);
    const Turbulence t = turbulence(over.profile, wavelength_m, airmass, over.wind);
    seeing.r0_m = t.r0_m;
    seeing.wind_m_per_s = t.wind_m_per_s;
  } else {
    seeing.r0_m = map.number("r0_m");
    seeing.wind_m_per_s = map.number_or("wind_m_per_s", 10.0);
  }
  if (const auto v = map.find("outer_scale_m")) seeing.outer_scale_m = v->number();
  seeing.wind_direction_deg = map.number_or("wind_direction_deg", 0.0);
  map.done();
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
