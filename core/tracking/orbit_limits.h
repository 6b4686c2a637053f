#pragma once
#include "core/tracking/orbit_state.h"

namespace dmise {

/// What an orbit near the Earth may be; candidates beyond are left out.
struct OrbitLimits {
  double least_perigee_m = 6.478e6;  // from the Earth's centre
  double largest_apogee_m = 5e8;
  bool open = false;  // parabolas and hyperbolas are taken
};

bool within(const OrbitLimits& limits, const OrbitState& state);

}  // namespace dmise
