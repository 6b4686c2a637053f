#include "core/detection/pixels/filtered_frame.h"

#include "core/base/numeric/quantile.h"
#include "core/base/numeric/simd_level.h"
#include "core/detection/pixels/filter_kernels.h"

#include <array>
#include <cstddef>
#include <numeric>

namespace dmise {
namespace {

constexpr int cell_px = 48;
constexpr int min_pixels = 200;  // that are not hidden in a cell
constexpr double min_scatter = 0.85;

/// What is not hidden in a cell, by quantiles: a streak does not count. Both scatters are 1 and the
/// middle 0 of cells with too few pixels.
struct Level {
  double middle = 0.0, below = 1.0, above = 1.0;
  float hidden = 0.0f;
};

Level level_of(const FilteredFrame& frame, int x0, int y0, const BitMask* lit) {
  constexpr int most = FilteredFrame::most;
  const int x1 = std::min(x0 + cell_px, frame.columns), y1 = std::min(y0 + cell_px, frame.rows);
  // Pixels beside each other are often of one step: counts of each in turn don't wait for another.
  constexpr int turns = 4, bins = 2 * most + 2;
  std::array<std::array<int, bins>, turns> counts{};
  for (int y = y0; y < y1; ++y) {
    const std::int8_t* row = frame.row(y);
    int x = x0;
    for (; x + turns <= x1; x += turns)
      for (int k = 0; k < turns; ++k) ++counts[std::size_t(k)][std::size_t(row[x + k] + most)];
    for (; x < x1; ++x) ++counts[0][std::size_t(row[x] + most)];
  }
  std::array<int, bins> histogram{};
  for (const auto& some : counts)
    for (std::size_t i = 0; i < bins; ++i) histogram[i] += some[i];
  const int all = std::accumulate(histogram.begin(), histogram.end(), 0);
  int without_light = all - histogram[std::size_t(most)];
  if (lit)
    for (int y = y0; y < y1; ++y)
      lit->for_set(y, x0, x1, [&](int x) { without_light -= frame.row(y)[x] != 0; });
  histogram[std::size_t(most)] = 0;  // hidden
  const int count = std::accumulate(histogram.begin(), histogram.end(), 0);
  const float hidden = 1.0f - float(without_light) / float(all);
  if (count < min_pixels) return {.hidden = hidden};
  // Within a step the pixels are taken as even, +-1 as one step and a half wide: 0 is hidden.
  const auto quantile = [&](double share) {
    double left = share * count;
    for (int v = -most; v <= most; ++v) {
      const double here = histogram[std::size_t(v + most)];
      if (left > here || here == 0) {
        left -= here;
        continue;
      }
      const double low = v == 1 ? 0.0 : v - 0.5, high = v == -1 ? 0.0 : v + 0.5;
      return low + (high - low) * left / here;
    }
    return double(most);
  };
  const double middle = quantile(0.5);
  return {middle, (middle - quantile(0.1587)) / FilteredFrame::steps,
          (quantile(0.8413) - middle) / FilteredFrame::steps, hidden};
}

/// Cells by what is in them and their neighbours: the median of the middles, so that a streak moves
/// none, and the mean of the scatters. That above the middle counts if it is larger: faint stars
/// only add light.
std::vector<FilteredFrame::Cell> smoothed(const std::vector<Level>& levels, int across, int down) {
  constexpr double sure = 0.02;  // difference that noise makes
  std::vector<FilteredFrame::Cell> mesh;
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i) {
      std::vector<double> middles;
      double below = 0.0, above = 0.0;
      for (int y = std::max(0, j - 1); y <= std::min(down - 1, j + 1); ++y)
        for (int x = std::max(0, i - 1); x <= std::min(across - 1, i + 1); ++x) {
          const Level& l = levels[std::size_t(y) * std::size_t(across) + std::size_t(x)];
          middles.push_back(l.middle);
          below += l.below;
          above += l.above;
        }
      const auto n = double(middles.size());
      const double scatter = std::max(0.5 * (below + above) / n, above / n - sure);
      mesh.push_back({float(median_of(std::move(middles))), float(std::max(min_scatter, scatter)),
                      levels[std::size_t(j) * std::size_t(across) + std::size_t(i)].hidden});
    }
  return mesh;
}

/// Different in rows beside each other, so that no line meets the same again and again.
std::uint32_t dither_of_row(int y) {
  std::uint32_t h = std::uint32_t(y) * 0x85EBCA6Bu;
  h = (h ^ (h >> 15)) * 0xC2B2AE35u;
  return h ^ (h >> 13);
}

}  // namespace

void FilteredFrame::flatten(Threads& threads, const BitMask* lit) {
  const int across = (columns + cell_px - 1) / cell_px, down = (rows + cell_px - 1) / cell_px;
  std::vector<Level> levels(std::size_t(across) * std::size_t(down));
  threads.for_ranges(std::size_t(down), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      for (int i = 0; i < across; ++i)
        levels[j * std::size_t(across) + std::size_t(i)] =
            level_of(*this, i * cell_px, int(j) * cell_px, lit);
  });
  mesh = smoothed(levels, across, down);
  const auto flatten_steps =
      kernel_of(best_simd_level(), sse2::flatten_steps, avx2::flatten_steps, avx512::flatten_steps);
  const auto at = [&](int i, int j) {
    return mesh[std::size_t(std::clamp(j, 0, down - 1)) * std::size_t(across) +
                std::size_t(std::clamp(i, 0, across - 1))];
  };
  threads.for_ranges(std::size_t(rows), cell_px, [&](std::size_t begin, std::size_t end) {
    std::vector<Cell> line(std::size_t(across) + 2);
    for (int y = int(begin); y < int(end); ++y) {
      const float v = (float(y) + 0.5f) / cell_px - 0.5f;
      const int j = int(std::floor(v));
      const float below = v - float(j);
      for (int i = -1; i <= across; ++i) {
        const Cell a = at(i, j), b = at(i, j + 1);
        line[std::size_t(i + 1)] = {a.middle + below * (b.middle - a.middle),
                                    1 / (a.scatter + below * (b.scatter - a.scatter))};
      }
      std::int8_t* pixels = row(y);
      // From the middle of one cell to that of the next, all is linear.
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const int x0 = std::max(0, int(i) * cell_px - cell_px / 2);
        const int x1 = std::min(columns, int(i) * cell_px + cell_px / 2);
        const Cell a = line[i], b = line[i + 1];
        if (x1 <= x0) continue;
        const float right = (float(x0) + 0.5f) / cell_px + 0.5f - float(i);
        const auto along = [&](float first, float second) {
          return std::array{first + right * (second - first), (second - first) / cell_px};
        };
        flatten_steps(pixels + x0, std::size_t(x1 - x0), (x0 + y) % 2 != 0,
                      dither_of_row(y) + std::uint32_t(x0) * dither_per_pixel,
                      along(a.middle, b.middle).data(), along(a.scatter, b.scatter).data());
      }
    }
  });
}

FilteredFrame::Cell FilteredFrame::cell_at(double x_px, double y_px) const {
  if (mesh.empty()) return {};
  const int across = (columns + cell_px - 1) / cell_px, down = (rows + cell_px - 1) / cell_px;
  const int i = int(std::clamp(x_px / cell_px, 0.0, across - 1.0));
  const int j = int(std::clamp(y_px / cell_px, 0.0, down - 1.0));
  return mesh[std::size_t(j) * std::size_t(across) + std::size_t(i)];
}

}  // namespace dmise
