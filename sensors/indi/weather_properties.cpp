#include "sensors/indi/property_items.h"

namespace dmise {
namespace {

using Call = IndiCall;
using Given = IndiGiven;
using Devices = Observatory::Devices;

constexpr double percent = 100.0;

IndiReading weather_parameters(const Call& c) {
  const SiteConditions now = c.of([](const Devices& d) { return d.weather.conditions(d.now); });
  const IndiRange share{"%.1f", 0.0, 100.0, 0.0, 0.1}, celsius{"%.1f", -150.0, 200.0, 0.0, 0.05};
  IndiReading reading{
      {number_item("WEATHER_TEMPERATURE", "Temperature (C)", now.air.temperature_c, celsius),
       number_item("WEATHER_HUMIDITY", "Humidity (%)", percent * now.air.humidity, share),
       number_item("WEATHER_PRESSURE", "Pressure (hPa)", now.air.pressure_hpa,
                   {"%.1f", 0.0, 10000.0, 0.0, 0.05}),
       number_item("WEATHER_DEWPOINT", "Dew point (C)", now.dew_point_c, celsius),
       number_item("WEATHER_CLOUD_COVER", "Clouds (%)", now.cloud_cover_percent, share)}};
  const auto add = [&](const char* name, const char* label, const std::optional<double>& value,
                       const IndiRange& range) {
    if (value) reading.items.push_back(number_item(name, label, *value, range));
  };
  add("WEATHER_SKY_QUALITY", "Sky (mag/arcsec2)", now.sky_mag_per_arcsec2,
      {"%.2f", -30.0, 30.0, 0.0, 0.01});
  add("WEATHER_SEEING", "Seeing (arcsec)", now.star_fwhm_arcsec, {"%.2f", 0.0, 100.0, 0.0, 0.01});
  add("WEATHER_WIND_SPEED", "Wind (km/h)",
      now.wind_m_per_s ? std::optional(*now.wind_m_per_s * 3.6) : std::nullopt,
      {"%.1f", 0.0, 1000.0, 0.0, 0.1});
  reading.state = IndiState::ok;
  return reading;
}

IndiReading weather_period(const Call&) {
  return {{number_item("PERIOD", "Period (s)", WeatherStation::every_s, {"%.f", 0.0, 3600.0})}};
}

}  // namespace

const std::vector<IndiProperty>& indi_weather_properties() {
  static const std::vector<IndiProperty> properties{
      {numbers("WEATHER_PARAMETERS", "Parameters", "Parameters"), weather_parameters},
      {numbers("WEATHER_UPDATE", "Update", main_group), weather_period},
      {at_most_one("WEATHER_REFRESH", "Refresh", main_group),
       [](const Call&) { return button("REFRESH", "Refresh"); },
       [](const Call& c, const Given&) {
         c.on([](const Devices& d) { d.weather.refresh(d.now); });
       }}};
  return properties;
}

}  // namespace dmise
