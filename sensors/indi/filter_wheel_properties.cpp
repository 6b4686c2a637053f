#include <cmath>

#include "sensors/indi/property_items.h"

namespace dmise {
namespace {

using Call = IndiCall;
using Given = IndiGiven;
using Devices = Observatory::Devices;

/// Names of items, which live as long as the process: of the place `i`, from 0 on.
const char* item_name(std::size_t i) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (int place = 1; place <= 32; ++place)
      all.push_back("FILTER_SLOT_NAME_" + std::to_string(place));
    return all;
  }();
  return names.at(i).c_str();
}

IndiReading filter_slot(const Call& c) {
  return c.of([](const Devices& d) {
    const double count = double(d.wheel.names().size());
    return IndiReading{
        {number_item("FILTER_SLOT_VALUE", "Filter", d.wheel.goal() + 1, {"%.f", 1.0, count, 1.0})},
        d.wheel.place(d.now) ? IndiState::ok : IndiState::busy};
  });
}

void set_filter_slot(const Call& c, const Given& given) {
  const double slot = given.number("FILTER_SLOT_VALUE");
  if (slot != std::floor(slot)) refuse_value("the filter must be a whole number");
  c.on([&](const Devices& d) { d.wheel.turn_to(int(slot) - 1, d.now); });
}

IndiReading filter_names(const Call& c) {
  const auto names = c.of([](const Devices& d) { return d.wheel.names(); });
  IndiReading reading;
  for (std::size_t i = 0; i < names.size(); ++i)
    reading.items.push_back(text_item(item_name(i), item_name(i), names[i]));
  return reading;
}

}  // namespace

const std::vector<IndiProperty>& indi_filter_wheel_properties() {
  static const std::vector<IndiProperty> properties{
      {numbers("FILTER_SLOT", "Filter Slot", main_group), filter_slot, set_filter_slot},
      {texts("FILTER_NAME", "Filter", main_group), filter_names}};
  return properties;
}

}  // namespace dmise
