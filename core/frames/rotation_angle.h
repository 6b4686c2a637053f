#pragma once
#include <cmath>

#include "core/frames/vec.h"

namespace dmise {

/// Returns the angle of a rotation [rad, 0..pi], accurate at every angle.
template <class F>
double rotation_angle_rad(const Rotation<F, F>& turn) {
  const auto& m = turn.m;
  return std::atan2(std::hypot(m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]),
                    m[0][0] + m[1][1] + m[2][2] - 1.0);
}

}  // namespace dmise
