#include "core/optics/blur/deposit_kernels.h"

#include "core/base/numeric/lanes.h"

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

constexpr int window = 2 * block;

// Sums for a narrow table and nodes that are near each other, without memory between: within a
// window from the least `column` and `row` of the nodes on.
template <int Nodes, class Points>
DMISE_INLINE void add_narrow(const Points& points, const PsfTableView& table, const BandView& band,
                             int column, int row, int last_row) {
  PsfTableView t = table;
  t.stride = block;
  float along_x[Nodes][window] = {}, along_y[Nodes][window] = {};
  for (int k = 0; k < Nodes; ++k) {
    place(t, points.phase_x[k], 1.0f, points.column[k] - column, along_x[k]);
    place(t, points.phase_y[k], points.weight[k], points.row[k] - row, along_y[k]);
  }
  constexpr int parts = window / lanes;
  F32 x[Nodes][parts];
  for (int k = 0; k < Nodes; ++k)
    for (int p = 0; p < parts; ++p) x[k][p] = load<F32>(along_x[k] + p * lanes);
  const int top = row + t.first;
  const int y_begin = larger(0, band.row_begin - top);
  const int y_end = smaller(last_row - row + t.size, band.row_end - top);
  float* out = band.pixels + std::ptrdiff_t(top + y_begin) * band.stride + column + t.first;
  for (int y = y_begin; y < y_end; ++y, out += band.stride)
    for (int p = 0; p < parts; ++p) {
      F32 sum = splat(along_y[0][y]) * x[0][p];
      for (int k = 1; k < Nodes; ++k) sum += splat(along_y[k][y]) * x[k][p];
      store(out + p * lanes, load<F32>(out + p * lanes) + sum);
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
  if (t.stride == block && width <= window && height <= window && left >= 0 &&
      left + window <= band.columns) {
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

/// Nodes and weights of Gauss and Legendre on [0, 1].
template <int Nodes>
struct Quadrature;
template <>
struct Quadrature<1> {
  static constexpr double tau[] = {0.5}, weight[] = {1.0};
};
template <>
struct Quadrature<2> {
  static constexpr double tau[] = {0.21132486540518713, 0.78867513459481287};
  static constexpr double weight[] = {0.5, 0.5};
};
template <>
struct Quadrature<3> {
  static constexpr double tau[] = {0.1127016653792583, 0.5, 0.8872983346207417};
  static constexpr double weight[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
};
template <>
struct Quadrature<4> {
  static constexpr double tau[] = {0.069431844202973714, 0.33000947820757187, 0.66999052179242813,
                                   0.93056815579702623};
  static constexpr double weight[] = {0.17392742256872684, 0.3260725774312731, 0.3260725774312731,
                                      0.17392742256872684};
};
template <>
struct Quadrature<5> {
  static constexpr double tau[] = {0.046910077030668018, 0.23076534494715845, 0.5,
                                   0.7692346550528415, 0.95308992296933193};
  static constexpr double weight[] = {0.11846344252809471, 0.2393143352496831, 0.2844444444444445,
                                      0.2393143352496831, 0.11846344252809471};
};
template <>
struct Quadrature<6> {
  static constexpr double tau[] = {0.033765242898423975, 0.16939530676686776, 0.38069040695840151,
                                   0.61930959304159849,  0.83060469323313224, 0.96623475710157603};
  static constexpr double weight[] = {0.085662246189584873, 0.18038078652406947,
                                      0.23395696728634569,  0.23395696728634569,
                                      0.18038078652406947,  0.085662246189584873};
};
template <>
struct Quadrature<7> {
  static constexpr double tau[] = {
      0.025446043828620757, 0.12923440720030277, 0.29707742431130141, 0.5,
      0.70292257568869854,  0.87076559279969723, 0.97455395617137919};
  static constexpr double weight[] = {
      0.064742483084435323, 0.13985269574463829, 0.19091502525255916, 0.20897959183673448,
      0.19091502525255916,  0.13985269574463829, 0.064742483084435323};
};
template <>
struct Quadrature<8> {
  static constexpr double tau[] = {0.019855071751231912, 0.10166676129318664, 0.2372337950418355,
                                   0.40828267875217511,  0.59171732124782483, 0.7627662049581645,
                                   0.89833323870681336,  0.98014492824876809};
  static constexpr double weight[] = {
      0.050614268145188344, 0.11119051722668717, 0.15685332293894352, 0.18134189168918088,
      0.18134189168918088,  0.15685332293894352, 0.11119051722668717, 0.050614268145188344};
};

DMISE_INLINE int floor_of(double x) {
  const int whole = int(x);
  return whole - (x < double(whole));
}

template <int Nodes>
DMISE_INLINE void add_short_of(const ShortArc& arc, const PsfTableView& table,
                               const BandView& band) {
  struct {
    float weight[Nodes];
    int column[Nodes], row[Nodes];
    float phase_x[Nodes], phase_y[Nodes];
  } points;
  for (int k = 0; k < Nodes; ++k) {
    const double tau = Quadrature<Nodes>::tau[k];
    const double x = arc.x_px + tau * (arc.slope_x + tau * arc.curve_x);
    const double y = arc.y_px + tau * (arc.slope_y + tau * arc.curve_y);
    points.column[k] = floor_of(x);
    points.row[k] = floor_of(y);
    points.phase_x[k] = float(x - points.column[k]);
    points.phase_y[k] = float(y - points.row[k]);
    points.weight[k] = arc.signal_e * float(Quadrature<Nodes>::weight[k]);
  }
  int column = points.column[0], row = points.row[0], last_row = row;
  for (int k = 1; k < Nodes; ++k) {
    column = smaller(column, points.column[k]);
    row = smaller(row, points.row[k]);
    last_row = larger(last_row, points.row[k]);
  }
  add_narrow<Nodes>(points, table, band, column, row, last_row);
}

}  // namespace

void add_short(const ShortArc& arc, const PsfTableView& table, const BandView& band) {
  switch (arc.nodes) {
    case 1:
      return add_short_of<1>(arc, table, band);
    case 2:
      return add_short_of<2>(arc, table, band);
    case 3:
      return add_short_of<3>(arc, table, band);
    case 4:
      return add_short_of<4>(arc, table, band);
    case 5:
      return add_short_of<5>(arc, table, band);
    case 6:
      return add_short_of<6>(arc, table, band);
    case 7:
      return add_short_of<7>(arc, table, band);
    default:
      return add_short_of<8>(arc, table, band);
  }
}

void add_panel(const PanelView& panel, const PsfTableView& table, const BandView& band,
               float* work) {
  if (panel.nodes == 1)
    add<1>(panel, table, band, work);
  else
    add<panel_nodes>(panel, table, band, work);
}

}  // namespace dmise::DMISE_SIMD
