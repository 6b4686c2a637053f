#include "core/config/sensors/exclusion_config.h"

#include <iterator>

#include "core/config/yaml/bound_key.h"

namespace dmise {

const Section& exclusion_section() {
  static const Section section{
      "exclusion",
      "How near bright bodies may be to the optical axis, and what happens in exposures in which "
      "one is nearer. It takes one angle or more.",
      {bound<&Exclusion::sun_deg>("sun_deg", form::number(0.0, 180.0),
                                  "Least angle of the optical axis from the Sun's centre [deg]."),
       bound<&Exclusion::moon_deg>("moon_deg", form::number(0.0, 180.0),
                                   "Least angle of the optical axis from the Moon's centre [deg]."),
       bound<&Exclusion::earth_limb_deg>(
           "earth_limb_deg", form::number(0.0, 180.0),
           "Least angle of the optical axis above the nearest point of the Earth's limb [deg], in "
           "orbit."),
       bound<&Exclusion::action>(
           "action",
           form::choice({std::begin(exclusion_action_names), std::end(exclusion_action_names)}),
           "flag: the frame, its report and its detections say so. close_shutter: the frame is "
           "dark.")}};
  return section;
}

Exclusion read_exclusion(const YamlValue& value) {
  YamlMap map(value, exclusion_section());
  Exclusion exclusion;
  read_bound(map, exclusion);
  map.done();
  if (!exclusion.any()) value.fail("needs one of sun_deg, moon_deg or earth_limb_deg", false);
  return exclusion;
}

void check_exclusion_on_ground(const YamlValue& value, const Exclusion& exclusion) {
  if (!exclusion.earth_limb_deg) return;
  constexpr const char* why = "is for a sensor in orbit: on the ground there is no limb";
  if (value.is_map())
    if (const auto section = YamlMap(value).find("exclusion"))
      YamlMap(*section).require("earth_limb_deg").fail(why);
  value.fail(std::string("its exclusion.earth_limb_deg ") + why);  // in a file of its own
}

void write_exclusion_json(JsonWriter& json, const Exclusion& exclusion) {
  if (!exclusion.any()) return;
  json.key("exclusion").begin_object();
  write_bound(json, exclusion_section(), exclusion);
  json.end_object();
}

}  // namespace dmise
