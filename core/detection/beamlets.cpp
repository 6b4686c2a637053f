#include "core/detection/beamlets.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include "core/detection/beamlet_kernels.h"
#include "core/detection/transpose_tile.h"

namespace dmise {
namespace {

constexpr int shortest = 8, longest = 1024;    // rows of a beamlet
constexpr int cell_px = 32, angle_cells = 64;  // one beamlet is kept of each
constexpr double least_used = 0.7;  // root of a half: half of a strip has more SNR than less of it

/// One of the four ranges of direction: lines that pass more rows than columns or the other way
/// round, and move to one side or the other.
struct Orientation {
  bool transposed = false, mirrored = false;

  int minor(const FilteredFrame& f) const { return transposed ? f.rows : f.columns; }
  int major(const FilteredFrame& f) const { return transposed ? f.columns : f.rows; }
};

/// Beamlets of `length` rows.
struct Level {
  int length = 0, angles = 0;
  std::vector<float> noise;         // by shift, of a sum
  std::vector<std::int16_t> least;  // by shift, of a sum that is kept
};

Level level_of(const FilteredFrame& frame, int n, double least_snr) {
  Level level{.length = n, .angles = std::min(n, angle_cells), .noise = {}, .least = {}};
  if (n < shortest) return level;
  for (int a = 0; a < n; ++a) {
    const double slope = double(a) / (n - 1);
    const double noise =
        FilteredFrame::steps * std::sqrt(n * frame.sum_variance(std::hypot(1.0, slope), n));
    level.noise.push_back(float(noise));
    level.least.push_back(std::int16_t(std::min(least_snr * noise, 32767.0)));
  }
  return level;
}

/// Sums of one orientation over a block of rows, in place.
class Block {
 public:
  Block(const FilteredFrame& frame, Orientation orientation, int first, int size,
        const std::vector<Level>& levels, SimdLevel level)
      : frame_(frame),
        orientation_(orientation),
        first_(first),
        size_(size),
        width_(std::size_t(orientation.minor(frame) + size)),
        levels_(levels),
        join_(kernel_of(level, sse2::join_beamlets, avx2::join_beamlets, avx512::join_beamlets)) {
    sums_.resize(std::size_t(size) * width_);
    for (int k = 0; k < size; ++k) rows_.push_back(sums_.data() + std::size_t(k) * width_);
    fill();
  }

  void find(std::vector<Beamlet>& found) {
    sum(0, size_, false);
    std::stable_sort(kept_.begin(), kept_.end(),
                     [](const Kept& a, const Kept& b) { return a.cell < b.cell; });
    for (std::size_t i = 0; i < kept_.size();) {
      Beamlet best = kept_[i].beamlet;
      const std::uint64_t cell = kept_[i].cell;
      for (; i < kept_.size() && kept_[i].cell == cell; ++i)
        if (kept_[i].beamlet.snr > best.snr) best = kept_[i].beamlet;
      found.push_back(best);
    }
  }

 private:
  /// A beamlet in its small range of level, strip, place and direction.
  struct Kept {
    std::uint64_t cell;
    Beamlet beamlet;
  };

  /// The block's pixels, to the right of as many columns of zeros as a line can cross.
  void fill() {
    const int minor = orientation_.minor(frame_);
    const int begin = std::max(-first_, 0);
    const int used = std::min(size_, orientation_.major(frame_) - first_);
    const auto place = [&](int m) {
      return std::size_t(size_ + (orientation_.mirrored ? minor - 1 - m : m));
    };
    if (!orientation_.transposed) {
      for (int k = begin; k < used; ++k) {
        const std::int16_t* from = frame_.row(first_ + k);
        if (orientation_.mirrored)
          copy_reversed(from, std::size_t(minor), rows_[std::size_t(k)] + size_);
        else
          std::copy(from, from + minor, rows_[std::size_t(k)] + size_);
      }
      return;
    }
    for (int y = 0; y < minor; y += transpose_side) {
      const int across = std::min(transpose_side, minor - y);
      for (int k = begin; k < used; k += transpose_side) {
        const int down = std::min(transpose_side, used - k);
        if (across == transpose_side && down == transpose_side) {
          const std::int16_t* from[transpose_side];
          std::int16_t* to[transpose_side];
          for (int i = 0; i < transpose_side; ++i) {
            const int m = orientation_.mirrored ? transpose_side - 1 - i : i;
            from[i] = frame_.row(y + m) + first_ + k;
            to[i] = rows_[std::size_t(k + i)] +
                    place(orientation_.mirrored ? y + transpose_side - 1 : y);
          }
          transpose_tile(from, to);
          continue;
        }
        for (int j = y; j < y + across; ++j)
          for (int i = k; i < k + down; ++i)
            rows_[std::size_t(i)][place(j)] = frame_.row(j)[first_ + i];
      }
    }
  }

  /// Rows of a strip that are in the frame.
  int used(int first, int length) const {
    return std::max(0, std::min(first_ + first + length, orientation_.major(frame_)) -
                           std::max(first_ + first, 0));
  }

  /// Sums the lines over `length` rows from `first` on, and all shorter ones in them. A strip
  /// of which so much is beside the frame that a half of it is always better is only summed if it
  /// is a part of a longer one that is.
  void sum(int first, int length, bool needed) {
    if (length == 1 || used(first, length) == 0) return;
    const int half = length / 2;
    needed = needed || used(first, length) >= least_used * length;
    sum(first, half, needed);
    sum(first + half, half, needed);
    if (!needed) return;
    // Further to the left no line of this length comes in from.
    const auto skipped = std::size_t(size_ - length);
    const Level& level = levels_[std::size_t(std::bit_width(unsigned(length)) - 2)];
    std::vector<std::int16_t*> joined(std::size_t(length), nullptr);
    for (int a = 0; a < half; ++a) {
      std::int16_t* upper = rows_[std::size_t(first + a)];
      std::int16_t* lower = rows_[std::size_t(first + half + a)];
      std::int16_t most[2];
      join_(upper + skipped, lower + skipped, std::size_t(a), width_ - skipped, most);
      joined[std::size_t(2 * a)] = upper;
      joined[std::size_t(2 * a + 1)] = lower;
      if (length < shortest) continue;
      for (int side = 0; side < 2; ++side)
        if (most[side] >= level.least[std::size_t(2 * a + side)])
          keep(first, 2 * a + side, side ? lower : upper, level);
    }
    std::copy(joined.begin(), joined.end(), rows_.begin() + first);
  }

  /// Keeps the largest sum of each cell of a row of sums with `shift`.
  void keep(int first, int shift, const std::int16_t* sums, const Level& level) {
    const std::int16_t least = level.least[std::size_t(shift)];
    const float noise = level.noise[std::size_t(shift)];
    const auto strip = std::uint64_t(first / level.length);
    const auto angle = std::uint64_t(shift * level.angles / level.length);
    const auto cells = std::uint64_t(width_ / cell_px + 1);
    const std::uint64_t row =
        ((std::uint64_t(level.length) * std::uint64_t(size_) + strip) * angle_cells + angle) *
        cells;
    for (auto x = std::size_t(size_ - level.length); x < width_; ++x) {
      if (sums[x] < least) continue;
      const std::uint64_t cell = row + x / cell_px;
      const float snr = float(sums[x]) / noise;
      const Beamlet beamlet = placed(snr, int(x) - size_, first, shift, level.length);
      if (kept_.empty() || kept_.back().cell != cell)
        kept_.push_back({cell, beamlet});
      else if (snr > kept_.back().beamlet.snr)
        kept_.back().beamlet = beamlet;
    }
  }

  Beamlet placed(float snr, int from, int first, int shift, int length) const {
    float m1 = float(from), m2 = float(from + shift);
    if (orientation_.mirrored) {
      m1 = float(orientation_.minor(frame_) - 1) - m1;
      m2 = float(orientation_.minor(frame_) - 1) - m2;
    }
    const float k1 = float(first_ + first), k2 = k1 + float(length - 1);
    return orientation_.transposed ? Beamlet{snr, k1, m1, k2, m2} : Beamlet{snr, m1, k1, m2, k2};
  }

  const FilteredFrame& frame_;
  Orientation orientation_;
  int first_, size_;  // rows
  std::size_t width_;
  const std::vector<Level>& levels_;  // of 2, 4, .. rows
  decltype(&sse2::join_beamlets) join_;
  std::vector<std::int16_t> sums_;
  std::vector<std::int16_t*> rows_;  // by strip, then shift
  std::vector<Kept> kept_;
};

}  // namespace

std::vector<Beamlet> find_beamlets(const FilteredFrame& frame, double least_snr, SimdLevel level,
                                   Threads& threads) {
  struct Task {
    Orientation orientation;
    int first, size;
  };
  std::vector<Task> tasks;
  for (const Orientation o : {Orientation{false, false}, Orientation{false, true},
                              Orientation{true, false}, Orientation{true, true}}) {
    const int major = o.major(frame);
    const int size = std::min(longest, int(std::bit_floor(unsigned(std::max(major, 1)))));
    if (size < shortest) continue;
    // A second set of strips begins a third of a block earlier, which is a third or two thirds of
    // a strip at every level: a streak on the border of two strips is inside one of the other set.
    for (const int earlier : {0, size / 3})
      for (int first = -earlier; first < major; first += size) tasks.push_back({o, first, size});
  }
  std::vector<Level> levels;
  for (int n = 2; n <= longest; n *= 2) levels.push_back(level_of(frame, n, least_snr));
  std::vector<std::vector<Beamlet>> found(tasks.size());
  threads.for_ranges(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      Block(frame, tasks[i].orientation, tasks[i].first, tasks[i].size, levels, level)
          .find(found[i]);
  });
  std::vector<Beamlet> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Beamlet& a, const Beamlet& b) { return a.snr > b.snr; });
  return all;
}

}  // namespace dmise
