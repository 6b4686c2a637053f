#include "sensors/indi/property_items.h"

namespace dmise {
namespace {

using Call = IndiCall;
using Given = IndiGiven;
using Devices = Observatory::Devices;

/// Parked it is closed.
IndiReading cover(const Call& c) {
  return c.of([](const Devices& d) {
    const bool opens = d.cover.is_going_to_open();
    const CoverState state = d.cover.state(d.now);
    return IndiReading{{switch_item("PARK", "Close", !opens), switch_item("UNPARK", "Open", opens)},
                       state == CoverState::moving    ? IndiState::busy
                       : state == CoverState::unknown ? IndiState::alert
                                                      : IndiState::ok};
  });
}

void set_cover(const Call& c, const Given& given) {
  c.on([&](const Devices& d) {
    given.chosen == "PARK" ? d.cover.close(d.now) : d.cover.open(d.now);
  });
}

}  // namespace

const std::vector<IndiProperty>& indi_cover_properties() {
  static const std::vector<IndiProperty> properties{
      {one_of("CAP_PARK", "Cover", main_group), cover, set_cover},
      {at_most_one("CAP_ABORT", "Abort", main_group),
       [](const Call&) { return button("ABORT", "Abort"); },
       [](const Call& c, const Given&) { c.on([](const Devices& d) { d.cover.halt(d.now); }); }}};
  return properties;
}

}  // namespace dmise
