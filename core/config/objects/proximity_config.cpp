#include "core/config/objects/proximity_config.h"

#include <algorithm>
#include <variant>

#include "core/base/files/json.h"
#include "core/base/units.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/vector_values.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

constexpr double farthest_relative_m = 1e6;
constexpr double fastest_m_per_s = 1e3;
constexpr double min_distance_m = 1e-3;  // a forced path comes no nearer to the chief
constexpr double longest_wait_s = 3.2e8;

Forms place_rtn() { return form::numbers(3, -farthest_relative_m, farthest_relative_m); }
Forms phase() { return form::number(-360.0, 360.0); }

const Section& natural_section() {
  static const Section section{
      "natural",
      "Free motion from a state at the start of the run, in the chief's radial, transverse and "
      "normal axes.",
      {required("position_rtn_m", place_rtn(), "Place relative to the chief [m]."),
       required("velocity_rtn_m_per_s", form::numbers(3, -fastest_m_per_s, fastest_m_per_s),
                "Velocity seen in the axes, which turn with the chief [m/s]."),
       bound<&NaturalMotion::dynamics>(
           "dynamics", form::choice({"two_body", "clohessy_wiltshire"}),
           "`two_body`: difference of two conics, for any distance and eccentricity; "
           "`clohessy_wiltshire`: the first order of it about a circle.")}};
  return section;
}

const Section& circumnavigation_section() {
  static const Section section{
      "circumnavigation",
      "An ellipse about the chief, twice as long along its orbit as it is high, once round in a "
      "revolution: free motion by Clohessy and Wiltshire.",
      {required("radial_m", form::number(0.0, farthest_relative_m), "Semi-axis up and down [m]."),
       optional("phase_deg", phase(),
                "Phase at the start of the run [deg]: 0 is ahead of the chief, 90 above it.", "0"),
       bound<&Circumnavigation::normal_m>("normal_m", form::number(0.0, farthest_relative_m),
                                          "Semi-axis out of the orbit's plane [m]."),
       optional("normal_phase_deg", phase(), "Phase of that at the start of the run [deg].", "0"),
       bound<&Circumnavigation::centre_transverse_m>(
           "centre_transverse_m", form::number(-farthest_relative_m, farthest_relative_m),
           "Its centre ahead of the chief [m].")}};
  return section;
}

const Section& approach_section() {
  static const Section section{
      "approach",
      "Holds a place, moves on a straight line to another, and holds that: forced, along V-bar, "
      "R-bar or any other line.",
      {required("from_rtn_m", place_rtn(), "Place until the approach [m]."),
       required("to_rtn_m", place_rtn(), "Place after it [m]."),
       required("speed_m_per_s", form::above(0.0, fastest_m_per_s), "Its speed [m/s]."),
       bound<&ForcedApproach::at_s>("at_s", form::number(-longest_wait_s, longest_wait_s),
                                    "When it begins, since the start of the run [s].")}};
  return section;
}

NaturalMotion read_natural(const YamlValue& value) {
  YamlMap map(value, natural_section());
  NaturalMotion motion;
  motion.start = {vector_of<Rtn>(map.require("position_rtn_m")),
                  vector_of<Rtn>(map.require("velocity_rtn_m_per_s"))};
  read_bound(map, motion);
  map.done();
  return motion;
}

Circumnavigation read_circumnavigation(const YamlValue& value) {
  YamlMap map(value, circumnavigation_section());
  Circumnavigation motion{.radial_m = map.number("radial_m")};
  read_bound(map, motion);
  motion.phase_rad = map.number("phase_deg") * deg;
  motion.normal_phase_rad = map.number("normal_phase_deg") * deg;
  map.done();
  if (!(motion.radial_m > 0 || motion.normal_m > 0))
    value.fail("needs a radial_m or a normal_m above 0", false);
  return motion;
}

/// Least distance of the path from the chief [m].
double min_distance(const ForcedApproach& motion) {
  const Vec<Rtn> line = motion.to_m - motion.from_m;
  const double length2 = dot(line, line);
  const double part = length2 > 0 ? std::clamp(-dot(motion.from_m, line) / length2, 0.0, 1.0) : 0.0;
  return norm(motion.from_m + line * part);
}

ForcedApproach read_approach(const YamlValue& value) {
  YamlMap map(value, approach_section());
  ForcedApproach motion{.from_m = vector_of<Rtn>(map.require("from_rtn_m")),
                        .to_m = vector_of<Rtn>(map.require("to_rtn_m")),
                        .speed_m_per_s = map.number("speed_m_per_s")};
  read_bound(map, motion);
  map.done();
  if (min_distance(motion) < min_distance_m) value.fail("leads through the chief", false);
  return motion;
}

ForcedApproach read_hold(const YamlValue& value) {
  const auto place_m = vector_of<Rtn>(value);
  if (norm(place_m) < min_distance_m) value.fail("is the place of the chief", false);
  return {.from_m = place_m, .to_m = place_m};
}

void write(JsonWriter& json, const NaturalMotion& m) {
  const auto &r = m.start.position_m, v = m.start.velocity_m_per_s;
  json.list("natural", {r.x, r.y, r.z, v.x, v.y, v.z, double(m.dynamics)});
}
void write(JsonWriter& json, const Circumnavigation& m) {
  json.list("circumnavigation",
            {m.radial_m, m.normal_m, m.phase_rad, m.normal_phase_rad, m.centre_transverse_m});
}
void write(JsonWriter& json, const ForcedApproach& m) {
  json.list("approach", {m.from_m.x, m.from_m.y, m.from_m.z, m.to_m.x, m.to_m.y, m.to_m.z,
                         m.speed_m_per_s, m.at_s});
}

}  // namespace

const Section& proximity_section() {
  static const Section section{
      "proximity",
      "Motion near another object, the chief, in its radial (up), transverse (ahead) and normal "
      "axes. One of `natural`, `circumnavigation`, `hold_rtn_m`, `approach`.",
      {required("of", form::text(), "Name or number of the chief, an object of the scenario."),
       optional("natural", form::map(natural_section), "Free motion from a state."),
       optional("circumnavigation", form::map(circumnavigation_section),
                "Free motion on an ellipse about it."),
       optional("hold_rtn_m", place_rtn(), "Stays at this place [m], forced."),
       optional("approach", form::map(approach_section), "Moves on a straight line, forced.")}};
  return section;
}

ProximityConfig read_proximity(const YamlValue& value) {
  YamlMap map(value, proximity_section());
  const auto of = map.require("of");
  const auto natural = map.find("natural"), ellipse = map.find("circumnavigation"),
             hold = map.find("hold_rtn_m"), approach = map.find("approach");
  map.done();
  if (map.keys().size() != 2)
    value.fail("give one of natural, circumnavigation, hold_rtn_m, approach", false);
  ProximityConfig config{
      .chief = of.text(), .motion = {}, .where = value.place(), .chief_where = of.place()};
  if (natural) config.motion = read_natural(*natural);
  if (ellipse) config.motion = read_circumnavigation(*ellipse);
  if (hold) config.motion = read_hold(*hold);
  if (approach) config.motion = read_approach(*approach);
  return config;
}

void write_proximity(JsonWriter& json, const ProximityConfig& proximity) {
  json.key("proximity").begin_object().field("of", proximity.chief);
  std::visit([&](const auto& motion) { write(json, motion); }, proximity.motion);
  json.end_object();
}

}  // namespace dmise
