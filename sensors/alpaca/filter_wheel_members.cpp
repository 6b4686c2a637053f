#include "sensors/alpaca/alpaca_devices.h"

namespace dmise {
namespace {

using Call = MemberCall;
using Devices = Observatory::Devices;

constexpr int on_its_way = -1;

int wheel_place(const Devices& d) { return d.wheel.place(d.now).value_or(on_its_way); }

std::vector<std::string> wheel_names(const Call& c) {
  return c.of([](const Devices& d) { return d.wheel.names(); });
}

}  // namespace

const std::vector<Member>& filter_wheel_members() {
  static const std::vector<Member> members{
      {"devicestate",
       [](const Call& c) {
         StateItems items;
         items.add("Position", c.of(wheel_place));
         return items.take();
       }},
      {"focusoffsets",
       [](const Call& c) { return answer_of(std::vector<int>(wheel_names(c).size(), 0)); }},
      {"names", [](const Call& c) { return answer_of(wheel_names(c)); }},
      {"position", [](const Call& c) { return answer_of(c.of(wheel_place)); },
       [](const Call& c) {
         const int to = c.given.integer("Position");
         c.on([&](const Devices& d) { d.wheel.turn_to(to, d.now); });
         return MemberAnswer{};
       }}};
  return members;
}

}  // namespace dmise
