#pragma once
#include <string>

#include "core/base/error.h"

namespace dmise {

/// Why a device refuses a command: the error numbers of ASCOM's interfaces.
enum class DeviceFault : int {
  not_implemented = 0x400,
  invalid_value = 0x401,
  value_not_set = 0x402,
  not_connected = 0x407,
  invalid_while_parked = 0x408,
  invalid_operation = 0x40B,
  action_not_implemented = 0x40C,
  driver = 0x500,  // the frame could not be made or written
};

/// A command that a device refuses. The message is one line.
class DeviceError : public Error {
 public:
  DeviceError(DeviceFault fault, const std::string& reason) : Error(reason), fault_(fault) {}
  DeviceFault fault() const { return fault_; }

 private:
  DeviceFault fault_;
};

}  // namespace dmise
