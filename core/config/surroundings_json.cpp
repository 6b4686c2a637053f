#include "core/config/surroundings_json.h"

#include <type_traits>

namespace dmise {
namespace {

void write_sky(JsonWriter& json, const SkyConfig& sky) {
  json.key("sky").begin_object().field("preset", sky.preset);
  json.field("zenith_mag_per_arcsec2", sky.zenith_mag_per_arcsec2);
  const SkyParts& p = sky.parts;
  std::vector<std::string_view> parts;
  if (p.uniform) parts.push_back("uniform");
  SkyPartEffects::for_each([&]<class Part>() {
    if (p.*sky_part<Part> && !std::is_same_v<Part, ThermalSky> && !std::is_same_v<Part, Daylight>)
      parts.push_back(Part::facts.name);
  });
  json.list("parts", parts);
  // Scenarios from before the thermal sky keep their digests.
  if (!p.thermal_sky && !sky.preset.empty() && sky.preset != "space")
    json.field("thermal_sky", false);
  // Skies have daylight and twilight or none unless a scenario says so: older digests stay.
  if (p.daylight.has_value() != p.twilight.has_value())
    json.field("daylight", p.daylight.has_value());
  if (p.airglow) json.field("airglow", p.airglow->zenith_v_mag_per_arcsec2);
  if (p.airglow && p.airglow->solar_flux_sfu)
    json.field("solar_flux_sfu", *p.airglow->solar_flux_sfu);
  if (p.light_pollution) {
    const LightPollution& l = *p.light_pollution;
    json.key("light_pollution").begin_object();
    json.field("zenith_mag_per_arcsec2", l.zenith_v_mag_per_arcsec2);
    json.list("lamps", {l.lamps.lps, l.lamps.hps, l.lamps.led});
    json.key("cities").begin_array();
    for (const CityGlow& c : l.cities) {
      json.begin_object();
      json.list("glow", {c.azimuth_rad, c.half_width_rad, c.height_rad, c.horizon_over_zenith});
      json.end_object();
    }
    json.end_array().end_object();
  }
  json.end_object();
}

struct CloudWriter {
  JsonWriter& json;
  void operator()(const UniformCloud& veil) const { json.field("clouds", veil.transmission); }
  void operator()(const PatchyClouds& p) const {
    json.key("clouds").begin_object().field("seed", p.seed);
    json.list("pattern", {p.cover, p.transmission, p.patch_m, p.height_m, p.wind_east_m_per_s,
                          p.wind_north_m_per_s});
    json.end_object();
  }
};

struct ProfileWriter {
  JsonWriter& json;
  void operator()(const HufnagelValley& p) const {
    json.list("hufnagel_valley", {p.high_wind_m_per_s, p.ground_cn2});
  }
  void operator()(const Cn2Table& table) const {
    json.list("height_m", table.height_m);
    json.list("cn2", table.cn2);
  }
};

}  // namespace

void write_curve(JsonWriter& json, std::string_view key, const Curve& curve) {
  if (curve.empty()) return;
  json.key(key).begin_object();
  json.list("wavelength_m", curve.wavelength_m);
  json.list("value", curve.value);
  json.end_object();
}

void write_surroundings(JsonWriter& json, const SensorConfig& sensor) {
  write_sky(json, sensor.sky);
  if (!std::holds_alternative<SiteConfig>(sensor.place)) return;
  const AtmosphereConfig& a = sensor.atmosphere;
  json.key("atmosphere").begin_object().field("extinction", a.extinction);
  write_curve(json, "extinction_mag_per_airmass", a.extinction_mag_per_airmass);
  if (a.turbulence) {
    json.key("turbulence").begin_object();
    std::visit(ProfileWriter{json}, a.turbulence->profile);
    const TurbulenceWind& wind = a.turbulence->wind;
    json.list("wind_m_per_s", {wind.ground_m_per_s, wind.jet_m_per_s});
    json.end_object();
  }
  if (a.aerosol_optical_depth) json.field("aerosol_optical_depth", *a.aerosol_optical_depth);
  if (a.angstrom_exponent) json.field("angstrom_exponent", *a.angstrom_exponent);
  if (a.ground_albedo) json.field("ground_albedo", *a.ground_albedo);
  json.end_object();
  const WeatherConfig& w = sensor.weather;
  json.key("weather").begin_object();
  if (w.air) json.list("air", {w.air->pressure_hpa, w.air->temperature_c, w.air->humidity});
  if (w.pwv_mm) json.field("pwv_mm", *w.pwv_mm);
  if (w.clouds) std::visit(CloudWriter{json}, *w.clouds);
  json.end_object();
}

}  // namespace dmise
