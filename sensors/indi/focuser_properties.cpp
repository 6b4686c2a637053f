#include <algorithm>
#include <cmath>

#include "sensors/indi/property_items.h"

namespace dmise {
namespace {

using Call = IndiCall;
using Given = IndiGiven;
using Devices = Observatory::Devices;

IndiRange focus_range(const Devices& d) {
  return {"%.f", 0.0, double(d.focuser.max_step()), 100.0};
}

IndiReading focus_position(const Call& c) {
  return c.of([](const Devices& d) {
    const bool moves = d.focuser.is_moving(d.now);
    return IndiReading{{number_item("FOCUS_ABSOLUTE_POSITION", "Steps", d.focuser.position(d.now),
                                    focus_range(d))},
                       moves ? IndiState::busy : IndiState::ok};
  });
}

void set_focus_position(const Call& c, const Given& given) {
  const int to = int(std::lround(given.number("FOCUS_ABSOLUTE_POSITION")));
  c.on([&](const Devices& d) { d.focuser.move_to(to, d.now); });
}

IndiReading focus_step(const Call& c) {
  return c.of([](const Devices& d) {
    IndiReading reading{{number_item("FOCUS_RELATIVE_POSITION", "Steps", 0.0, focus_range(d))}};
    if (d.focuser.is_moving(d.now)) reading.state = IndiState::busy;
    return reading;
  });
}

/// It goes to its end if it is sent beyond.
void focus_by(const Call& c, const Given& given) {
  const int by = int(std::lround(given.number("FOCUS_RELATIVE_POSITION")));
  c.on([&](const Devices& d) {
    const int to = d.focuser.position(d.now) + (c.session.outward ? by : -by);
    d.focuser.move_to(std::clamp(to, 0, d.focuser.max_step()), d.now);
  });
}

IndiReading focus_direction(const Call& c) {
  return {{switch_item("FOCUS_INWARD", "Focus In", !c.session.outward),
           switch_item("FOCUS_OUTWARD", "Focus Out", c.session.outward)}};
}

IndiReading focus_max(const Call& c) {
  return c.of([](const Devices& d) {
    return IndiReading{
        {number_item("FOCUS_MAX_VALUE", "Steps", d.focuser.max_step(), {"%.f", 0.0, 1e5})}};
  });
}

IndiReading focus_temperature(const Call& c) {
  const double ambient_c = c.of([](const Devices& d) { return d.camera.ambient_c(); });
  return {{number_item("TEMPERATURE", "Celsius", ambient_c, {"%6.2f", -100.0, 100.0})}};
}

}  // namespace

const std::vector<IndiProperty>& indi_focuser_properties() {
  static const std::vector<IndiProperty> properties{
      {one_of("FOCUS_MOTION", "Direction", main_group), focus_direction,
       [](const Call& c, const Given& given) {
         c.session.outward = given.chosen == "FOCUS_OUTWARD";
       }},
      {numbers("REL_FOCUS_POSITION", "Relative Position", main_group), focus_step, focus_by},
      {numbers("ABS_FOCUS_POSITION", "Absolute Position", main_group), focus_position,
       set_focus_position},
      {numbers("FOCUS_MAX", "Max. Position", main_group), focus_max},
      {at_most_one("FOCUS_ABORT_MOTION", "Abort Motion", main_group),
       [](const Call&) { return button("ABORT", "Abort"); },
       [](const Call& c, const Given&) { c.on([](const Devices& d) { d.focuser.halt(d.now); }); }},
      {numbers("FOCUS_TEMPERATURE", "Temperature", main_group), focus_temperature}};
  return properties;
}

}  // namespace dmise
