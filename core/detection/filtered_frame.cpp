#include "core/detection/filtered_frame.h"

#include <cstddef>

namespace dmise {
namespace {

constexpr int cell_px = 48;
constexpr int least_pixels = 200;  // of a cell, that are not hidden

struct Level {
  float mean = 0.0f, scatter = 1.0f;
};

/// Mean and scatter of the pixels that are not hidden; those of too few are taken as of no light.
Level level_of(const FilteredFrame& frame, int x0, int y0) {
  std::int64_t count = 0, sum = 0, squares = 0;
  for (int y = y0; y < std::min(y0 + cell_px, frame.rows); ++y)
    for (int x = x0; x < std::min(x0 + cell_px, frame.columns); ++x) {
      const std::int64_t v = frame.row(y)[x];
      count += v != 0;
      sum += v;
      squares += v * v;
    }
  if (count < least_pixels) return {};
  const double mean = double(sum) / double(count);
  const double variance = double(squares) / double(count) - mean * mean;
  return {float(mean), float(std::max(1.0, std::sqrt(variance) / FilteredFrame::steps))};
}

}  // namespace

void FilteredFrame::flatten(Threads& threads) {
  const int across = (columns + cell_px - 1) / cell_px, down = (rows + cell_px - 1) / cell_px;
  std::vector<Level> mesh(std::size_t(across) * std::size_t(down));
  threads.for_ranges(std::size_t(down), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      for (int i = 0; i < across; ++i)
        mesh[j * std::size_t(across) + std::size_t(i)] =
            level_of(*this, i * cell_px, int(j) * cell_px);
  });
  const auto at = [&](int i, int j) {
    return mesh[std::size_t(std::clamp(j, 0, down - 1)) * std::size_t(across) +
                std::size_t(std::clamp(i, 0, across - 1))];
  };
  threads.for_ranges(std::size_t(rows), cell_px, [&](std::size_t begin, std::size_t end) {
    std::vector<Level> line(std::size_t(across) + 2);
    for (int y = int(begin); y < int(end); ++y) {
      const float v = (float(y) + 0.5f) / cell_px - 0.5f;
      const int j = int(std::floor(v));
      const float below = v - float(j);
      for (int i = -1; i <= across; ++i) {
        const Level a = at(i, j), b = at(i, j + 1);
        line[std::size_t(i + 1)] = {a.mean + below * (b.mean - a.mean),
                                    1 / (a.scatter + below * (b.scatter - a.scatter))};
      }
      std::int16_t* pixels = row(y);
      // From the middle of one cell to that of the next, all is linear.
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const int x0 = std::max(0, int(i) * cell_px - cell_px / 2);
        const int x1 = std::min(columns, int(i) * cell_px + cell_px / 2);
        const Level a = line[i], b = line[i + 1];
        for (int x = x0; x < x1; ++x) {
          const float right = (float(x) + 0.5f) / cell_px + 0.5f - float(i);
          const float value = (float(pixels[x]) - a.mean - right * (b.mean - a.mean)) *
                              (a.scatter + right * (b.scatter - a.scatter));
          const std::int16_t step = step_of(value / float(steps), (x + y) % 2 != 0);
          pixels[x] = pixels[x] == 0 ? std::int16_t(0) : step;
        }
      }
    }
  });
}

}  // namespace dmise
