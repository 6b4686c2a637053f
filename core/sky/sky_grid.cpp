#include "core/sky/sky_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace dmise {
namespace {

constexpr double cell_px = 32.0;

/// One axis cut into equal cells from the first pixel to the last.
struct Axis {
  int cells;
  double width;            // width of a cell [px]
  std::vector<int> first;  // cells + 1: each cell's first pixel; a pixel belongs to one cell

  explicit Axis(int pixels) {
    cells = std::max(1, int(std::ceil((pixels - 1) / cell_px)));
    width = pixels > 1 ? double(pixels - 1) / cells : 1.0;
    for (int c = 0; c < cells; ++c) first.push_back(int(std::ceil(c * width - 1e-9)));
    first.push_back(pixels);
  }
};

/// Coefficients of the cubic of t in [0, 1] between p[1] and p[2] (Catmull & Rom 1974).
std::array<double, 4> cubic(double p0, double p1, double p2, double p3) {
  return {p1, 0.5 * (p2 - p0), p0 - 2.5 * p1 + 2 * p2 - 0.5 * p3,
          0.5 * (p3 - p0) + 1.5 * (p1 - p2)};
}

double at(const std::array<double, 4>& c, double t) {
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

/// A surface of u and v in [0, 1] between the middle ones of 4 x 4 nodes.
class Bicubic {
 public:
  /// `node(k, l)`: k and l from -1 to 2.
  template <class Node>
  explicit Bicubic(const Node& node) {
    for (int k = 0; k < 4; ++k)
      columns_[std::size_t(k)] =
          cubic(node(k - 1, -1), node(k - 1, 0), node(k - 1, 1), node(k - 1, 2));
  }

  /// The cubic of u at a v.
  std::array<double, 4> along_u(double v) const {
    return cubic(at(columns_[0], v), at(columns_[1], v), at(columns_[2], v), at(columns_[3], v));
  }

  /// Those of u^a v^b at 4 b + a.
  std::array<float, 16> coefficients() const {
    std::array<float, 16> out{};
    for (std::size_t b = 0; b < 4; ++b) {
      const auto c = cubic(columns_[0][b], columns_[1][b], columns_[2][b], columns_[3][b]);
      for (std::size_t a = 0; a < 4; ++a) out[4 * b + a] = float(c[a]);
    }
    return out;
  }

 private:
  std::array<std::array<double, 4>, 4> columns_;  // polynomials of v
};

constexpr int parts = 4;  // along each side of a cell that its nodes do not describe

/// The nodes of the coarse grid.
struct Grid {
  int columns, rows;
  const PixelFunction& f;
  double tolerance;
  float* out;  // null: patches are wanted
  Axis across{columns}, down{rows};
  int stride = across.cells + 3;  // nodes in a row, with one beyond each end
  std::vector<double> nodes;

  double& node(int i, int j) { return nodes[std::size_t(j + 1) * stride + std::size_t(i + 1)]; }
  double node(int i, int j) const {
    return nodes[std::size_t(j + 1) * stride + std::size_t(i + 1)];
  }

  /// The value beyond an end continues the parabola of the last three nodes, or the line of two.
  static double beyond(int cells, double last, double second, double third) {
    return cells > 1 ? 3 * (last - second) + third : 2 * last - second;
  }

  void make_nodes(Threads& threads) {
    nodes.assign(std::size_t(stride) * std::size_t(down.cells + 3), 0.0);
    threads.for_ranges(std::size_t(down.cells) + 1, 2, [&](std::size_t first, std::size_t last) {
      for (int j = int(first); j < int(last); ++j) {
        for (int i = 0; i <= across.cells; ++i)
          node(i, j) =
              f(std::min(i * across.width, columns - 1.0), std::min(j * down.width, rows - 1.0));
        const int n = across.cells;
        node(-1, j) = beyond(n, node(0, j), node(1, j), node(2, j));
        node(n + 1, j) = beyond(n, node(n, j), node(n - 1, j), node(n - 2, j));
      }
    });
    const int m = down.cells;
    for (int i = -1; i <= across.cells + 1; ++i) {
      node(i, -1) = beyond(m, node(i, 0), node(i, 1), node(i, 2));
      node(i, m + 1) = beyond(m, node(i, m), node(i, m - 1), node(i, m - 2));
    }
  }

  bool agrees(double guess, double exact) const {
    return std::abs(guess - exact) <= 0.5 * tolerance * std::abs(exact);
  }

  /// No edge near the middle one of five nodes, by fourth differences: a jump in slope makes them
  /// large, and bicubic values wrong by up to 0.4 of them.
  bool calm(double a, double b, double c, double d, double e) const {
    return 0.4 * std::abs(a - 4 * b + 6 * c - 4 * d + e) <= tolerance * std::abs(c);
  }

  /// No edge near the nodes of this cell.
  bool smooth(int i, int j) const {
    for (int q = j; q <= j + 1; ++q)
      for (int p = i; p <= i + 1; ++p) {
        if (p >= 1 && p < across.cells &&
            !calm(node(p - 2, q), node(p - 1, q), node(p, q), node(p + 1, q), node(p + 2, q)))
          return false;
        if (q >= 1 && q < down.cells &&
            !calm(node(p, q - 2), node(p, q - 1), node(p, q), node(p, q + 1), node(p, q + 2)))
          return false;
      }
    return true;
  }
};

/// The cells of some rows: what each thread counts is its own.
struct Piece {
  const Grid& grid;
  std::size_t evaluations = 0;
  std::vector<SkyPatch> patches;

  double evaluate(double x, double y) {
    ++evaluations;
    return grid.f(x, y);
  }

  void fill_cell(int i, int j) {
    const Axis &across = grid.across, &down = grid.down;
    const Bicubic surface([&](int k, int l) { return grid.node(i + k, j + l); });
    const int x0 = across.first[i], x1 = across.first[i + 1];
    const int y0 = down.first[j], y1 = down.first[j + 1];
    const double middle = evaluate(std::min((i + 0.5) * across.width, grid.columns - 1.0),
                                   std::min((j + 0.5) * down.width, grid.rows - 1.0));
    if (!grid.agrees(at(surface.along_u(0.5), 0.5), middle) || !grid.smooth(i, j)) {
      if (std::min(across.width, down.width) >= 4.0 * parts)
        fill_finer(i, j);
      else
        refine(x0, y0, x1, y1);
      return;
    }
    put(surface, x0, y0, x1, y1, {across.width, i}, {down.width, j});
  }

  /// A cell by nodes `parts` times as dense. Those beyond the frame continue the ones in it.
  void fill_finer(int i, int j) {
    constexpr int nodes = parts + 3;  // one beyond each side
    const Axis &across = grid.across, &down = grid.down;
    std::array<std::array<double, nodes>, nodes> value;  // by row, column
    const auto is_in = [](const Axis& axis, int cell, int k) {
      return !(cell == 0 && k < 0) && !(cell == axis.cells - 1 && k > parts);
    };
    const auto node = [&](int k, int l) -> double& {
      return value[std::size_t(l + 1)][std::size_t(k + 1)];
    };
    for (int l = -1; l <= parts + 1; ++l) {
      if (!is_in(down, j, l)) continue;
      for (int k = -1; k <= parts + 1; ++k)
        if (is_in(across, i, k))
          node(k, l) =
              evaluate(std::min((i + double(k) / parts) * across.width, grid.columns - 1.0),
                       std::min((j + double(l) / parts) * down.width, grid.rows - 1.0));
      if (!is_in(across, i, -1)) node(-1, l) = Grid::beyond(2, node(0, l), node(1, l), node(2, l));
      if (!is_in(across, i, parts + 1))
        node(parts + 1, l) =
            Grid::beyond(2, node(parts, l), node(parts - 1, l), node(parts - 2, l));
    }
    for (int k = -1; k <= parts + 1; ++k) {
      if (!is_in(down, j, -1)) node(k, -1) = Grid::beyond(2, node(k, 0), node(k, 1), node(k, 2));
      if (!is_in(down, j, parts + 1))
        node(k, parts + 1) =
            Grid::beyond(2, node(k, parts), node(k, parts - 1), node(k, parts - 2));
    }
    const auto calm = [&](int k, int l) {  // at a node between others
      return (k < 1 || k >= parts ||
              grid.calm(node(k - 2, l), node(k - 1, l), node(k, l), node(k + 1, l),
                        node(k + 2, l))) &&
             (l < 1 || l >= parts ||
              grid.calm(node(k, l - 2), node(k, l - 1), node(k, l), node(k, l + 1),
                        node(k, l + 2)));
    };
    const auto first = [](const Axis& axis, int cell, int part) {
      return part == parts ? axis.first[std::size_t(cell + 1)]
                           : int(std::ceil((cell + double(part) / parts) * axis.width - 1e-9));
    };
    for (int b = 0; b < parts; ++b)
      for (int a = 0; a < parts; ++a) {
        const Bicubic surface([&](int k, int l) { return node(a + k, b + l); });
        const int x0 = first(across, i, a), x1 = first(across, i, a + 1);
        const int y0 = first(down, j, b), y1 = first(down, j, b + 1);
        const double middle =
            evaluate(std::min((i + (a + 0.5) / parts) * across.width, grid.columns - 1.0),
                     std::min((j + (b + 0.5) / parts) * down.width, grid.rows - 1.0));
        if (grid.agrees(at(surface.along_u(0.5), 0.5), middle) && calm(a, b) && calm(a + 1, b) &&
            calm(a, b + 1) && calm(a + 1, b + 1))
          put(surface, x0, y0, x1, y1, {across.width, i, parts, a}, {down.width, j, parts, b});
        else
          refine(x0, y0, x1, y1);
      }
  }

  /// Where pixels are in a part of a cell along one axis, in units of the part.
  struct Parameter {
    double width;
    int cell, parts = 1, part = 0;

    double at(int pixel) const { return parts * (pixel / width - cell) - part; }
    double a_pixel() const { return parts / width; }
  };

  /// The pixels from x0 to before x1, y0 to before y1 from a surface.
  void put(const Bicubic& surface, int x0, int y0, int x1, int y1, const Parameter& u,
           const Parameter& v) {
    const float t0 = float(u.at(x0)), dt = float(u.a_pixel());
    if (!grid.out) {
      SkyPatch patch{.x0 = x0, .y0 = y0, .x1 = x1 - 1, .y1 = y1 - 1, .u0 = t0, .du = dt};
      patch.v0 = float(v.at(y0));
      patch.dv = float(v.a_pixel());
      patch.coefficient = surface.coefficients();
      patches.push_back(patch);
      return;
    }
    for (int y = y0; y < y1; ++y) {
      const auto c = surface.along_u(v.at(y));
      const float c0 = float(c[0]), c1 = float(c[1]), c2 = float(c[2]), c3 = float(c[3]);
      float* to = grid.out + std::size_t(y) * std::size_t(grid.columns) + x0;
      for (int k = 0; k < x1 - x0; ++k) {
        const float t = t0 + dt * float(k);
        to[k] = c0 + t * (c1 + t * (c2 + t * c3));
      }
    }
  }

  /// The pixels from x0 to before x1, y0 to before y1.
  void refine(int x0, int y0, int x1, int y1) {
    const double a = evaluate(x0, y0), b = evaluate(x1 - 1, y0);
    refine(x0, y0, x1 - 1, y1 - 1, a, b, evaluate(x0, y1 - 1), evaluate(x1 - 1, y1 - 1));
  }

  /// The pixels x0..x1, y0..y1 (inclusive) from the function's values at their corners, or from
  /// quarters of them.
  void refine(int x0, int y0, int x1, int y1, double f00, double f10, double f01, double f11) {
    const int w = x1 - x0, h = y1 - y0;
    if (w <= 1 && h <= 1) {
      if (!grid.out) return add_bilinear(x0, y0, x1, y1, f00, f10, f01, f11);
      set(x0, y0, f00), set(x1, y0, f10), set(x0, y1, f01), set(x1, y1, f11);
      return;
    }
    const int xm = x0 + w / 2, ym = y0 + h / 2;
    const double middle = evaluate(xm, ym);
    const double top = evaluate(xm, y0), bottom = evaluate(xm, y1);
    const double left = evaluate(x0, ym), right = evaluate(x1, ym);
    const double u = w ? double(xm - x0) / w : 0.0, v = h ? double(ym - y0) / h : 0.0;
    const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
    if (w <= 16 && h <= 16 && grid.agrees(mix(f00, f10, u), top) &&
        grid.agrees(mix(f01, f11, u), bottom) && grid.agrees(mix(f00, f01, v), left) &&
        grid.agrees(mix(f10, f11, v), right) &&
        grid.agrees(mix(mix(f00, f10, u), mix(f01, f11, u), v), middle)) {
      if (!grid.out) return add_bilinear(x0, y0, x1, y1, f00, f10, f01, f11);
      for (int y = y0; y <= y1; ++y) {
        const double b = h ? double(y - y0) / h : 0.0;
        const double first = mix(f00, f01, b), last = mix(f10, f11, b);
        for (int x = x0; x <= x1; ++x) set(x, y, w ? mix(first, last, double(x - x0) / w) : first);
      }
      return;
    }
    refine(x0, y0, xm, ym, f00, top, left, middle);
    refine(xm, y0, x1, ym, top, f10, middle, right);
    refine(x0, ym, xm, y1, left, middle, f01, bottom);
    refine(xm, ym, x1, y1, middle, right, bottom, f11);
  }

  void add_bilinear(int x0, int y0, int x1, int y1, double f00, double f10, double f01,
                    double f11) {
    SkyPatch patch{.x0 = x0, .y0 = y0, .x1 = x1, .y1 = y1};
    patch.du = x1 > x0 ? 1.0f / float(x1 - x0) : 0.0f;
    patch.dv = y1 > y0 ? 1.0f / float(y1 - y0) : 0.0f;
    patch.coefficient = {float(f00), float(f10 - f00), 0,
                         0,          float(f01 - f00), float(f11 - f10 - f01 + f00)};
    patches.push_back(patch);
  }

  void set(int x, int y, double value) {
    grid.out[std::size_t(y) * std::size_t(grid.columns) + std::size_t(x)] = float(value);
  }
};

std::size_t visit_cells(Grid& grid, Threads& threads, std::vector<SkyPatch>* patches) {
  grid.make_nodes(threads);
  const auto cell_rows = std::size_t(grid.down.cells);
  std::vector<std::size_t> evaluations(cell_rows);
  std::vector<std::vector<SkyPatch>> patches_of_row(cell_rows);
  threads.for_ranges(cell_rows, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t j = first; j < last; ++j) {
      Piece piece{grid};
      for (int i = 0; i < grid.across.cells; ++i) piece.fill_cell(i, int(j));
      evaluations[j] = piece.evaluations;
      patches_of_row[j] = std::move(piece.patches);
    }
  });
  if (patches)
    for (const auto& row : patches_of_row) patches->insert(patches->end(), row.begin(), row.end());
  const std::size_t nodes = std::size_t(grid.across.cells + 1) * (cell_rows + 1);
  return std::accumulate(evaluations.begin(), evaluations.end(), nodes);
}

}  // namespace

std::size_t fill_from_grid(int columns, int rows, const PixelFunction& f, double tolerance,
                           float* out, Threads& threads) {
  if (columns <= 0 || rows <= 0) return 0;
  Grid grid{columns, rows, f, tolerance, out};
  return visit_cells(grid, threads, nullptr);
}

std::vector<SkyPatch> patches_of_grid(int columns, int rows, const PixelFunction& f,
                                      double tolerance, Threads& threads) {
  std::vector<SkyPatch> patches;
  if (columns <= 0 || rows <= 0) return patches;
  Grid grid{columns, rows, f, tolerance, nullptr};
  visit_cells(grid, threads, &patches);
  return patches;
}

void fill_every_pixel(int columns, int rows, const PixelFunction& f, float* out, Threads& threads) {
  threads.for_ranges(std::size_t(rows), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < columns; ++x)
        out[y * std::size_t(columns) + std::size_t(x)] = float(f(double(x), double(y)));
  });
}

}  // namespace dmise
