#include "core/detection/pixels/cell_mesh.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/simd_level.h"
#include "core/detection/pixels/filter_kernels.h"

namespace dmise {

CellMesh::CellMesh(int columns, int rows, int across_cells, int down_cells)
    : across(across_cells),
      down(down_cells),
      values(std::size_t(across_cells) * std::size_t(down_cells)),
      columns_(columns),
      rows_(rows) {
  for (int x = 0; x < columns_; ++x) {
    across_.push_back(between(x, columns_, across));
    next_.push_back(across_.back().next);
    ends_.resize(std::size_t(across_.back().cell), x);
  }
  ends_.push_back(columns_);
  for (int y = 0; y < rows_; ++y) down_.push_back(between(y, rows_, down));
}

CellMesh::Between CellMesh::between(int pixel, int pixels, int cells) {
  const float place = (float(pixel) + 0.5f) * float(cells) / float(pixels) - 0.5f;
  const int cell = std::clamp(int(std::floor(place)), 0, std::max(0, cells - 2));
  return {cell, cells > 1 ? place - float(cell) : 0.0f};  // extrapolates beyond the outer centres
}

float CellMesh::cell(int i, int j) const {
  return values[std::size_t(std::clamp(j, 0, down - 1)) * std::size_t(across) +
                std::size_t(std::clamp(i, 0, across - 1))];
}

void CellMesh::row(int y, int begin, int end, float* out) const {
  if (begin >= end) return;
  static const auto between_cells =
      kernel_of(best_simd_level(), sse2::between_cells, avx2::between_cells, avx512::between_cells);
  const Between v = down_[std::size_t(y)];
  const float* above = values.data() + std::size_t(v.cell) * std::size_t(across);
  const float* below = down > 1 ? above + across : above;
  const auto in_row = [&](std::size_t cell) {
    return above[cell] + v.next * (below[cell] - above[cell]);
  };
  const auto last_cell = std::size_t(across) - 1;
  auto cell = std::size_t(across_[std::size_t(begin)].cell);
  for (int x = begin; x < end; ++cell) {
    const float one = in_row(cell), rise = in_row(std::min(cell + 1, last_cell)) - one;
    const int stop = std::min(ends_[cell], end);
    if (stop <= x) continue;
    between_cells(next_.data() + x, one, rise, std::size_t(stop - x), out);
    out += stop - x;
    x = stop;
  }
}

}  // namespace dmise
