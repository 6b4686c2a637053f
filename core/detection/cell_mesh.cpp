#include "core/detection/cell_mesh.h"

#include <algorithm>
#include <cmath>

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

float CellMesh::at(int x, const Between& v) const {
  const Between u = across_[std::size_t(x)];
  const float* above = values.data() + std::size_t(v.cell) * std::size_t(across) + u.cell;
  const float* below = down > 1 ? above + across : above;
  const int right = across > 1 ? 1 : 0;
  const float one = above[0] + v.next * (below[0] - above[0]);
  const float next = above[right] + v.next * (below[right] - above[right]);
  return one + u.next * (next - one);
}

void CellMesh::row(int y, float* out) const {
  const Between v = between(y, rows_, down);
  const float* above = values.data() + std::size_t(v.cell) * std::size_t(across);
  const float* below = down > 1 ? above + across : above;
  std::vector<float> line(std::size_t(across) + 1);
  for (int i = 0; i < across; ++i) line[std::size_t(i)] = above[i] + v.next * (below[i] - above[i]);
  line.back() = line[std::size_t(across) - 1];
  const float* next = next_.data();
  int x = 0;
  for (std::size_t cell = 0; cell < ends_.size(); ++cell) {
    const float one = line[cell], rise = line[cell + 1] - one;
    for (; x < ends_[cell]; ++x) out[x] = one + next[x] * rise;
  }
}

}  // namespace dmise
