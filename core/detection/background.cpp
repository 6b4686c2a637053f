#include "core/detection/background.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace dmise {
namespace {

struct Sky {
  float level = 0.0f, sigma = 0.0f;
};

/// Median of integers as if each were spread evenly over its bin: finer than one count.
double spread_median(const std::vector<std::uint32_t>& histogram, std::size_t low, std::size_t high,
                     double count) {
  double below = 0.0;
  for (std::size_t i = low; i < high; ++i) {
    if (below + histogram[i] >= 0.5 * count && histogram[i] > 0)
      return double(i) - 0.5 + (0.5 * count - below) / histogram[i];
    below += histogram[i];
  }
  return double(low);
}

/// `values` is not empty.
Sky clipped_sky(const std::vector<std::uint16_t>& values) {
  // A quarter of them is enough to start from.
  constexpr std::size_t least = 256;
  std::vector<std::uint16_t> some;
  const std::size_t every = values.size() < 4 * least ? 1 : 4;
  for (std::size_t i = 0; i < values.size(); i += every) some.push_back(values[i]);
  const auto quantile = [&](double q) {
    const auto at = some.begin() + std::ptrdiff_t(q * double(some.size() - 1));
    std::nth_element(some.begin(), at, some.end());
    return double(*at);
  };
  const double first_median = quantile(0.5);
  const double low = quantile(0.1587);
  double sigma = std::max(first_median - low, 0.5), centre = first_median;
  // The rest works on a histogram of the values near the median.
  const double reach = 6 * sigma + 2;
  const auto base = std::int64_t(std::max(0.0, std::floor(centre - reach)));
  const std::size_t bins = std::size_t(2 * reach) + 2;
  std::vector<std::uint32_t> histogram(bins, 0);
  for (const auto v : values) {
    const std::int64_t bin = std::int64_t(v) - base;
    if (bin >= 0 && bin < std::int64_t(bins)) ++histogram[std::size_t(bin)];
  }
  double mean = centre, median = centre;
  for (int pass = 0; pass < 8; ++pass) {
    const auto edge = [&](double v) {
      return std::size_t(std::clamp(std::ceil(v - double(base)), 0.0, double(bins)));
    };
    const std::size_t from = edge(centre - 3 * sigma), to = edge(centre + 3 * sigma + 1e-9);
    double n = 0, sum = 0, squares = 0;
    for (std::size_t i = from; i < to; ++i) {
      n += histogram[i];
      sum += histogram[i] * double(i);
      squares += histogram[i] * double(i) * double(i);
    }
    if (n < 2) break;
    mean = sum / n + double(base);
    median = spread_median(histogram, from, to, n) + double(base);
    const double variance = std::max(squares / n - (sum / n) * (sum / n), 0.0);
    const double before = sigma;
    sigma = std::max(std::sqrt(variance) / 0.98658, 0.3);  // of a normal cut at 3 sigma
    centre = median;
    if (std::abs(sigma - before) < 1e-3 * before) break;
  }
  const double level = std::abs(mean - median) < 0.3 * sigma ? 2.5 * median - 1.5 * mean : median;
  return {float(level), float(sigma)};
}

/// Median of each cell and its neighbours; at the frame's edges only neighbours with an opposite
/// count, so that gradients are preserved.
std::vector<float> median_3x3(const std::vector<float>& mesh, int columns, int rows) {
  std::vector<float> out(mesh.size()), near;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      near.clear();
      const int wide = std::min({1, i, columns - 1 - i}), high = std::min({1, j, rows - 1 - j});
      for (int v = j - high; v <= j + high; ++v)
        for (int u = i - wide; u <= i + wide; ++u)
          near.push_back(mesh[std::size_t(v * columns + u)]);
      const auto middle = near.begin() + std::ptrdiff_t(near.size() / 2);  // an odd number
      std::nth_element(near.begin(), middle, near.end());
      out[std::size_t(j * columns + i)] = *middle;
    }
  return out;
}

float median_of(std::vector<float> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Background::Between Background::between(int pixel, int pixels, int cells) {
  const float place = (float(pixel) + 0.5f) * float(cells) / float(pixels) - 0.5f;
  const int cell = std::clamp(int(std::floor(place)), 0, std::max(0, cells - 2));
  return {cell, cells > 1 ? place - float(cell) : 0.0f};  // extrapolates beyond the outer centres
}

Background::Background(const CountImage& counts, int cell_px, Threads& threads)
    : columns_(counts.columns),
      rows_(counts.rows),
      mesh_columns_(std::max(1, (counts.columns + cell_px / 2) / cell_px)),
      mesh_rows_(std::max(1, (counts.rows + cell_px / 2) / cell_px)) {
  for (int x = 0; x < columns_; ++x) across_.push_back(between(x, columns_, mesh_columns_));
  const std::size_t cells = std::size_t(mesh_columns_) * std::size_t(mesh_rows_);
  std::vector<float> level(cells), sigma(cells);
  const auto measure = [&](std::size_t cell, bool flatten, std::vector<std::uint16_t>& values) {
    const Area area = area_of(cell);
    values.clear();
    for (int y = area.y0; y <= area.y1; ++y) {
      const std::uint16_t* from = counts.row(y);
      if (!flatten) {
        values.insert(values.end(), from + area.x0, from + area.x1 + 1);
        continue;
      }
      const Between v = between(y, rows_, mesh_rows_);
      for (int x = area.x0; x <= area.x1; ++x) {
        const float flat = float(from[x]) - at(level_, x, v) + level_[cell];
        values.push_back(std::uint16_t(std::clamp(flat + 0.5f, 0.0f, 65535.0f)));
      }
    }
    const Sky sky = clipped_sky(values);
    level[cell] = sky.level;
    sigma[cell] = sky.sigma;
  };
  const auto measure_all = [&](bool only_sloped) {
    threads.for_ranges(cells, std::size_t(mesh_columns_), [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint16_t> values;
      for (std::size_t cell = begin; cell < end; ++cell)
        if (!only_sloped || is_sloped(cell)) measure(cell, only_sloped, values);
    });
    level_ = median_3x3(level, mesh_columns_, mesh_rows_);
    sigma_ = median_3x3(sigma, mesh_columns_, mesh_rows_);
  };
  measure_all(false);
  measure_all(true);
}

Background::Area Background::area_of(std::size_t cell) const {
  const auto i = std::int64_t(cell) % mesh_columns_, j = std::int64_t(cell) / mesh_columns_;
  return {int(i * columns_ / mesh_columns_), int(j * rows_ / mesh_rows_),
          int((i + 1) * columns_ / mesh_columns_) - 1, int((j + 1) * rows_ / mesh_rows_) - 1};
}

float Background::level_of_cell(int i, int j) const {
  return level_[std::size_t(std::clamp(j, 0, mesh_rows_ - 1)) * std::size_t(mesh_columns_) +
                std::size_t(std::clamp(i, 0, mesh_columns_ - 1))];
}

bool Background::is_sloped(std::size_t cell) const {
  const int i = int(cell) % mesh_columns_, j = int(cell) / mesh_columns_;
  const float slope = std::hypot(0.5f * (level_of_cell(i + 1, j) - level_of_cell(i - 1, j)),
                                 0.5f * (level_of_cell(i, j + 1) - level_of_cell(i, j - 1)));
  return slope * slope > 0.5f * sigma_[cell] * sigma_[cell];
}

std::vector<Background::Area> Background::bent_cells(double share) const {
  std::vector<Area> out;
  for (std::size_t cell = 0; cell < level_.size(); ++cell) {
    // At the border, where levels are extrapolated, the bend is the next cell's.
    const int i = std::clamp(int(cell) % mesh_columns_, 1, std::max(mesh_columns_ - 2, 1));
    const int j = std::clamp(int(cell) / mesh_columns_, 1, std::max(mesh_rows_ - 2, 1));
    const float middle = 2 * level_of_cell(i, j);
    const float across = level_of_cell(i - 1, j) + level_of_cell(i + 1, j) - middle;
    const float down = level_of_cell(i, j - 1) + level_of_cell(i, j + 1) - middle;
    if (std::max(std::abs(across), std::abs(down)) > 8 * share * sigma_[cell])
      out.push_back(area_of(cell));
  }
  return out;
}

float Background::at(const std::vector<float>& mesh, int x, const Between& v) const {
  const Between u = across_[std::size_t(x)];
  const float* above = mesh.data() + std::size_t(v.cell) * std::size_t(mesh_columns_) + u.cell;
  const float* below = mesh_rows_ > 1 ? above + mesh_columns_ : above;
  const int right = mesh_columns_ > 1 ? 1 : 0;
  const float one = above[0] + v.next * (below[0] - above[0]);
  const float next = above[right] + v.next * (below[right] - above[right]);
  return one + u.next * (next - one);
}

void Background::row(const std::vector<float>& mesh, int y, float* out) const {
  const Between v = between(y, rows_, mesh_rows_);
  const float* above = mesh.data() + std::size_t(v.cell) * std::size_t(mesh_columns_);
  const float* below = mesh_rows_ > 1 ? above + mesh_columns_ : above;
  std::vector<float> line(std::size_t(mesh_columns_) + 1);
  for (int i = 0; i < mesh_columns_; ++i)
    line[std::size_t(i)] = above[i] + v.next * (below[i] - above[i]);
  line.back() = line[std::size_t(mesh_columns_) - 1];
  for (int x = 0; x < columns_; ++x) {
    const Between u = across_[std::size_t(x)];
    const float one = line[std::size_t(u.cell)];
    out[x] = one + u.next * (line[std::size_t(u.cell) + 1] - one);
  }
}

float Background::median_level_dn() const { return median_of(level_); }
float Background::median_sigma_dn() const { return median_of(sigma_); }

}  // namespace dmise
