#include "sensors/observatory/cover.h"

namespace dmise {

CoverState Cover::state(SimTime now) const {
  if (drive_.is_moving(now)) return CoverState::moving;
  const double part = drive_.position(now);
  return part == 1.0 ? CoverState::open : part == 0.0 ? CoverState::closed : CoverState::unknown;
}

void Cover::need_still(SimTime now) const {
  drive_.need_still(now);
  if (state(now) == CoverState::unknown)
    throw DeviceError(DeviceFault::invalid_operation,
                      "the cover is half open, which no frame shows: open or close it");
}

}  // namespace dmise
