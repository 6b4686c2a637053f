#pragma once
#include <cstddef>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

inline constexpr int panel_nodes = 5;

/// Points of one panel of a trail: quadrature nodes with their weights [e-].
struct PanelView {
  int nodes = 0;  // 1 or panel_nodes
  float weight[panel_nodes];
  int column[panel_nodes], row[panel_nodes];         // floor of the position
  float phase_x[panel_nodes], phase_y[panel_nodes];  // fraction, [0, 1]
};

inline constexpr int max_short_nodes = 8;
/// Most pixels along each axis between the ends of a short arc.
inline constexpr double longest_short_px = 7.0;

/// A path for one panel: position = start + tau (slope + tau curve), tau in [0, 1].
struct ShortArc {
  double x_px, y_px, slope_x, slope_y, curve_x, curve_y;
  float signal_e;
  int nodes = 0;  // 1 to max_short_nodes
};

struct PsfTableView {
  const float* weights;
  int phases, first, size, stride;
};

/// Rows [row_begin, row_end) of an image whose pixel (0, 0) is `pixels`, rows `stride` apart.
struct BandView {
  float* pixels;
  int columns, row_begin, row_end;
  std::ptrdiff_t stride;
};

#define DMISE_DEPOSIT_KERNELS(level)                                                      \
  namespace level {                                                                       \
  /* Adds the panel to the band; `work` has room for the weights of its nodes along both  \
     axes, and for a row of their sum. */                                                 \
  void add_panel(const PanelView& panel, const PsfTableView& table, const BandView& band, \
                 float* work);                                                            \
  /* Adds a short arc to the band. The table's stride is 8; the 16 columns from the arc's \
     leftmost on are in the image. */                                                     \
  void add_short(const ShortArc& arc, const PsfTableView& table, const BandView& band);   \
  }
DMISE_EACH_SIMD_SET(DMISE_DEPOSIT_KERNELS)
#undef DMISE_DEPOSIT_KERNELS

}  // namespace dmise
