#pragma once
#include <cstddef>
#include <vector>

namespace dmise {

/// Values at the centres of the cells of a mesh that divides a frame evenly. Bilinear between them,
/// extrapolated to the frame's edges.
class CellMesh {
 public:
  /// `columns` and `rows` of the frame, `across` and `down` of the mesh; at least 1.
  CellMesh(int columns, int rows, int across, int down);

  float at(int x, int y) const {
    const Between u = across_[std::size_t(x)], v = down_[std::size_t(y)];
    const float* above = values.data() + std::size_t(v.cell) * std::size_t(across) + u.cell;
    const float* below = down > 1 ? above + across : above;
    const int right = across > 1 ? 1 : 0;
    const float one = above[0] + v.next * (below[0] - above[0]);
    const float next = above[right] + v.next * (below[right] - above[right]);
    return one + u.next * (next - one);
  }
  /// The values along row `y` of the frame, of the columns from `begin` to before `end`.
  void row(int y, int begin, int end, float* out) const;
  /// Returns a cell's value; beside the mesh that of the nearest cell.
  float cell(int i, int j) const;

  int across = 0, down = 0;
  std::vector<float> values;  // down x across

 private:
  /// Position of a pixel between cell centres: `cell`, and the weight of the next.
  struct Between {
    int cell;
    float next;
  };
  static Between between(int pixel, int pixels, int cells);
  int columns_ = 0, rows_ = 0;
  std::vector<Between> across_, down_;  // for every column and row
  std::vector<float> next_;             // the weights of across_
  std::vector<int> ends_;               // the column after the last of each cell
};

}  // namespace dmise
