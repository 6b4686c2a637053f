#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"

namespace dmise {

/// Level and noise of the sky over a frame [DN], from a mesh of cells. Counts of a cell are clipped
/// at 3 sigma until convergence; the level is 2.5 median - 1.5 mean (Bertin & Arnouts 1996, A&AS
/// 117, 393), or the median if the two differ by more than 0.3 sigma. A median over 3 x 3 cells
/// removes bright sources; values are bilinear between the cells' centres and extrapolated to the
/// frame's edges.
class Background {
 public:
  Background(const CountImage& counts, int cell_px, Threads& threads);

  float level_dn(int x, int y) const { return at(level_, x, y); }
  float sigma_dn(int x, int y) const { return at(sigma_, x, y); }
  /// The same along row `y`: `columns` values.
  void level_row(int y, float* level_dn) const { row(level_, y, level_dn); }
  void sigma_row(int y, float* sigma_dn) const { row(sigma_, y, sigma_dn); }
  /// Medians over the frame.
  float median_level_dn() const;
  float median_sigma_dn() const;

 private:
  /// Position of a pixel between cell centres: `cell`, and the weight of the next.
  struct Between {
    int cell;
    float next;
  };
  static Between between(int pixel, int pixels, int cells);
  float at(const std::vector<float>& mesh, int x, int y) const;
  void row(const std::vector<float>& mesh, int y, float* out) const;

  int columns_, rows_;  // of the frame
  int mesh_columns_, mesh_rows_;
  std::vector<float> level_, sigma_;
  std::vector<Between> across_;  // of every column
};

}  // namespace dmise
