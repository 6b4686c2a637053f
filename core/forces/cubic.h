#pragma once
#include "core/frames/vec.h"

namespace dmise {

/// Cubic through places and velocities at both ends of `h_s`, at share `u` of it. Closed form, for
/// the inner loop of an integration; `interpolate_cubic` (core/orbit) is that of ticks.
inline Vec<Gcrs> cubic_between(const Vec<Gcrs>& a, const Vec<Gcrs>& va, const Vec<Gcrs>& b,
                               const Vec<Gcrs>& vb, double h_s, double u) {
  const double w = 1 - u;
  return (1 + 2 * u) * w * w * a + (1 + 2 * w) * u * u * b + (u * w * w * h_s) * va -
         (u * u * w * h_s) * vb;
}

}  // namespace dmise
