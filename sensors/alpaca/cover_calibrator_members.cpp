#include "sensors/alpaca/alpaca_devices.h"

namespace dmise {
namespace {

using Call = MemberCall;
using Devices = Observatory::Devices;

constexpr int no_calibrator = 0;  // ASCOM's CalibratorStatus NotPresent

int cover_state(const Devices& d) { return int(d.cover.state(d.now)); }
bool cover_moves(const Devices& d) { return d.cover.state(d.now) == CoverState::moving; }

}  // namespace

const std::vector<Member>& cover_calibrator_members() {
  static const std::vector<Member> members{
      {"brightness", not_there},
      {"maxbrightness", not_there},
      {"calibratoron", nullptr, not_there},
      {"calibratoroff", nullptr, not_there},
      {"calibratorchanging", answer_no},
      {"calibratorstate", [](const Call&) { return answer_of(no_calibrator); }},
      {"covermoving", [](const Call& c) { return answer_of(c.of(cover_moves)); }},
      {"coverstate", [](const Call& c) { return answer_of(c.of(cover_state)); }},
      {"devicestate",
       [](const Call& c) {
         StateItems items;
         items.add("CalibratorState", no_calibrator);
         items.add("CoverState", c.of(cover_state));
         items.add("CalibratorChanging", false);
         items.add("CoverMoving", c.of(cover_moves));
         return items.take();
       }},
      {"closecover", nullptr,
       [](const Call& c) {
         c.on([](const Devices& d) { d.cover.close(d.now); });
         return MemberAnswer{};
       }},
      {"haltcover", nullptr,
       [](const Call& c) {
         c.on([](const Devices& d) { d.cover.halt(d.now); });
         return MemberAnswer{};
       }},
      {"opencover", nullptr, [](const Call& c) {
         c.on([](const Devices& d) { d.cover.open(d.now); });
         return MemberAnswer{};
       }}};
  return members;
}

}  // namespace dmise
