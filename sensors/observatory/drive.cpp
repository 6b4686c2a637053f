#include "sensors/observatory/drive.h"

#include <algorithm>
#include <cmath>

namespace dmise {

double Drive::position(SimTime now) const {
  const double way = rate_per_s_ * std::max(0.0, (now - since_).seconds());
  return way >= std::abs(to_ - from_) ? to_ : from_ + std::copysign(way, to_ - from_);
}

void Drive::move_to(double position, SimTime now) {
  need_rest(now);
  from_ = this->position(now);
  to_ = position;
  since_ = now;
}

void Drive::halt_at(double position, SimTime now) {
  if (is_moving(now)) from_ = to_ = position;
}

void Drive::need_rest(SimTime now) const {
  if (now < held_until_)
    throw DeviceError(DeviceFault::invalid_operation,
                      "an exposure is open, whose frame would not show the motion of the " + name_ +
                          ": wait for its end or abort it");
}

void Drive::need_still(SimTime now) const {
  if (is_moving(now))
    throw DeviceError(DeviceFault::invalid_operation,
                      "the " + name_ + " moves, which no frame shows");
}

}  // namespace dmise
