#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/files/json.h"
#include "sensors/alpaca/alpaca_request.h"
#include "sensors/observatory/observatory.h"

namespace dmise {

/// What clients set of one device, beside what the device itself keeps.
struct DeviceSession {
  bool connected = false;
  std::optional<double> target_ra_h = {}, target_dec_deg = {};  // where a telescope is to go
};

struct DeviceKind;

/// A call of one member of a device.
struct MemberCall : StationCall<DeviceKind, DeviceSession> {
  const AlpacaParameters& given;
};

/// What a device answers to a call.
struct MemberAnswer {
  std::string value = {};                        // JSON; empty: none
  std::shared_ptr<const CountImage> image = {};  // in its place, of ImageArray
  std::function<bool()> done = {};               // the answer waits until it is true; none: at once
};

/// A member of a device's interface. Its name is that of the API; null: it cannot be read or put.
struct Member {
  const char* name;
  MemberAnswer (*get)(const MemberCall&) = nullptr;
  MemberAnswer (*put)(const MemberCall&) = nullptr;
  bool needs_connection = true;
};

/// A kind of device of which each station has one.
struct DeviceKind {
  const char* type;   // as in the API's addresses
  const char* title;  // as it is configured
  int interface_version;
  std::string (*name)(const SensorConfig& sensor);
  const std::vector<Member>& (*members)();
};
const std::vector<DeviceKind>& device_kinds();

/// The devices of an observatory as the API has them: one of each kind at each station.
class AlpacaDevices {
 public:
  explicit AlpacaDevices(Observatory& observatory, bool connected = false);

  /// Calls a member. Throws `BadRequest` and `DeviceError`.
  MemberAnswer call(const DeviceCall& call, const AlpacaParameters& parameters);

  struct Configured {
    std::string name, type, unique_id;
    std::size_t number;
  };
  std::vector<Configured> configured() const;

 private:
  Observatory& observatory_;
  std::vector<std::vector<DeviceSession>> sessions_;  // by kind, then by station
};

// The members, by name; those that all devices have are in the first.
const std::vector<Member>& common_members();
const std::vector<Member>& telescope_members();
const std::vector<Member>& camera_members();
const std::vector<Member>& focuser_members();
const std::vector<Member>& filter_wheel_members();
const std::vector<Member>& cover_calibrator_members();
const std::vector<Member>& observing_conditions_members();

/// Refuses what a device does not have.
MemberAnswer not_there(const MemberCall&);
[[noreturn]] inline void refuse_value(const std::string& reason) {
  throw DeviceError(DeviceFault::invalid_value, reason);
}

// Values as JSON.
MemberAnswer answer_of(double value);
MemberAnswer answer_of(int value);
MemberAnswer answer_of(bool value);
MemberAnswer answer_of(const std::string& value);
MemberAnswer answer_of(const std::vector<std::string>& texts);
MemberAnswer answer_of(const std::vector<int>& numbers);
MemberAnswer answer_yes(const MemberCall&);
MemberAnswer answer_no(const MemberCall&);

/// What a device tells of its state at once.
class StateItems {
 public:
  StateItems() { json_.begin_array(); }
  template <class Value>
  void add(const char* name, const Value& value) {
    json_.begin_object().field("Name", name).field("Value", value).end_object();
  }
  MemberAnswer take() { return {.value = json_.end_array().take()}; }

 private:
  JsonWriter json_;
};

}  // namespace dmise
