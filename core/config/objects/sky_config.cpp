#include "core/config/objects/sky_config.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/sky/air/infrared_gases.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

Forms brightness() { return form::number(-10.0, 30.0); }
Forms sky_share() { return form::number(0.0, 1.0); }
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
       optional("daylight", form::flag(), "Sunlight scattered by the air by day."),
       optional("light_pollution", form::flag(), "Light of lamps scattered by the air."),
       optional("thermal_sky", form::flag(), "Heat of the air, in bands beyond 1.9 um.")}};
  return section;
}

const Section& lamps_section() {
  static const Section section{"lamps",
                               "Shares of lamps in the light pollution; one must be above 0.",
                               {optional("lps", sky_share(), "Low-pressure sodium.", "0"),
                                optional("hps", sky_share(), "High-pressure sodium.", "0"),
                                optional("led", sky_share(), "White LED.", "0")}};
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
       bound<&CityGlow::horizon_over_zenith>(
           "horizon_over_zenith", form::number(0.0, 1e4),
           "Its peak, in units of the zenith's even light pollution.")}};
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

SkyConfig one_brightness(double v_mag_per_arcsec2) {
  SkyConfig sky{.zenith_mag_per_arcsec2 = v_mag_per_arcsec2};
  sky.parts.uniform = UniformSky{v_mag_per_arcsec2};
  return sky;
}

/// Adds lamps that bring the zenith to `zenith` together with the natural sky.
void read_zenith(const YamlValue& value, SkyConfig& sky) {
  const double zenith = value.number();
  sky.zenith_mag_per_arcsec2 = zenith;
  if (sky.preset == "space") {
    sky.parts = {.uniform = UniformSky{zenith}};
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
  LampMix lamps{.lps = map.number("lps"), .hps = map.number("hps"), .led = map.number("led")};
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
  read_bound(map, city);
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
  if (value.is_like_number()) return one_brightness(value.number());
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

}  // namespace

SkyConfig sky_preset(const std::string& name) {
  return {.preset = name,
          .parts = sky_parts_named(name).value(),
          .zenith_mag_per_arcsec2 = zenith_brightness_named(name).value()};
}

std::vector<Key> surroundings_keys() {
  return {
      optional("sky", brightness() | sky_names() | form::map(sky_section),
               "Light of the sky: one brightness everywhere [V mag/arcsec^2], a preset, or parts.",
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

void check_sky_in_band(const YamlValue& where, const SkyConfig& sky, const Band& band, bool in_air,
                       bool knows_water) {
  if (in_air && sky.parts.thermal_sky && band.high_m() > infrared_to_m)
    where.fail(
        formatted("the sky can't be drawn in this band: the air's heat is known to %g um, the "
                  "band reaches to %g um",
                  infrared_to_m / um, band.high_m() / um),
        false);
  if (in_air && sky.parts.thermal_sky && !knows_water && band.high_m() > infrared_from_m)
    where.fail(
        "the sky can't be drawn in this band: beyond 2.5 um the air absorbs and glows by its "
        "water vapour, which weather: {pwv_mm: ..} gives",
        false);
  try {
    SkyModel(sky.parts, SkyScene{.in_air = in_air}, band, Curve{});
  } catch (const Error& e) {
    where.fail(std::string("the sky can't be drawn in this band: ") + e.what(), false);
  }
}

}  // namespace dmise
