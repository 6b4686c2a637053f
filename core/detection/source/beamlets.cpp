#include "core/detection/source/beamlets.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "core/base/memory.h"
#include "core/detection/source/beamlet_kernels.h"

namespace dmise {
namespace {

constexpr int shortest = 8, longest = 1024;    // rows of a beamlet
constexpr int cell_px = 32, angle_cells = 64;  // one beamlet is kept of each
constexpr double least_used = 0.7;  // root of a half: half of a strip has more SNR than less of it

/// One of the four ranges of direction: lines that pass more rows than columns or the other way
/// round, and move to one side or the other.
struct Orientation {
  bool transposed = false, mirrored = false;
};

/// Beamlets of `length` rows.
struct Level {
  int length = 0, angles = 0;
  std::vector<float> noise;         // by shift, of a sum
  std::vector<std::int16_t> least;  // by shift, of a sum that is kept; empty: none is

  std::int16_t least_of(int shift) const {
    return least.empty() ? std::int16_t(32767) : least[std::size_t(shift)];
  }
};

Level level_of(const FilteredFrame& frame, int n, double min_snr) {
  Level level{.length = n, .angles = std::min(n, angle_cells), .noise = {}, .least = {}};
  if (n < shortest) return level;
  for (int a = 0; a < n; ++a) {
    const double slope = double(a) / (n - 1);
    const double noise =
        FilteredFrame::steps * std::sqrt(n * frame.sum_variance(std::hypot(1.0, slope), n));
    level.noise.push_back(float(noise));
    level.least.push_back(std::int16_t(std::min(min_snr * noise, 32767.0)));
  }
  return level;
}

/// A frame of which lines are summed: its rows, or its columns as rows.
struct Lines {
  const std::int8_t* steps = nullptr;
  int minor = 0, major = 0;  // steps in a row, rows

  const std::int8_t* row(int k) const { return steps + std::size_t(k) * std::size_t(minor); }
};

struct Kernels {
  decltype(&sse2::widen_steps) widen_steps;
  decltype(&sse2::join_two) join_two;
  decltype(&sse2::join_four) join_four;

  explicit Kernels(SimdLevel level)
      : widen_steps(kernel_of(level, sse2::widen_steps, avx2::widen_steps, avx512::widen_steps)),
        join_two(kernel_of(level, sse2::join_two, avx2::join_two, avx512::join_two)),
        join_four(kernel_of(level, sse2::join_four, avx2::join_four, avx512::join_four)) {}
};

/// Memory for the sums of a block, which is used again.
struct Sums {
  std::vector<std::int16_t> values;
  std::vector<BeamletHit> whole, halves;
};

/// Sums of one orientation over a block of rows, in place.
class Block {
 public:
  Block(const Lines& lines, Orientation orientation, int first, int size,
        const std::vector<Level>& levels, const Kernels& kernels, Sums& memory)
      : lines_(lines),
        orientation_(orientation),
        first_(first),
        size_(size),
        width_(std::size_t(lines.minor + size)),
        levels_(levels),
        kernels_(kernels),
        memory_(memory) {
    // As far beyond its end as sums of four are taken from, a row is zero.
    const std::size_t beyond = 3 * std::size_t(size) / 4 + 2 * beamlet_spare;
    const std::size_t stride = (width_ + beyond + aligned - 1) / aligned * aligned;
    const std::size_t values = std::size_t(size) * stride + aligned;
    if (memory.values.size() < values) memory.values = zeros_in_large_pages<std::int16_t>(values);
    const std::size_t hits = 4 * (width_ + beamlet_spare);
    if (memory.whole.size() < hits) memory.whole.resize(hits), memory.halves.resize(hits);
    void* place = memory.values.data();
    std::size_t space = 2 * values;
    auto* begin = static_cast<std::int16_t*>(std::align(2 * aligned, 2, place, space));
    for (int k = 0; k < size; ++k) rows_.push_back(begin + std::size_t(k) * stride);
    stride_ = stride;
  }

  void find(std::vector<Beamlet>& found) {
    sum(0, size_, false);
    std::ranges::stable_sort(kept_, {}, &Kept::cell);
    for (std::size_t i = 0; i < kept_.size();) {
      Beamlet best = kept_[i].beamlet;
      const std::uint64_t cell = kept_[i].cell;
      for (; i < kept_.size() && kept_[i].cell == cell; ++i)
        if (kept_[i].beamlet.snr > best.snr) best = kept_[i].beamlet;
      found.push_back(best);
    }
  }

 private:
  static constexpr std::size_t aligned = 32;  // values: a cache line, and the widest vector

  /// A beamlet in its small range of level, strip, place and direction.
  struct Kept {
    std::uint64_t cell;
    Beamlet beamlet;
  };

  /// A row of pixels, to the right of as many columns of zeros as a line can cross.
  void fill(int k) {
    std::int16_t* row = rows_[std::size_t(k)];
    const int line = first_ + k;
    const bool inside = line >= 0 && line < lines_.major;
    const auto begin = std::size_t(size_);
    std::fill(row, row + (inside ? begin : width_), std::int16_t(0));
    if (inside)
      kernels_.widen_steps(lines_.row(line), std::size_t(lines_.minor), orientation_.mirrored,
                           row + begin);
    std::fill(row + width_, row + stride_, std::int16_t(0));
  }

  /// Rows of a strip that are in the frame.
  int used(int first, int length) const {
    const int begin = first_ + first;
    return std::max(0, std::min(begin + length, lines_.major) - std::max(begin, 0));
  }

  const Level& level_of_length(int length) const {
    return levels_[std::size_t(std::bit_width(unsigned(length)) - 2)];
  }

  /// Sums the lines over `length` rows from `first` on, and all shorter ones in them. A strip that
  /// is so far beside the frame that a half of it is always better is only summed if it
  /// is a part of a longer one that is.
  void sum(int first, int length, bool needed) {
    needed = needed || used(first, length) >= least_used * length;
    if (length == 1) {
      if (needed) fill(first);
      return;
    }
    if (used(first, length) == 0) {
      for (int k = first; needed && k < first + length; ++k) fill(k);
      return;
    }
    const int parts = needed && length >= 4 ? 4 : 2;
    const int part = length / parts;
    for (int k = 0; k < parts; ++k) sum(first + k * part, part, needed);
    if (!needed) return;
    const Level& level = level_of_length(length);
    std::vector<std::int16_t*> joined;
    joined.reserve(std::size_t(length));
    for (int a = 0; a < part; ++a) {
      std::int16_t* rows[4] = {};
      for (int k = 0; k < parts; ++k) rows[k] = rows_[std::size_t(first + k * part + a)];
      BeamletLeast least{.keeps_sums = length < size_};
      for (int k = 0; k < parts; ++k) least.whole[k] = level.least_of(parts * a + k);
      BeamletHits hits{memory_.whole.data(), memory_.halves.data()};
      // Further to the left no line of so large a shift comes in from.
      const auto begin = std::size_t(size_ - parts * (a + 1)) / aligned * aligned;
      if (parts == 2) {
        kernels_.join_two(rows, std::size_t(a), begin, width_, least, hits);
      } else {
        const Level& half = level_of_length(length / 2);
        for (int k = 0; k < 2; ++k) least.halves[k] = half.least_of(2 * a + k);
        kernels_.join_four(rows, std::size_t(a), begin, width_, least, hits);
        for (int k = 0; hits.in_halves > 0 && k < 4; ++k)
          keep(first + k / 2 * (length / 2), 2 * a + k % 2, k,
               {memory_.halves.data(), hits.in_halves}, half);
      }
      for (int k = 0; hits.in_whole > 0 && k < parts; ++k)
        keep(first, parts * a + k, k, {memory_.whole.data(), hits.in_whole}, level);
      joined.insert(joined.end(), rows, rows + parts);
    }
    std::copy(joined.begin(), joined.end(), rows_.begin() + first);
  }

  /// Keeps the largest sum of each cell of the row of hits with `shift`.
  void keep(int first, int shift, int row, std::span<const BeamletHit> hits, const Level& level) {
    const float noise = level.noise[std::size_t(shift)];
    const auto strip = std::uint64_t(first / level.length);
    const auto angle = std::uint64_t(shift * level.angles / level.length);
    const auto cells = std::uint64_t(width_ / cell_px + 1);
    const std::uint64_t begin =
        ((std::uint64_t(level.length) * std::uint64_t(size_) + strip) * angle_cells + angle) *
        cells;
    for (const BeamletHit& hit : hits) {
      if (hit.row != row) continue;
      const std::uint64_t cell = begin + hit.column / cell_px;
      const float snr = float(hit.sum) / noise;
      const Beamlet beamlet = placed(snr, int(hit.column) - size_, first, shift, level.length);
      if (kept_.empty() || kept_.back().cell != cell)
        kept_.push_back({cell, beamlet});
      else if (snr > kept_.back().beamlet.snr)
        kept_.back().beamlet = beamlet;
    }
  }

  Beamlet placed(float snr, int from, int first, int shift, int length) const {
    float m1 = float(from), m2 = float(from + shift);
    if (orientation_.mirrored) {
      m1 = float(lines_.minor - 1) - m1;
      m2 = float(lines_.minor - 1) - m2;
    }
    const float k1 = float(first_ + first), k2 = k1 + float(length - 1);
    return orientation_.transposed ? Beamlet{snr, k1, m1, k2, m2} : Beamlet{snr, m1, k1, m2, k2};
  }

  const Lines& lines_;
  Orientation orientation_;
  int first_, size_;  // rows
  std::size_t width_, stride_ = 0;
  const std::vector<Level>& levels_;  // for strips of 2, 4, .. rows
  const Kernels& kernels_;
  Sums& memory_;
  std::vector<std::int16_t*> rows_;  // by strip, then shift
  std::vector<Kept> kept_;
};

/// Memory of blocks at work.
class SumsPool {
 public:
  std::unique_ptr<Sums> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Sums>();
    auto sums = std::move(free_.back());
    free_.pop_back();
    return sums;
  }
  void give_back(std::unique_ptr<Sums> sums) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(sums));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Sums>> free_;
};

}  // namespace

std::vector<Beamlet> find_beamlets(const FilteredFrame& frame, const TurnedFrame& turned,
                                   double min_snr, SimdLevel level, Threads& threads) {
  struct Task {
    Orientation orientation;
    int first, size;
  };
  std::vector<Task> tasks;
  for (const Orientation o : {Orientation{false, false}, Orientation{false, true},
                              Orientation{true, false}, Orientation{true, true}}) {
    const int major = o.transposed ? frame.columns : frame.rows;
    const int size = std::min(longest, int(std::bit_floor(unsigned(std::max(major, 1)))));
    if (size < shortest) continue;
    // A second set of strips begins a third of a block earlier, which is a third or two thirds of
    // a strip at every level: a streak on the border of two strips is inside one of the other set.
    for (const int earlier : {0, size / 3})
      for (int first = -earlier; first < major; first += size) tasks.push_back({o, first, size});
  }
  std::vector<Level> levels;
  for (int n = 2; n <= longest; n *= 2) levels.push_back(level_of(frame, n, min_snr));
  const Lines by_rows{frame.snr.data(), frame.columns, frame.rows};
  const Lines by_columns{turned.snr.data(), frame.rows, frame.columns};
  const Kernels kernels(level);
  SumsPool pool;
  std::vector<std::vector<Beamlet>> found(tasks.size());
  threads.for_ranges(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
    auto sums = pool.take();
    for (std::size_t i = begin; i < end; ++i) {
      const Task& task = tasks[i];
      const Lines& lines = task.orientation.transposed ? by_columns : by_rows;
      Block(lines, task.orientation, task.first, task.size, levels, kernels, *sums).find(found[i]);
    }
    pool.give_back(std::move(sums));
  });
  std::vector<Beamlet> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  std::ranges::stable_sort(all, std::greater(), &Beamlet::snr);
  return all;
}

}  // namespace dmise
