#include "core/config/sensors/thermal_optics_config.h"

#include "core/config/yaml/bound_key.h"

namespace dmise {
namespace {

Forms celsius() { return form::number(-273.15, 200.0); }
Forms share() { return form::number(0.0, 1.0); }

}  // namespace

const Section& thermal_optics_section() {
  static const Section section{
      "emission",
      "Heat of the telescope and the window as the detector sees it: behind a cold stop, the beam "
      "alone.",
      {bound<&ThermalOptics::emissivity>(
           "emissivity", share(),
           "Emissivity of all mirrors and lenses together, before the transmission."),
       bound<&ThermalOptics::temperature_c>(
           "temperature_c", celsius(), "Their temperature [deg C].", "the air's; needed in space"),
       bound<&ThermalOptics::window_emissivity>("window_emissivity", share(),
                                                "Emissivity of the camera's window."),
       bound<&ThermalOptics::window_temperature_c>("window_temperature_c", celsius(),
                                                   "Its temperature [deg C].",
                                                   "the air's; needed in space")}};
  return section;
}

ThermalOptics read_thermal_optics(const YamlValue& value) {
  YamlMap map(value, thermal_optics_section());
  ThermalOptics optics;
  read_bound(map, optics);
  map.done();
  if (!optics.any()) value.fail("needs emissivity or window_emissivity above 0", false);
  return optics;
}

void check_warm_in_space(const YamlValue& camera, const ThermalOptics& optics) {
  const auto check = [&](double emissivity, bool known, const char* key) {
    if (emissivity > 0.0 && !known)
      camera.fail(std::string("optics.emission needs ") + key +
                      " aboard an object, where no air "
                      "gives it",
                  false);
  };
  check(optics.emissivity, optics.temperature_c.has_value(), "temperature_c");
  check(optics.window_emissivity, optics.window_temperature_c.has_value(), "window_temperature_c");
}

void write_thermal_optics_json(JsonWriter& json, const ThermalOptics& optics) {
  if (!optics.any()) return;
  json.key("emission").begin_object();
  write_bound(json, thermal_optics_section(), optics);
  json.end_object();
}

}  // namespace dmise
