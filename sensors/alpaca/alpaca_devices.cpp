#include "sensors/alpaca/alpaca_devices.h"

#include <algorithm>

#include "core/base/printable.h"
#include "core/base/version.h"

namespace dmise {
namespace {

MemberAnswer no_commands(const MemberCall&) {
  throw DeviceError(DeviceFault::not_implemented, "this device takes no commands of its own");
}

MemberAnswer refuse_action(const MemberCall& c) {
  c.given.text("Action");  // clients leave out parameters that are empty
  throw DeviceError(DeviceFault::action_not_implemented, "this device has no actions");
}

MemberAnswer connect(const MemberCall& c) {
  c.session.connected = true;
  return {};
}
MemberAnswer disconnect(const MemberCall& c) {
  c.session.connected = false;
  return {};
}

const Member* find(const std::vector<Member>& members, const std::string& name) {
  const auto found = std::ranges::find(members, name, &Member::name);
  return found == members.end() ? nullptr : &*found;
}

}  // namespace

MemberAnswer answer_of(double value) { return {.value = JsonWriter().value(value).take()}; }
MemberAnswer answer_of(int value) { return {.value = JsonWriter().value(value).take()}; }
MemberAnswer answer_of(bool value) { return {.value = value ? "true" : "false"}; }
MemberAnswer answer_of(const std::string& value) {
  return {.value = JsonWriter().value(value).take()};
}
MemberAnswer answer_of(const std::vector<std::string>& texts) {
  JsonWriter json;
  json.begin_array();
  for (const std::string& text : texts) json.value(text);
  return {.value = json.end_array().take()};
}

MemberAnswer answer_of(const std::vector<int>& numbers) {
  JsonWriter json;
  json.begin_array();
  for (const int number : numbers) json.value(number);
  return {.value = json.end_array().take()};
}

MemberAnswer not_there(const MemberCall& c) {
  throw DeviceError(DeviceFault::not_implemented,
                    c.kind.name(c.sensor()) + " has nothing of this kind");
}

MemberAnswer answer_yes(const MemberCall&) { return answer_of(true); }
MemberAnswer answer_no(const MemberCall&) { return answer_of(false); }

const std::vector<Member>& common_members() {
  static const std::vector<Member> members{
      {"action", nullptr, refuse_action},
      {"commandblind", nullptr, no_commands},
      {"commandbool", nullptr, no_commands},
      {"commandstring", nullptr, no_commands},
      {"connect", nullptr, connect, false},
      {"connected",
       [](const MemberCall& c) {
         return answer_of(c.session.connected && c.observatory.has_link(c.station));
       },
       [](const MemberCall& c) { return c.given.flag("Connected") ? connect(c) : disconnect(c); },
       false},
      {"connecting", [](const MemberCall&) { return answer_of(false); }, nullptr, false},
      {"disconnect", nullptr, disconnect, false},
      {"driverinfo",
       [](const MemberCall&) {
         return answer_of(std::string("an observatory simulated by DMISE"));
       },
       nullptr, false},
      {"driverversion", [](const MemberCall&) { return answer_of(std::string(software_name())); },
       nullptr, false},
      {"description",
       [](const MemberCall& c) {
         return answer_of(c.kind.name(c.sensor()) + ", simulated by DMISE");
       },
       nullptr, false},
      {"interfaceversion", [](const MemberCall& c) { return answer_of(c.kind.interface_version); },
       nullptr, false},
      {"name", [](const MemberCall& c) { return answer_of(c.kind.name(c.sensor())); }, nullptr,
       false},
      {"supportedactions", [](const MemberCall&) { return answer_of(std::vector<std::string>{}); },
       nullptr, false}};
  return members;
}

const std::vector<DeviceKind>& device_kinds() {
  static const std::vector<DeviceKind> kinds{
      {"telescope", "Telescope", 4, telescope_name, telescope_members},
      {"camera", "Camera", 4, camera_name, camera_members},
      {"focuser", "Focuser", 4, focuser_name, focuser_members},
      {"filterwheel", "FilterWheel", 3, wheel_name, filter_wheel_members},
      {"covercalibrator", "CoverCalibrator", 2, cover_name, cover_calibrator_members},
      {"observingconditions", "ObservingConditions", 2, weather_name,
       observing_conditions_members}};
  return kinds;
}

AlpacaDevices::AlpacaDevices(Observatory& observatory, bool connected)
    : observatory_(observatory),
      sessions_(device_kinds().size(),
                std::vector<DeviceSession>(observatory.size(), DeviceSession{connected})) {}

MemberAnswer AlpacaDevices::call(const DeviceCall& call, const AlpacaParameters& parameters) {
  const auto& kinds = device_kinds();
  const auto kind = std::ranges::find(kinds, call.type, &DeviceKind::type);
  if (kind == kinds.end()) throw BadRequest("device type: there is no " + printable(call.type, 60));
  auto& sessions = sessions_[std::size_t(kind - kinds.begin())];
  if (call.number >= sessions.size())
    throw BadRequest("device number: must be 0 to " + std::to_string(sessions.size() - 1));
  const Member* member = find(kind->members(), call.member);
  if (!member) member = find(common_members(), call.member);
  const auto act = !member ? nullptr : call.put ? member->put : member->get;
  if (!act)
    throw BadRequest(printable(call.member, 60) +
                     (member ? call.put ? ": can't be put" : ": can't be read"
                             : ": a " + call.type + " has no such member"));
  const MemberCall member_call{{*kind, observatory_, call.number, sessions[call.number]},
                               parameters};
  if (member->needs_connection && !member_call.session.connected)
    throw DeviceError(DeviceFault::not_connected, "the device is not connected");
  if (member->needs_connection && !observatory_.has_link(call.number))
    throw DeviceError(DeviceFault::driver, "the device does not answer: its link is lost");
  return act(member_call);
}

std::vector<AlpacaDevices::Configured> AlpacaDevices::configured() const {
  std::vector<Configured> devices;
  for (std::size_t i = 0; i < observatory_.size(); ++i)
    for (const DeviceKind& kind : device_kinds()) {
      const SensorConfig& sensor = observatory_.sensor(i);
      devices.push_back({kind.name(sensor), kind.title,
                         std::string("dmise-") + kind.type + "-" + sensor.name, i});
    }
  return devices;
}

}  // namespace dmise
