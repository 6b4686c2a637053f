#include "core/optics/deposit_kernels.h"

#include "core/base/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

constexpr int block = 8;  // the stride of a table is a multiple of it

DMISE_INLINE int smaller(int a, int b) { return a < b ? a : b; }
DMISE_INLINE int larger(int a, int b) { return a > b ? a : b; }

// Weights of one node on one axis, from `offset` on in a zeroed row.
DMISE_INLINE void place(const PsfTableView& t, float phase, float scale, int offset, float* row) {
  const float at = phase * float(t.phases);
  const int p = smaller(int(at), t.phases - 1);
  const float f = at - float(p);
  const float* a = t.weights + std::size_t(p) * std::size_t(t.stride);
  const float* b = a + t.stride;
  float* out = row + offset;
  for (int i = 0; i < t.stride; i += block)
    for (int j = 0; j < block; ++j) out[i + j] = scale * (a[i + j] + f * (b[i + j] - a[i + j]));
}

// The same sums for a narrow table and nodes that are near each other, without memory between.
template <int Nodes>
DMISE_INLINE void add_narrow(const PanelView& panel, const PsfTableView& t, const BandView& band,
                             int column, int row, int last_row) {
  constexpr int most = 2 * block;
  float along_x[Nodes][most] = {}, along_y[Nodes][most] = {};
  for (int k = 0; k < Nodes; ++k) {
    place(t, panel.phase_x[k], 1.0f, panel.column[k] - column, along_x[k]);
    place(t, panel.phase_y[k], panel.weight[k], panel.row[k] - row, along_y[k]);
  }
  const int top = row + t.first;
  const int y_begin = larger(0, band.row_begin - top);
  const int y_end = smaller(last_row - row + t.size, band.row_end - top);
  float* out = band.pixels + std::ptrdiff_t(top + y_begin) * band.stride + column + t.first;
  for (int y = y_begin; y < y_end; ++y, out += band.stride) {
    float sum[most];
    for (int j = 0; j < most; ++j) sum[j] = along_y[0][y] * along_x[0][j];
    for (int k = 1; k < Nodes; ++k)
      for (int j = 0; j < most; ++j) sum[j] += along_y[k][y] * along_x[k][j];
    for (int j = 0; j < most; ++j) out[j] += sum[j];
  }
}

template <int Nodes>
DMISE_INLINE void add(const PanelView& panel, const PsfTableView& t, const BandView& band,
                      float* work) {
  int column = panel.column[0], row = panel.row[0], last_column = column, last_row = row;
  for (int k = 1; k < Nodes; ++k) {
    column = smaller(column, panel.column[k]);
    row = smaller(row, panel.row[k]);
    last_column = larger(last_column, panel.column[k]);
    last_row = larger(last_row, panel.row[k]);
  }
  const int width = (last_column - column + t.stride + block - 1) / block * block;
  const int height = (last_row - row + t.stride + block - 1) / block * block;
  const int left = column + t.first, top = row + t.first;
  const int x_begin = larger(0, -left);
  const int x_end = smaller(last_column - column + t.size, band.columns - left);
  const int y_begin = larger(0, band.row_begin - top);
  const int y_end = smaller(last_row - row + t.size, band.row_end - top);
  if (x_begin >= x_end || y_begin >= y_end) return;
  if (t.stride == block && width <= 2 * block && height <= 2 * block && left >= 0 &&
      left + 2 * block <= band.columns) {
    add_narrow<Nodes>(panel, t, band, column, row, last_row);
    return;
  }

  float* along_x = work;                     // Nodes x width
  float* along_y = along_x + Nodes * width;  // Nodes x height
  float* sum = along_y + Nodes * height;     // width
  for (int i = 0; i < Nodes * (width + height); ++i) work[i] = 0.0f;
  for (int k = 0; k < Nodes; ++k) {
    place(t, panel.phase_x[k], 1.0f, panel.column[k] - column, along_x + k * width);
    place(t, panel.phase_y[k], panel.weight[k], panel.row[k] - row, along_y + k * height);
  }
  for (int y = y_begin; y < y_end; ++y) {
    float share[Nodes];
    for (int k = 0; k < Nodes; ++k) share[k] = along_y[k * height + y];
    for (int x = 0; x < width; x += block)
      for (int j = 0; j < block; ++j) {
        float s = share[0] * along_x[x + j];
        for (int k = 1; k < Nodes; ++k) s += share[k] * along_x[k * width + x + j];
        sum[x + j] = s;
      }
    float* out = band.pixels + std::ptrdiff_t(top + y) * band.stride + left;
    for (int x = x_begin; x < x_end; ++x) out[x] += sum[x];
  }
}

}  // namespace

void add_panel(const PanelView& panel, const PsfTableView& table, const BandView& band,
               float* work) {
  if (panel.nodes == 1)
    add<1>(panel, table, band, work);
  else
    add<panel_nodes>(panel, table, band, work);
}

}  // namespace dmise::DMISE_SIMD
