#include "core/detection/filtered_frame.h"

#include <array>
#include <cstddef>
#include <numeric>

namespace dmise {
namespace {

constexpr int cell_px = 48;
constexpr int least_pixels = 200;  // of a cell, that are not hidden

/// Median and scatter of the pixels that are not hidden, by quantiles: a streak does not count. The
/// scatter is the larger of both sides: faint stars only add light. Those of too few pixels are
/// taken as of no light.
FilteredFrame::Cell level_of(const FilteredFrame& frame, int x0, int y0, const PixelMask* lit) {
  constexpr int most = FilteredFrame::most;
  std::array<int, 2 * most + 1> histogram{};
  for (int y = y0; y < std::min(y0 + cell_px, frame.rows); ++y) {
    const std::int16_t* row = frame.row(y);
    for (int x = x0; x < std::min(x0 + cell_px, frame.columns); ++x)
      ++histogram[std::size_t(row[x] + most)];
  }
  const int all = std::accumulate(histogram.begin(), histogram.end(), 0);
  int without_light = all - histogram[std::size_t(most)];
  if (lit)
    for (int y = y0; y < std::min(y0 + cell_px, frame.rows); ++y)
      for (int x = x0; x < std::min(x0 + cell_px, frame.columns); ++x)
        without_light -= frame.row(y)[x] != 0 && lit->at(x, y);
  histogram[std::size_t(most)] = 0;  // hidden
  const int count = std::accumulate(histogram.begin(), histogram.end(), 0);
  const float hidden = 1.0f - float(without_light) / float(all);
  if (count < least_pixels) return {.hidden = hidden};
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
  const double scatter = std::max(middle - quantile(0.1587), quantile(0.8413) - middle);
  return {float(middle), float(scatter / FilteredFrame::steps), hidden};
}

/// Averages the scatter over 3 x 3 cells, where it is more than noise.
void smooth_scatter(std::vector<FilteredFrame::Cell>& mesh, int across, int down) {
  const auto raw = mesh;
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i) {
      float sum = 0.0f;
      int cells = 0;
      for (int y = std::max(0, j - 1); y <= std::min(down - 1, j + 1); ++y)
        for (int x = std::max(0, i - 1); x <= std::min(across - 1, i + 1); ++x, ++cells)
          sum += raw[std::size_t(y) * std::size_t(across) + std::size_t(x)].scatter;
      mesh[std::size_t(j) * std::size_t(across) + std::size_t(i)].scatter =
          std::max(1.0f, sum / float(cells));
    }
}

}  // namespace

void FilteredFrame::flatten(Threads& threads, const PixelMask* lit) {
  const int across = (columns + cell_px - 1) / cell_px, down = (rows + cell_px - 1) / cell_px;
  mesh.assign(std::size_t(across) * std::size_t(down), {});
  threads.for_ranges(std::size_t(down), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      for (int i = 0; i < across; ++i)
        mesh[j * std::size_t(across) + std::size_t(i)] =
            level_of(*this, i * cell_px, int(j) * cell_px, lit);
  });
  smooth_scatter(mesh, across, down);
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
      std::int16_t* pixels = row(y);
      // From the middle of one cell to that of the next, all is linear.
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const int x0 = std::max(0, int(i) * cell_px - cell_px / 2);
        const int x1 = std::min(columns, int(i) * cell_px + cell_px / 2);
        const Cell a = line[i], b = line[i + 1];
        for (int x = x0; x < x1; ++x) {
          const float right = (float(x) + 0.5f) / cell_px + 0.5f - float(i);
          const float value = (float(pixels[x]) - a.middle - right * (b.middle - a.middle)) *
                              (a.scatter + right * (b.scatter - a.scatter));
          const std::int16_t step = step_of(value / float(steps), (x + y) % 2 != 0);
          pixels[x] = pixels[x] == 0 ? std::int16_t(0) : step;
        }
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
