#include "core/detection/pixels/background.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/numeric/quantile.h"
#include "core/base/numeric/simd_level.h"
#include "core/detection/pixels/bent_sky.h"
#include "core/detection/pixels/filter_kernels.h"

namespace dmise {
namespace {

struct Sky {
  float level = 0.0f, sigma = 0.0f;
};

/// Sums over a histogram from bin `from` to before `to`: whole numbers, so that moving the window
/// loses no digits.
class Window {
 public:
  explicit Window(const std::vector<std::uint32_t>& histogram) : histogram_(histogram) {}

  void move(std::size_t from, std::size_t to) {
    if (to_ == 0) from_ = to_ = median_ = from;
    for (; to_ < to; ++to_) add(to_, 1);
    for (; from_ > from; --from_) {
      add(from_ - 1, 1);
      below_ += histogram_[from_ - 1];
    }
    for (; to_ > to; --to_) add(to_ - 1, -1);
    for (; from_ < from; ++from_) {
      add(from_, -1);
      if (from_ < median_)
        below_ -= histogram_[from_];
      else
        median_ = from_ + 1;
    }
  }
  double count() const { return double(count_); }
  double sum() const { return double(sum_); }
  double squares() const { return double(squares_); }
  /// Median as if each number were spread evenly over its bin: finer than one count.
  double spread_median() {
    while (below_ > 0 && 2 * below_ >= count_) below_ -= histogram_[--median_];
    for (; median_ < to_; ++median_) {
      const std::int64_t here = histogram_[median_];
      if (2 * (below_ + here) >= count_ && here > 0)
        return double(median_) - 0.5 + (0.5 * double(count_) - double(below_)) / double(here);
      below_ += here;
    }
    return double(from_);
  }

 private:
  void add(std::size_t bin, std::int64_t times) {
    const std::int64_t n = times * std::int64_t(histogram_[bin]), at = std::int64_t(bin);
    count_ += n;
    sum_ += n * at;
    squares_ += n * at * at;
  }

  const std::vector<std::uint32_t>& histogram_;
  std::size_t from_ = 0, to_ = 0;
  std::size_t median_ = 0;  // bin of the median before
  std::int64_t below_ = 0;  // pixels of the window in bins before that one
  std::int64_t count_ = 0, sum_ = 0, squares_ = 0;
};

/// Values by their rank, without sorting them: by counts of their upper bytes, then of the lower.
class Selection {
 public:
  explicit Selection(const std::vector<std::uint16_t>& values) : values_(values) {
    for (const auto v : values) ++upper_[v >> 8];
  }
  std::uint16_t at(std::size_t rank) const {
    const auto [upper, within] = bin_of(upper_, rank);
    std::array<std::uint32_t, 256> lower{};
    for (const auto v : values_) lower[v & 255] += v >> 8 == upper;
    return std::uint16_t(upper << 8 | bin_of(lower, within).first);
  }

 private:
  /// The bin of a rank, and the rank within it.
  static std::pair<std::size_t, std::size_t> bin_of(const std::array<std::uint32_t, 256>& counts,
                                                    std::size_t rank) {
    std::size_t bin = 0;
    for (; counts[bin] <= rank; ++bin) rank -= counts[bin];
    return {bin, rank};
  }

  const std::vector<std::uint16_t>& values_;
  std::array<std::uint32_t, 256> upper_{};
};

/// Two values by their rank, the lower one first. `near`: a value that is likely not far from them.
std::array<std::uint16_t, 2> two_of(const std::vector<std::uint16_t>& values,
                                    const std::array<std::size_t, 2>& ranks, int near) {
  constexpr int bins = 2048;
  const int base = std::max(near - bins / 2, 0);
  std::array<std::uint16_t, bins + 2> counts{};  // the first and the last: of what is beside
  for (const auto v : values) ++counts[std::size_t(std::clamp(int(v) - base, -1, bins) + 1)];
  std::array<std::uint16_t, 2> out{};
  std::size_t below = counts[0], bin = 1;
  for (std::size_t i = 0; i < 2; ++i) {
    for (; bin <= bins && below + counts[bin] <= ranks[i]; ++bin) below += counts[bin];
    if (ranks[i] < counts[0] || bin > bins || values.size() > 65535) {
      const Selection sorted(values);
      return {sorted.at(ranks[0]), sorted.at(ranks[1])};
    }
    out[i] = std::uint16_t(base + int(bin) - 1);
  }
  return out;
}

/// Memory for a cell's values, and the median of the cell before.
struct CellMemory {
  std::vector<std::uint16_t> values, some, row;
  std::vector<float> levels;
  std::vector<std::uint32_t> histogram;
  int near = 0;
};

/// The sky by the `values` of a cell, which are not empty.
Sky clipped_sky(CellMemory& memory) {
  const std::vector<std::uint16_t>& values = memory.values;
  // A quarter of them is enough to start from.
  constexpr std::size_t least = 256;
  const std::size_t every = values.size() < 4 * least ? 1 : 4;
  std::vector<std::uint16_t>& some = memory.some;
  some.resize((values.size() + every - 1) / every);
  for (std::size_t i = 0; i < some.size(); ++i) some[i] = values[i * every];
  const auto rank = [&](double q) { return std::size_t(q * double(some.size() - 1)); };
  const auto found = two_of(some, {rank(0.1587), rank(0.5)}, memory.near);
  const double low = found[0], first_median = found[1];
  memory.near = found[1];
  double sigma = std::max(first_median - low, 0.5), centre = first_median;
  // The rest works on a histogram of the values near the median.
  const double reach = 6 * sigma + 2;
  const auto base = std::int64_t(std::max(0.0, std::floor(centre - reach)));
  const std::size_t bins = std::size_t(2 * reach) + 2;
  std::vector<std::uint32_t>& histogram = memory.histogram;
  histogram.assign(bins + 1, 0);  // the last: of what is beside
  const auto first = std::uint32_t(base), last = std::uint32_t(bins);
  for (const auto v : values) ++histogram[std::min(std::uint32_t(v) - first, last)];
  Window window(histogram);
  double mean = centre, median = centre;
  for (int pass = 0; pass < 8; ++pass) {
    const auto edge = [&](double v) {
      return std::size_t(std::clamp(std::ceil(v - double(base)), 0.0, double(bins)));
    };
    const std::size_t from = edge(centre - 3 * sigma), to = edge(centre + 3 * sigma + 1e-9);
    window.move(from, to);
    const double n = window.count(), sum = window.sum(), squares = window.squares();
    if (n < 2) break;
    mean = sum / n + double(base);
    median = window.spread_median() + double(base);
    const double variance = std::max(squares / n - (sum / n) * (sum / n), 0.0);
    const double before = sigma;
    sigma = std::max(std::sqrt(variance) / 0.98658, 0.3);  // the cut at 3 sigma narrows a normal
    centre = median;
    if (std::abs(sigma - before) < 1e-3 * before) break;
  }
  const double level = std::abs(mean - median) < 0.3 * sigma ? 2.5 * median - 1.5 * mean : median;
  return {float(level), float(sigma)};
}

float mean_of(const std::vector<float>& values) {
  static const auto sum_of_values =
      kernel_of(best_simd_level(), sse2::sum_of_values, avx2::sum_of_values, avx512::sum_of_values);
  return float(sum_of_values(values.data(), values.size()) / double(values.size()));
}

/// Copies up to 64 values but those of which a bit is set; returns the end.
std::uint16_t* copy_without(const std::uint16_t* from, int count, std::uint64_t left_out,
                            std::uint16_t* to) {
  for (int i = 0; i < count; ++i, left_out >>= 1) {
    *to = from[i];
    to += 1 - std::ptrdiff_t(left_out & 1);
  }
  return to;
}

}  // namespace

Background::Background(const CountImage& counts, int cell_px, Threads& threads)
    : columns_(counts.columns),
      rows_(counts.rows),
      cells_(columns_, rows_, std::max(1, (columns_ + cell_px / 2) / cell_px),
             std::max(1, (rows_ + cell_px / 2) / cell_px)),
      level_(cells_),
      sigma_(cells_) {
  CellMesh level = cells_, sigma = cells_;
  measure(counts, threads, nullptr, Cells::as_they_are, level, sigma);
  measure(counts, threads, nullptr, Cells::sloped, level, sigma);
}

void Background::measure_without(const BitMask& lit, const CountImage& counts, Threads& threads) {
  CellMesh level = cells_, sigma = cells_;
  measure(counts, threads, &lit, Cells::all, level, sigma);
}

void Background::measure(const CountImage& counts, Threads& threads, const BitMask* lit,
                         Cells which, CellMesh& level, CellMesh& sigma) {
  const std::size_t cells = cells_.values.size();
  constexpr int word = 64;
  const auto is_dark = [&](const Area& area) {
    int dark = (area.x1 - area.x0 + 1) * (area.y1 - area.y0 + 1);
    const int eighth = (dark + 7) / 8;
    for (int y = area.y0; y <= area.y1; ++y)
      for (int x = area.x0; x <= area.x1; x += word)
        dark -= std::popcount(lit->bits(x, y, std::min(word, area.x1 - x + 1)));
    return dark >= eighth;
  };
  const auto flat_counts =
      kernel_of(best_simd_level(), sse2::flat_counts, avx2::flat_counts, avx512::flat_counts);
  const auto measure_cell = [&](std::size_t cell, bool flatten, CellMemory& memory) {
    const Area area = area_of(cell);
    const bool skip = lit && is_dark(area);
    const int width = area.x1 - area.x0 + 1;
    const std::size_t pixels = std::size_t(width) * std::size_t(area.y1 - area.y0 + 1);
    float mean = 0.0f;
    if (flatten) {
      memory.levels.resize(pixels);
      float* to = memory.levels.data();
      for (int y = area.y0; y <= area.y1; ++y, to += width) level_.row(y, area.x0, area.x1 + 1, to);
      mean = mean_of(memory.levels);
    }
    memory.values.resize(pixels);
    memory.row.resize(std::size_t(width));
    std::uint16_t* to = memory.values.data();
    for (int y = area.y0; y <= area.y1; ++y) {
      const std::uint16_t* from = counts.row(y) + area.x0;
      for (int x = 0; x < width; x += 32) __builtin_prefetch(from + width + x);  // the next cell's
      if (flatten) {
        const float* level_at = memory.levels.data() + std::ptrdiff_t(y - area.y0) * width;
        flat_counts(from, level_at, mean, std::size_t(width), memory.row.data());
        from = memory.row.data();
      }
      for (int x = 0; x < width; x += word) {
        const int count = std::min(word, width - x);
        const std::uint64_t left_out = skip ? lit->bits(area.x0 + x, y, count) : 0;
        to = left_out == 0 ? std::copy_n(from + x, count, to)
                           : copy_without(from + x, count, left_out, to);
      }
    }
    memory.values.resize(std::size_t(to - memory.values.data()));
    const Sky sky = clipped_sky(memory);
    level.values[cell] = sky.level;
    sigma.values[cell] = sky.sigma;
  };
  threads.for_ranges(cells, std::size_t(cells_.across), [&](std::size_t begin, std::size_t end) {
    CellMemory memory;
    for (std::size_t cell = begin; cell < end; ++cell) {
      const bool flatten = which != Cells::as_they_are && is_sloped(cell);
      if (flatten || which != Cells::sloped) measure_cell(cell, flatten, memory);
    }
  });
  level_ = cells_ = median_of_cells(level);
  sigma_ = median_of_cells(sigma);
  const auto bends = sky_bends(cells_, sigma_);
  if (!is_bent(bends)) return;
  cells_ = without_sources(level, cells_, sigma_, bends);
  level_ = refined(cells_, sky_bends(cells_, sigma_), columns_, rows_);
}

Background::Area Background::area_of(std::size_t cell) const {
  const int i = int(cell) % cells_.across, j = int(cell) / cells_.across;
  const auto place = [](int k, int pixels, int cells) {
    return int(std::int64_t(k) * pixels / cells);
  };
  return {place(i, columns_, cells_.across), place(j, rows_, cells_.down),
          place(i + 1, columns_, cells_.across) - 1, place(j + 1, rows_, cells_.down) - 1};
}

bool Background::is_sloped(std::size_t cell) const {
  const int i = int(cell) % cells_.across, j = int(cell) / cells_.across;
  const float slope = std::hypot(0.5f * (cells_.cell(i + 1, j) - cells_.cell(i - 1, j)),
                                 0.5f * (cells_.cell(i, j + 1) - cells_.cell(i, j - 1)));
  return slope * slope > 0.5f * sigma_.values[cell] * sigma_.values[cell];
}

std::vector<Background::Area> Background::bent_cells(double share) const {
  std::vector<Area> out;
  for (std::size_t cell = 0; cell < cells_.values.size(); ++cell) {
    // At the border, where levels are extrapolated, the bend is the next cell's.
    const int i = std::clamp(int(cell) % cells_.across, 1, std::max(cells_.across - 2, 1));
    const int j = std::clamp(int(cell) / cells_.across, 1, std::max(cells_.down - 2, 1));
    const float middle = 2 * cells_.cell(i, j);
    const float across = cells_.cell(i - 1, j) + cells_.cell(i + 1, j) - middle;
    const float down = cells_.cell(i, j - 1) + cells_.cell(i, j + 1) - middle;
    if (std::max(std::abs(across), std::abs(down)) > 8 * share * sigma_.values[cell])
      out.push_back(area_of(cell));
  }
  return out;
}

float Background::median_level_dn() const { return middle_of(cells_.values); }
float Background::median_sigma_dn() const { return middle_of(sigma_.values); }

}  // namespace dmise
