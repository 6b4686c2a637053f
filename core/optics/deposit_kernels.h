#pragma once
#include <cstddef>

namespace dmise {

inline constexpr int panel_nodes = 5;

/// Points of one panel of a trail: quadrature nodes with their weights [e-].
struct PanelView {
  int nodes = 0;  // 1 or panel_nodes
  float weight[panel_nodes];
  int column[panel_nodes], row[panel_nodes];         // floor of the position
  float phase_x[panel_nodes], phase_y[panel_nodes];  // fraction, [0, 1]
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
  /* Adds the panel to the band; `work` has room for panel_work_floats(table). */         \
  void add_panel(const PanelView& panel, const PsfTableView& table, const BandView& band, \
                 float* work);                                                            \
  }
DMISE_DEPOSIT_KERNELS(sse2)
DMISE_DEPOSIT_KERNELS(avx2)
DMISE_DEPOSIT_KERNELS(avx512)
#undef DMISE_DEPOSIT_KERNELS

}  // namespace dmise
