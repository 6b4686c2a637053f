#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/detection/pixels/bit_mask.h"
#include "core/detection/pixels/cell_mesh.h"

namespace dmise {

/// Level and noise of the sky over a frame [DN], from a mesh of cells. Counts of a cell are clipped
/// at 3 sigma until convergence; the level is 2.5 median - 1.5 mean (Bertin & Arnouts 1996, A&AS
/// 117, 393), or the median if the two differ by more than 0.3 sigma. A median over 3 x 3 cells
/// removes bright sources; values are bilinear between the cells' centres and extrapolated to the
/// frame's edges. Cells with a gradient are measured again without it, because it is no noise.
/// Where the level bends, as in the Moon's glow, parabolas take the place of the median and of the
/// straight lines between centres.
class Background {
 public:
  Background(const CountImage& counts, int cell_px, Threads& threads);

  /// Measures the same frame again, with the gradients known from before and without the pixels
  /// `lit`, unless these leave less than an eighth of a cell.
  void measure_without(const BitMask& lit, const CountImage& counts, Threads& threads);

  float level_dn(int x, int y) const { return level_.at(x, y); }
  float sigma_dn(int x, int y) const { return sigma_.at(x, y); }
  /// Levels along row `y`, of the columns from `begin` to before `end`.
  void level_row(int y, int begin, int end, float* level_dn) const {
    level_.row(y, begin, end, level_dn);
  }
  void sigma_row(int y, int begin, int end, float* sigma_dn) const {
    sigma_.row(y, begin, end, sigma_dn);
  }
  /// A rectangle of pixels, the first and the last of both coordinates.
  struct Area {
    int x0, y0, x1, y1;
  };
  /// Returns the cells over which the level bends so much that a straight line between cells misses
  /// it by more than `share` of its noise.
  std::vector<Area> bent_cells(double share) const;
  /// Medians over the frame.
  float median_level_dn() const;
  float median_sigma_dn() const;

 private:
  /// Which cells are measured; sloped ones without their gradient, but for `as_they_are`.
  enum class Cells { as_they_are, all, sloped };
  void measure(const CountImage& counts, Threads& threads, const BitMask* lit, Cells which,
               CellMesh& level, CellMesh& sigma);
  /// Whether the level changes over a cell by so much that its noise is measured too high by 2 %.
  bool is_sloped(std::size_t cell) const;
  Area area_of(std::size_t cell) const;

  int columns_, rows_;  // the frame's size
  CellMesh cells_;      // levels of the cells
  CellMesh level_;      // on that mesh, or finer where they bend
  CellMesh sigma_;
};

}  // namespace dmise
