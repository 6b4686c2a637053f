#include "core/detection/pixels/bent_sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/algebra/small_matrix.h"
#include "core/base/numeric/quantile.h"

namespace dmise {
namespace {

constexpr int fine = 4;  // cells of the refined mesh in one
// Bend in units of a pixel's noise from which on it is significant, and from which on all of it
// is taken: straight lines miss the level by an eighth of it.
constexpr float min_bend = 0.3f, sure_bend = 0.6f;

const SkyBend& bend_at(const std::vector<SkyBend>& bends, const CellMesh& mesh, int i, int j) {
  return bends[std::size_t(std::clamp(j, 0, mesh.down - 1)) * std::size_t(mesh.across) +
               std::size_t(std::clamp(i, 0, mesh.across - 1))];
}

bool is_bent(const SkyBend& b) { return b.xx != 0.0f || b.xy != 0.0f || b.yy != 0.0f; }

/// The level of a cell by a parabola through those around it, and their scatter around that. Cells
/// off by more than three times the scatter have little weight.
struct CellsAround {
  float level, scatter;
};

CellsAround around(const CellMesh& raw, float sigma, int i, int j) {
  constexpr int reach = 2, rounds = 4;
  constexpr std::size_t terms = 6;
  constexpr double min_scatter = 0.05;  // in a pixel's noise
  struct Cell {
    std::array<double, terms> powers;
    double value, weight = 1.0, off = 0.0;
  };
  std::vector<Cell> cells;
  for (int v = std::max(-reach, -j); v <= std::min(reach, raw.down - 1 - j); ++v)
    for (int u = std::max(-reach, -i); u <= std::min(reach, raw.across - 1 - i); ++u)
      cells.push_back(
          {.powers = {1.0, double(u), double(v), double(u * u), double(u * v), double(v * v)},
           .value = raw.cell(i + u, j + v)});
  SmallVector parabola{};
  double scatter = 0.0;
  for (int round = 0; round < rounds; ++round) {
    NormalEquations equations;
    for (const Cell& c : cells) equations.add(c.weight, c.powers, c.value);
    auto& [matrix, right] = equations;
    for (std::size_t a = 0; a < terms; ++a) matrix[a][a] += 1e-9;
    if (!cholesky(matrix, terms)) break;
    parabola = solve(matrix, right, terms);
    std::vector<double> sizes;
    for (Cell& c : cells) {
      c.off = c.value - std::inner_product(c.powers.begin(), c.powers.end(), parabola.begin(), 0.0);
      sizes.push_back(std::abs(c.off));
    }
    scatter = std::max(1.4826 * middle_of(std::move(sizes)), min_scatter * double(sigma));
    for (Cell& c : cells) {
      const double in_scatter = c.off / (3 * scatter);
      c.weight = 1 / (1 + in_scatter * in_scatter * in_scatter * in_scatter);
    }
  }
  return {float(parabola[0]), float(scatter)};
}

}  // namespace

std::vector<SkyBend> sky_bends(const CellMesh& level, const CellMesh& sigma) {
  std::vector<SkyBend> out(level.values.size());
  const bool wide = level.across > 2, high = level.down > 2;
  for (int j = 0; j < level.down; ++j)
    for (int i = 0; i < level.across; ++i) {
      // At the border the bend is the next cell's.
      const int u = wide ? std::clamp(i, 1, level.across - 2) : i;
      const int v = high ? std::clamp(j, 1, level.down - 2) : j;
      const float twice = 2 * level.cell(u, v);
      SkyBend bend;
      if (wide) bend.xx = level.cell(u - 1, v) + level.cell(u + 1, v) - twice;
      if (high) bend.yy = level.cell(u, v - 1) + level.cell(u, v + 1) - twice;
      if (wide && high)
        bend.xy = 0.25f * (level.cell(u + 1, v + 1) - level.cell(u - 1, v + 1) -
                           level.cell(u + 1, v - 1) + level.cell(u - 1, v - 1));
      const float most = std::max({std::abs(bend.xx), std::abs(bend.xy), std::abs(bend.yy)});
      const float in_noise = most / sigma.cell(u, v);
      const float share = std::clamp((in_noise - min_bend) / (sure_bend - min_bend), 0.0f, 1.0f);
      out[std::size_t(j) * std::size_t(level.across) + std::size_t(i)] = {
          share * bend.xx, share * bend.xy, share * bend.yy};
    }
  return out;
}

bool is_bent(const std::vector<SkyBend>& bends) {
  return std::ranges::any_of(bends, [](const SkyBend& b) { return is_bent(b); });
}

CellMesh median_of_cells(const CellMesh& raw) {
  CellMesh out = raw;
  std::vector<float> near;
  for (int j = 0; j < raw.down; ++j)
    for (int i = 0; i < raw.across; ++i) {
      near.clear();
      const int wide = std::min({1, i, raw.across - 1 - i}),
                high = std::min({1, j, raw.down - 1 - j});
      for (int v = -high; v <= high; ++v)
        for (int u = -wide; u <= wide; ++u) near.push_back(raw.cell(i + u, j + v));
      out.values[std::size_t(j) * std::size_t(raw.across) + std::size_t(i)] =
          value_of_rank(near, near.size() / 2);  // an odd number
    }
  return out;
}

CellMesh without_sources(const CellMesh& raw, const CellMesh& medians, const CellMesh& sigma,
                         const std::vector<SkyBend>& bends) {
  CellMesh out = medians;
  for (int j = 0; j < raw.down; ++j)
    for (int i = 0; i < raw.across; ++i) {
      const auto cell = std::size_t(j) * std::size_t(raw.across) + std::size_t(i);
      if (!is_bent(bends[cell])) continue;
      const auto [level, scatter] = around(raw, sigma.values[cell], i, j);
      const float own = raw.values[cell];
      out.values[cell] = std::abs(own - level) < 3 * scatter ? own : level;
    }
  return out;
}

CellMesh refined(const CellMesh& level, const std::vector<SkyBend>& bends, int columns, int rows) {
  CellMesh out(columns, rows, fine * level.across, fine * level.down);
  // The place of a fine cell: a coarse one, and the weight of the next.
  const auto place = [](int k, int cells) {
    const float at = (float(k) + 0.5f) / fine - 0.5f;
    const int cell = std::clamp(int(std::floor(at)), 0, std::max(cells - 2, 0));
    return std::pair{cell, cells > 1 ? at - float(cell) : 0.0f};
  };
  for (int y = 0; y < out.down; ++y) {
    const auto [j, v] = place(y, level.down);
    for (int x = 0; x < out.across; ++x) {
      const auto [i, u] = place(x, level.across);
      const std::array<float, 4> weights{(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
      float value = 0.0f, xx = 0.0f, yy = 0.0f;
      for (int k = 0; k < 4; ++k) {
        const SkyBend& bend = bend_at(bends, level, i + k % 2, j + k / 2);
        const float weight = weights[std::size_t(k)];
        value += weight * (level.cell(i + k % 2, j + k / 2) - (bend.xx + bend.yy) / 24);
        xx += weight * bend.xx;
        yy += weight * bend.yy;
      }
      out.values[std::size_t(y) * std::size_t(out.across) + std::size_t(x)] =
          value - 0.5f * (xx * u * (1 - u) + yy * v * (1 - v));
    }
  }
  return out;
}

}  // namespace dmise
