#pragma once
#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/optics/blur/extended_light.h"
#include "sensors/scene/view.h"

// What windows of extended light have in common: tiles that are even, and their units.
namespace dmise {

/// Pixels along the side of a tile.
inline constexpr int tile_px = 16;

/// Whether what lies between 3 x 3 places of a tile, row after row, follows from them to 0.1 %.
inline bool is_even(const double (&at)[9]) {
  const double between[] = {0.25 * (at[0] + at[2] + at[6] + at[8]), 0.5 * (at[1] + at[7]),
                            0.5 * (at[3] + at[5])};
  return std::ranges::all_of(between,
                             [&](double mean) { return std::abs(mean - at[4]) < 4e-3 * at[4]; });
}

/// Between these places, at parts of the way across and down.
inline double bilinear(const double (&at)[9], double across, double down) {
  const int i = across < 0.5 ? 0 : 1, j = down < 0.5 ? 0 : 1;
  const double u = 2.0 * across - i, v = 2.0 * down - j;
  const double* corner = at + 3 * j + i;
  return (1.0 - v) * ((1.0 - u) * corner[0] + u * corner[1]) +
         v * ((1.0 - u) * corner[3] + u * corner[4]);
}

/// From photons/s/m2/sr in pixels of a window to electrons of the exposure.
void to_electrons(const View& view, ExtendedLight& window, Threads& threads);

}  // namespace dmise
