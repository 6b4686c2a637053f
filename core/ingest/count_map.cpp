#include "core/ingest/count_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>

#include "core/base/numeric/quantile.h"
#include "core/base/numeric/rng.h"

namespace dmise {
namespace {

constexpr double max_count = 65535.0;
constexpr double sigma_of_quartiles = 0.7413;  // a normal distribution's, over their distance

/// At most about `most` of the values that are finite, evenly spread.
std::vector<double> sample(std::span<const double> values, std::size_t most) {
  std::vector<double> out;
  const std::size_t every = std::max<std::size_t>(1, values.size() / most);
  for (std::size_t i = 0; i < values.size(); i += every)
    if (std::isfinite(values[i])) out.push_back(values[i]);
  return out;
}

struct Range {
  double least, most;
  bool whole;  // all are whole numbers
};

Range range_of(std::span<const double> values) {
  Range r{INFINITY, -INFINITY, true};
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    r.least = std::min(r.least, v);
    r.most = std::max(r.most, v);
    r.whole = r.whole && v == std::floor(v);
  }
  return r;
}

/// Level and scatter of the sky in cells, for pixels without a value.
class SkyCells {
 public:
  SkyCells(std::span<const double> values, int columns)
      : columns_((columns + size - 1) / size),
        rows_((int(values.size() / std::size_t(columns)) + size - 1) / size),
        cells_(std::size_t(columns_) * std::size_t(rows_)) {
    std::vector<std::vector<double>> in(cells_.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::isfinite(values[i]))
        in[cell_of(int(i % std::size_t(columns)), int(i / std::size_t(columns)))].push_back(
            values[i]);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      if (in[c].size() >= min_values)
        cells_[c] = Sky{median_of(in[c]),
                        sigma_of_quartiles * (quantile_of(in[c], 0.75) - quantile_of(in[c], 0.25))};
    spread(values);
  }

  struct Sky {
    double level = 0.0, sigma = 0.0;
  };
  const Sky& at(int x, int y) const { return *cells_[cell_of(x, y)]; }

 private:
  static constexpr int size = 64;
  static constexpr std::size_t min_values = 64;

  std::size_t cell_of(int x, int y) const {
    return std::size_t(y / size) * std::size_t(columns_) + std::size_t(x / size);
  }
  /// Cells without enough values get the mean of their neighbours, from the outside in.
  void spread(std::span<const double> values) {
    if (std::none_of(cells_.begin(), cells_.end(), [](const auto& c) { return c.has_value(); })) {
      const auto all = sample(values, 1 << 20);
      cells_.assign(cells_.size(), Sky{median_of(all), 0.0});
    }
    while (std::any_of(cells_.begin(), cells_.end(), [](const auto& c) { return !c; })) {
      const auto before = cells_;
      for (int j = 0; j < rows_; ++j)
        for (int i = 0; i < columns_; ++i) {
          auto& cell = cells_[std::size_t(j * columns_ + i)];
          if (!cell) cell = mean_around(before, i, j);
        }
    }
  }
  std::optional<Sky> mean_around(const std::vector<std::optional<Sky>>& cells, int i, int j) const {
    Sky sum;
    int count = 0;
    for (int v = std::max(0, j - 1); v <= std::min(rows_ - 1, j + 1); ++v)
      for (int u = std::max(0, i - 1); u <= std::min(columns_ - 1, i + 1); ++u)
        if (const auto& near = cells[std::size_t(v * columns_ + u)]) {
          sum.level += near->level;
          sum.sigma += near->sigma;
          ++count;
        }
    if (count == 0) return std::nullopt;
    return Sky{sum.level / count, sum.sigma / count};
  }

  int columns_, rows_;
  std::vector<std::optional<Sky>> cells_;
};

std::uint16_t rounded(double count) {
  return std::uint16_t(std::lround(std::clamp(count, 0.0, max_count)));
}

}  // namespace

double pixel_noise(std::span<const double> values, int columns) {
  const std::size_t apart = columns > 8 ? 4 : 1;
  if (values.size() <= apart) return 0.0;
  const std::size_t every = std::max<std::size_t>(1, values.size() / (1 << 20));
  std::vector<double> differences;
  for (std::size_t i = apart; i < values.size(); i += every) {
    const double d = values[i] - values[i - apart];
    if (i % std::size_t(columns) >= apart && std::isfinite(d)) differences.push_back(std::abs(d));
  }
  if (differences.empty()) return 0.0;
  return sigma_of_median / std::sqrt(2.0) * median_of(std::move(differences));
}

CountMap common_step(std::span<const double> values) {
  constexpr std::size_t min_numbers = 4;  // that differ, of which a step can be told
  constexpr double sky_share = 0.5, share_on_step = 0.99;
  std::vector<std::size_t> pixels(std::size_t(max_count) + 1, 0);
  std::size_t finite = 0;
  for (const double v : values)
    if (std::isfinite(v)) ++finite, ++pixels[std::size_t(v)];
  std::vector<std::size_t> numbers;
  for (std::size_t v = 0; v < pixels.size(); ++v)
    if (pixels[v] > 0) numbers.push_back(v);
  std::ranges::stable_sort(numbers, std::greater(), [&](std::size_t v) { return pixels[v]; });
  if (numbers.size() < min_numbers) return {};
  // The most frequent numbers tell the step: values of few pixels may be anything.
  std::size_t step = 0, seen = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i >= min_numbers && double(seen) > sky_share * double(finite)) break;
    seen += pixels[numbers[i]];
    step =
        std::gcd(step, numbers[i] > numbers[0] ? numbers[i] - numbers[0] : numbers[0] - numbers[i]);
  }
  if (step <= 1) return {};
  const std::size_t zero = numbers[0] % step;
  std::size_t on_step = 0;
  for (std::size_t v = zero; v < pixels.size(); v += step) on_step += pixels[v];
  if (double(on_step) < share_on_step * double(finite)) return {};
  return {double(zero), double(step)};
}

CountMap choose_count_map(std::span<const double> values, int columns) {
  const Range range = range_of(values);
  if (range.whole && range.least >= 0 && range.most <= max_count) return common_step(values);
  const double width = range.most - range.least;
  if (range.whole && width <= max_count) return {range.least, 1.0};
  double step = pixel_noise(values, columns) / 16;
  if (range.whole) step = std::max(1.0, std::floor(step));
  const double median = median_of(sample(values, 1 << 20));
  // Without noise, and where the noise is lost in the numbers' own steps.
  if (!(step > std::abs(median) * 1e-12)) step = std::max(width / max_count, 1e-30);
  if (width <= max_count * step) return {range.least, step};
  const double down = std::min(median - range.least, 0.05 * max_count * step);
  return {range.whole ? std::floor(median - down) : median - down, step};
}

Ceiling find_ceiling(std::span<const double> values) {
  constexpr std::size_t min_pixels = 5;
  Ceiling top{-INFINITY, 0};
  std::size_t finite = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    ++finite;
    if (v > top.value) top = {v, 0};
    top.pixels += v == top.value;
  }
  // A level that much of the frame has is the sky, not a limit.
  if (top.pixels < min_pixels || top.pixels > finite / 4) top.pixels = 0;
  return top;
}

CountImage to_counts(std::span<const double> values, int columns, const CountMap& map,
                     PixelMask& unusable) {
  const int rows = int(values.size() / std::size_t(columns));
  CountImage counts(columns, rows);
  std::vector<std::size_t> empty;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]))
      counts.pixels[i] = rounded(map.count(values[i]));
    else
      empty.push_back(i);
  }
  if (empty.empty()) return counts;
  unusable = PixelMask(columns, rows);
  const SkyCells sky(values, columns);
  const RngKey key = rng_key(0, "", 0, "pixels without a value");
  for (const std::size_t i : empty) {
    unusable.pixels[i] = 1;
    const auto& [level, sigma] =
        sky.at(int(i % std::size_t(columns)), int(i / std::size_t(columns)));
    const double noise = sigma * double(normal_of(rng_word(key, std::uint32_t(i), 0)));
    counts.pixels[i] = rounded(map.count(level + noise));
  }
  return counts;
}

}  // namespace dmise
