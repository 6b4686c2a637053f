#pragma once
#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/frames/geodesy.h"

namespace dmise {

/// `count` unit vectors that cover the sphere evenly (a golden spiral), each in its golden turn.
template <class F>
std::vector<Vec<F>> even_directions(int count) {
  const double golden = pi * (3 - std::sqrt(5.0));
  std::vector<Vec<F>> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
    directions.push_back({r * std::cos(golden * i), r * std::sin(golden * i), z});
  }
  return directions;
}

/// Unit vector in a direction, the inverse of `horizontal`.
inline Vec<Enu> from_horizontal(const Horizontal& d) {
  const double c = std::cos(d.elevation_rad);
  return {std::sin(d.azimuth_rad) * c, std::cos(d.azimuth_rad) * c, std::sin(d.elevation_rad)};
}

}  // namespace dmise
