#pragma once
#include <string>

#include "core/wcs/wcs.h"

namespace dmise {

/// Directions of an image's pixels as a page computes them without the WCS: at the nodes of a grid,
/// between which cubics through four nodes a side interpolate. The node (i, j) is the pixel
/// ((i - 1) columns / across - 0.5, (j - 1) rows / down - 0.5), so that a row of nodes is outside
/// at each edge: across + 3 by down + 3 of them.
struct DirectionGrid {
  int across = 0, down = 0;  // cells over the image
  double error_px = 0.0;     // largest that was found where sky is visible
  std::string nodes;  // x, y, z of unit vectors (ICRS), each over all nodes, row by row: int32 in
                      // units of 2^-30, in `byte_planes`: `compact`
  // Whether pixels see sky: at the middles of sky_across x sky_down parts of the image, row by row,
  // a byte 1 or 0, `compact`. Empty if all do.
  int sky_across = 0, sky_down = 0;
  std::string sky;
};

/// As few cells as give 0.05 px, at most 64 a side.
DirectionGrid direction_grid(const Wcs& wcs, int columns, int rows);

}  // namespace dmise
