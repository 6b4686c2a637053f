#include <algorithm>
#include <cctype>
#include <utility>

#include "sensors/alpaca/alpaca_devices.h"

namespace dmise {
namespace {

using Call = MemberCall;
using Devices = Observatory::Devices;

/// What is measured: its name in the API, in `DeviceState`, and what measures it.
struct Measured {
  const char* name;
  const char* title;
  const char* sensor;
  std::optional<double> (*value)(const SiteConditions&);  // null: nothing measures it
};

constexpr double percent = 100.0;

constexpr Measured measured[] = {
    {"cloudcover", "CloudCover", "share of starlight that clouds keep out [%]",
     [](const SiteConditions& c) { return std::optional(c.cloud_cover_percent); }},
    {"dewpoint", "DewPoint", "dew point of the scenario's air [C]",
     [](const SiteConditions& c) { return std::optional(c.dew_point_c); }},
    {"humidity", "Humidity", "relative humidity of the scenario's air [%]",
     [](const SiteConditions& c) { return std::optional(percent * c.air.humidity); }},
    {"pressure", "Pressure", "pressure of the air at the site [hPa]",
     [](const SiteConditions& c) { return std::optional(c.air.pressure_hpa); }},
    {"rainrate", "RainRate", nullptr, nullptr},
    {"skybrightness", "SkyBrightness", "light of the sky on level ground [lux]",
     [](const SiteConditions& c) { return std::optional(c.sky_lux); }},
    {"skyquality", "SkyQuality", "V brightness of the zenith [mag/arcsec2]",
     [](const SiteConditions& c) { return c.sky_mag_per_arcsec2; }},
    {"skytemperature", "SkyTemperature", nullptr, nullptr},
    {"starfwhm", "StarFWHM", "width of stars by the scenario's turbulence at 0.5 um [arcsec]",
     [](const SiteConditions& c) { return c.star_fwhm_arcsec; }},
    {"temperature", "Temperature", "temperature of the scenario's air [C]",
     [](const SiteConditions& c) { return std::optional(c.air.temperature_c); }},
    {"winddirection", "WindDirection", nullptr, nullptr},
    {"windgust", "WindGust", nullptr, nullptr},
    {"windspeed", "WindSpeed", "wind at the ground of the scenario's turbulence [m/s]",
     [](const SiteConditions& c) { return c.wind_m_per_s; }}};

std::optional<double> value_of(const Call& c, const Measured& m) {
  if (!m.value) return std::nullopt;
  return c.of([&](const Devices& d) { return m.value(d.weather.conditions(d.now)); });
}

template <std::size_t index>
MemberAnswer measurement(const Call& c) {
  const auto value = value_of(c, measured[index]);
  return value ? answer_of(*value) : not_there(c);
}

template <std::size_t... indices>
std::vector<Member> measurements(std::index_sequence<indices...>) {
  return {Member{measured[indices].name, measurement<indices>}...};
}

MemberAnswer conditions_state(const Call& c) {
  StateItems items;
  for (const Measured& m : measured)
    if (const auto value = value_of(c, m)) items.add(m.title, *value);
  return items.take();
}

/// The sensor that a call names; null for none, which is the latest. Refuses unknown ones.
const Measured* sensor_named(const Call& c) {
  std::string name = c.given.text("SensorName");
  std::ranges::transform(name, name.begin(), [](unsigned char x) { return char(std::tolower(x)); });
  if (name.empty()) return nullptr;
  const auto found = std::ranges::find(measured, name, &Measured::name);
  if (found == std::end(measured)) refuse_value("there is no sensor of this name");
  return found;
}

std::vector<Member> instruments() {
  return {{"averageperiod", [](const Call&) { return answer_of(0.0); },
           [](const Call& c) {
             if (c.given.number("AveragePeriod") != 0.0)
               refuse_value("AveragePeriod must be 0: values are of the moment");
             return MemberAnswer{};
           }},
          {"devicestate", conditions_state},
          {"refresh", nullptr,
           [](const Call& c) {
             c.on([](const Devices& d) { d.weather.refresh(d.now); });
             return MemberAnswer{};
           }},
          {"sensordescription",
           [](const Call& c) {
             const Measured* m = sensor_named(c);
             if (!m) refuse_value("SensorName must name one");
             return m->sensor ? answer_of(std::string(m->sensor)) : not_there(c);
           }},
          {"timesincelastupdate", [](const Call& c) {
             const Measured* m = sensor_named(c);
             if (m && !m->value) return not_there(c);
             return answer_of(c.of([](const Devices& d) { return d.weather.age_s(d.now); }));
           }}};
}

}  // namespace

const std::vector<Member>& observing_conditions_members() {
  static const std::vector<Member> members = [] {
    std::vector<Member> all = measurements(std::make_index_sequence<std::size(measured)>());
    const auto more = instruments();
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return members;
}

}  // namespace dmise
