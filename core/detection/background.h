#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"

namespace dmise {

/// Level and noise of the sky over a frame [DN], from a mesh of cells: in each the counts are
/// clipped at 3 sigma until nothing changes, the level is 2.5 median - 1.5 mean (Bertin & Arnouts
/// 1996, A&AS 117, 393; the median where the two disagree by more than 0.3 sigma). A median over 3
/// x 3 cells removes what a bright source leaves; between the cells' centres it is bilinear.
class Background {
 public:
  Background(const CountImage& counts, int cell_px, Threads& threads);

  float level_dn(int x, int y) const { return at(level_, x, y); }
  float sigma_dn(int x, int y) const { return at(sigma_, x, y); }
  /// The same along row `y`: `columns` values each.
  void row(int y, float* level_dn, float* sigma_dn) const;
  /// Medians over the frame.
  float median_level_dn() const;
  float median_sigma_dn() const;

 private:
  float at(const std::vector<float>& mesh, int x, int y) const;

  int columns_, rows_;  // of the frame
  int mesh_columns_, mesh_rows_;
  std::vector<float> level_, sigma_;
};

}  // namespace dmise
