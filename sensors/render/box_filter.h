#pragma once
#include "sensors/render/renderer.h"

namespace dmise {

/// A rectangle of pixels of a tile.
struct TileBox {
  int left = 0, top = 0, columns = 0, rows = 0;
};

/// Adds the mean of each pixel's samples to the tile: of up to three bands from `first_band` on
/// and, if `with_coverage`, of the fourth channel to the coverage. `samples`: box.rows x
/// oversampling rows of box.columns x oversampling samples of four floats.
void add_box_means(const float* samples, const TileBox& box, int oversampling,
                   std::size_t first_band, bool with_coverage, Tile& tile);

}  // namespace dmise
