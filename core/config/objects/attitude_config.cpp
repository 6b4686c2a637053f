#include "core/config/objects/attitude_config.h"

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/config/yaml/vector_values.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/orbit/attitude_interpolation.h"
#include "core/orbit/attitude_table.h"

namespace dmise {
namespace {

constexpr double max_rpm = 6000.0;
constexpr double noted_deg = 0.1;  // least error between ticks that is warned of

const Section& inertial_section() {
  static const Section section{
      "inertial",
      "An attitude fixed relative to the stars.",
      {required("gcrs_from_body", form::quaternion(), "Unit quaternion [w, x, y, z].")}};
  return section;
}

const Section& spinning_section() {
  static const Section section{
      "spinning",
      "A body that turns about an axis of its own.",
      {optional("axis", form::direction(), "Axis in body axes.", "[0, 0, 1]"),
       required("rate_rpm", form::number(-max_rpm, max_rpm), "Rate [turns per minute]."),
       optional("phase_deg", form::number(-360.0, 360.0),
                "Rotation of the body at the start of the run [deg].", "0"),
       optional("gcrs_from_body", form::quaternion(),
                "Unit quaternion [w, x, y, z] without the phase.", "[1, 0, 0, 0]")}};
  return section;
}

const Section& tumbling_section() {
  static const Section section{
      "tumbling",
      "A rigid body that turns freely, without torque. Its axes are its principal axes.",
      {required("inertia_kg_m2", form::positive_numbers(3, 1e15),
                "Moments of inertia about x, y, z [kg m^2], none beyond the sum of the others. "
                "Only their ratios count."),
       required("rate_deg_per_s", form::numbers(3, -max_rpm * 6, max_rpm * 6),
                "Angular velocity about x, y, z at the start of the run [deg/s]."),
       optional("gcrs_from_body", form::quaternion(),
                "Unit quaternion [w, x, y, z] at the start of the run.", "[1, 0, 0, 0]")}};
  return section;
}

InertialAttitude read_inertial(const YamlValue& value) {
  YamlMap map(value, inertial_section());
  const InertialAttitude attitude{rotation_in<Gcrs, Body>(map.require("gcrs_from_body"))};
  map.done();
  return attitude;
}

SpinningAttitude read_spinning(const YamlValue& value) {
  YamlMap map(value, spinning_section());
  SpinningAttitude attitude;
  if (const auto axis = map.find("axis")) attitude.axis = direction_of<Body>(*axis);
  attitude.rate_rad_per_s = map.number("rate_rpm") * 2 * pi / 60;
  if (const auto start = map.find("gcrs_from_body"))
    attitude.gcrs_from_body = rotation_in<Gcrs, Body>(*start);
  const double phase_rad = map.number("phase_deg") * deg;
  map.done();
  // The phase is the rotation of the body at the start.
  SpinningAttitude turn{.axis = attitude.axis, .rate_rad_per_s = phase_rad};
  const auto ahead = gcrs_from_body(Attitude(turn), {.time_s = 1.0});
  Rotation<Body, Body> in_body;
  in_body.m = ahead.m;
  attitude.gcrs_from_body = attitude.gcrs_from_body * in_body;
  return attitude;
}

TumblingAttitude read_tumbling(const YamlValue& value) {
  YamlMap map(value, tumbling_section());
  const auto inertia = map.require("inertia_kg_m2");
  const auto moments_kg_m2 = vector_of<Body>(inertia);
  const auto rate_rad_per_s = vector_of<Body>(map.require("rate_deg_per_s")) * deg;
  TumblingAttitude attitude;
  if (const auto start = map.find("gcrs_from_body"))
    attitude.gcrs_from_body = rotation_in<Gcrs, Body>(*start);
  map.done();
  if (!is_inertia(moments_kg_m2))
    inertia.fail("no body has these moments: one is beyond the sum of the others", false);
  attitude.rotation = TorqueFreeRotation(moments_kg_m2, rate_rad_per_s);
  return attitude;
}

}  // namespace

const Section& attitude_section() {
  static const Section section{
      "attitude",
      "How an object is turned; one of these.",
      {optional("inertial", form::map(inertial_section), "Fixed relative to the stars."),
       optional("spinning", form::map(spinning_section), "Turns about an axis of its own."),
       optional("tumbling", form::map(tumbling_section), "Turns freely, without torque."),
       optional("table", form::text(), "A CSV file of time_s, w, x, y, z over the whole run."),
       optional("node", form::text(), "A node of `nodes` says how it is turned at every tick.")}};
  return section;
}

Forms attitude_forms() {
  return form::choice({"nadir", "sun_tracking"}) | form::map(attitude_section);
}

AttitudeConfig read_attitude(const YamlValue& value) {
  AttitudeConfig attitude{.model = {}, .where = value.place()};
  if (value.is_scalar()) {
    attitude.model = value.chosen<Attitude>({NadirAttitude{}, SunYawAttitude{}});
    return attitude;
  }
  YamlMap map(value, attitude_section());
  const auto inertial = map.find("inertial"), spinning = map.find("spinning"),
             tumbling = map.find("tumbling"), table = map.find("table"), node = map.find("node");
  map.done();
  if (map.keys().size() != 1)
    value.fail("give nadir, sun_tracking, or one of inertial, spinning, tumbling, table, node",
               false);
  if (inertial) attitude.model = read_inertial(*inertial);
  if (spinning) attitude.model = read_spinning(*spinning);
  if (tumbling) attitude.model = read_tumbling(*tumbling);
  if (table) {
    attitude.table_path = table->existing_file();
    attitude.model = read_attitude_table(attitude.table_path);
  }
  if (node) {
    attitude.node_where = node->place();
    attitude.model = NodeAttitude{.node = node->text()};
  }
  return attitude;
}

std::optional<std::string> coarse_tick_warning(const AttitudeConfig& attitude, double tick_s) {
  const auto* tumbling = std::get_if<TumblingAttitude>(&attitude.model);
  if (!tumbling) return std::nullopt;
  const double off_deg = worst_interpolation_rad(*tumbling, tick_s) / deg;
  if (off_deg <= noted_deg) return std::nullopt;
  return attitude.where +
         formatted(": between ticks it is up to %.2g deg off; a shorter tick_s lessens it",
                   off_deg);
}

}  // namespace dmise
