#include "core/config/exclusion_config.h"

#include <iterator>

#include "core/config/yaml_reader.h"

namespace dmise {
namespace {

struct Limit {
  const char* key;
  std::optional<double> Exclusion::*angle_deg;
  const char* what;
};
constexpr Limit limits[] = {
    {"sun_deg", &Exclusion::sun_deg,
     "Least angle of the optical axis from the Sun's centre [deg]."},
    {"moon_deg", &Exclusion::moon_deg,
     "Least angle of the optical axis from the Moon's centre [deg]."},
    {"earth_limb_deg", &Exclusion::earth_limb_deg,
     "Least angle of the optical axis above the nearest point of the Earth's limb [deg], in "
     "orbit."}};

}  // namespace

const Section& exclusion_section() {
  static const Section section = [] {
    Section made{"exclusion",
                 "How near bright bodies may be to the optical axis, and what happens in exposures "
                 "in which one is nearer. It takes one angle or more.",
                 {}};
    for (const Limit& limit : limits)
      made.keys.push_back(optional(limit.key, form::number(0.0, 180.0), limit.what));
    made.keys.push_back(optional(
        "action",
        form::choice({std::begin(exclusion_action_names), std::end(exclusion_action_names)}),
        "flag: the frame, its report and its detections say so. close_shutter: the frame is dark.",
        exclusion_action_names[0]));
    return made;
  }();
  return section;
}

Exclusion read_exclusion(const YamlValue& value) {
  YamlMap map(value, exclusion_section());
  Exclusion exclusion;
  for (const Limit& limit : limits)
    if (const auto angle = map.find(limit.key)) exclusion.*limit.angle_deg = angle->number();
  if (const auto action = map.find("action"))
    exclusion.action = action->chosen({ExclusionAction::flag, ExclusionAction::close_shutter});
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
  for (const Limit& limit : limits)
    if (const auto& angle_deg = exclusion.*limit.angle_deg) json.field(limit.key, *angle_deg);
  json.field("action", exclusion_action_names[std::size_t(exclusion.action)]).end_object();
}

}  // namespace dmise
