#pragma once
#include <variant>

#include "core/frames/vec.h"
#include "core/time/julian_date.h"

namespace dmise {

template <class F>
struct MotionState {
  Vec<F> position_m;
  Vec<F> velocity_m_per_s;  // relative to the axes of F
};

/// A state in the frame of its source; conversion needs the Earth's orientation.
using FramedState = std::variant<MotionState<Gcrs>, MotionState<Itrs>, MotionState<Teme>>;

/// From `from` to `to` [s]; good to 10 ps within years.
inline double seconds_between(const Tai& from, const Tai& to) {
  return days_between(to, from) * 86400.0;
}

}  // namespace dmise
