#include "sensors/alpaca/alpaca_devices.h"

namespace dmise {
namespace {

using Call = MemberCall;
using Devices = Observatory::Devices;

MemberAnswer focuser_steps(const Call& c) {
  return answer_of(c.of([](const Devices& d) { return d.focuser.max_step(); }));
}

MemberAnswer focuser_state(const Call& c) {
  StateItems items;
  c.on([&](const Devices& d) {
    items.add("IsMoving", d.focuser.is_moving(d.now));
    items.add("Position", d.focuser.position(d.now));
    items.add("Temperature", d.camera.ambient_c());
  });
  return items.take();
}

}  // namespace

const std::vector<Member>& focuser_members() {
  static const std::vector<Member> members{
      {"absolute", answer_yes},
      {"devicestate", focuser_state},
      {"ismoving",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.focuser.is_moving(d.now); }));
       }},
      {"maxincrement", focuser_steps},
      {"maxstep", focuser_steps},
      {"position",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.focuser.position(d.now); }));
       }},
      {"stepsize", [](const Call&) { return answer_of(Focuser::step_um); }},
      {"tempcomp", answer_no, not_there},
      {"tempcompavailable", answer_no},
      {"temperature",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.camera.ambient_c(); }));
       }},
      {"halt", nullptr,
       [](const Call& c) {
         c.on([](const Devices& d) { d.focuser.halt(d.now); });
         return MemberAnswer{};
       }},
      {"move", nullptr, [](const Call& c) {
         const int position = c.given.integer("Position");
         c.on([&](const Devices& d) { d.focuser.move_to(position, d.now); });
         return MemberAnswer{};
       }}};
  return members;
}

}  // namespace dmise
