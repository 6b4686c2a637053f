#include "core/detection/pixels/components.h"

#include "core/base/numeric/simd_level.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/pixels/filter_kernels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dmise {
namespace {

constexpr int band_rows = 128;

struct PeakedRun {
  Run run;
  float peak_snr;
  int peak_x;
};

/// Half of a Gaussian kernel: k[0] is the centre; the whole sums to 1.
std::vector<float> half_kernel(double sigma_px) {
  const int radius = std::max(1, int(std::ceil(3 * sigma_px)));
  std::vector<double> k(std::size_t(radius) + 1);
  double sum = 0.0;
  for (int i = 0; i <= radius; ++i) {
    k[std::size_t(i)] = std::exp(-0.5 * i * i / (sigma_px * sigma_px));
    sum += (i ? 2 : 1) * k[std::size_t(i)];
  }
  std::vector<float> out;
  for (const double v : k) out.push_back(float(v / sum));
  return out;
}

/// Filters bands of rows.
class Band {
 public:
  Band(const CountImage& counts, const Background& background, const std::vector<float>& kernel)
      : counts_(counts),
        background_(background),
        kernel_(kernel),
        radius_(int(kernel.size()) - 1),
        width_(std::size_t(counts.columns)),
        ring_(std::size_t(2 * radius_ + 1) * width_),
        line_(width_ + 2 * std::size_t(radius_)),
        level_(width_),
        sigma_(width_),
        filtered_(width_),
        blocks_((width_ + filter_block - 1) / filter_block) {}

  std::vector<PeakedRun> runs(int first_row, int last_row, float low, float unit,
                              FilteredFrame* keep) {
    std::vector<PeakedRun> out;
    for (int y = first_row - radius_; y < first_row + radius_; ++y) smooth(y);
    std::vector<const float*> before(kernel_.size()), after(kernel_.size());
    for (int y = first_row; y < last_row; ++y) {
      smooth(y + radius_);
      for (int i = 0; i <= radius_; ++i) {
        before[std::size_t(i)] = smoothed(y - i);
        after[std::size_t(i)] = smoothed(y + i);
      }
      weigh_rows_(before.data(), after.data(), kernel_.data(), std::size_t(radius_), width_,
                  filtered_.data());
      background_.sigma_row(y, 0, counts_.columns, sigma_.data());
      append_runs(y, low, unit, out);
      if (keep) steps_of_(filtered_.data(), sigma_.data(), unit, width_, y % 2 != 0, keep->row(y));
    }
    return out;
  }

 private:
  float* smoothed(int y) {
    const int rows = 2 * radius_ + 1;
    return ring_.data() + std::size_t((y + rows) % rows) * width_;
  }

  /// A row less its background, smoothed along x; there is no light outside the frame.
  void smooth(int y) {
    if (y < 0 || y >= counts_.rows) {
      std::fill(smoothed(y), smoothed(y) + width_, 0.0f);
      return;
    }
    background_.level_row(y, 0, counts_.columns, level_.data());
    float* middle = line_.data() + radius_;
    above_level_(counts_.row(y), level_.data(), width_, middle);
    std::vector<const float*> before, after;
    for (int i = 0; i <= radius_; ++i) {
      before.push_back(middle - i);
      after.push_back(middle + i);
    }
    weigh_rows_(before.data(), after.data(), kernel_.data(), std::size_t(radius_), width_,
                smoothed(y));
  }

  void append_runs(int y, float low, float unit, std::vector<PeakedRun>& out) {
    const int columns = int(width_);
    const float bar = low * unit;
    const auto is_above = [&](int x) {
      return filtered_[std::size_t(x)] > bar * sigma_[std::size_t(x)];
    };
    mark_above_(filtered_.data(), sigma_.data(), bar, width_, blocks_.data());
    constexpr int block = int(filter_block);
    for (int x = 0; x < columns; ++x) {
      if (x % block == 0 && !blocks_[std::size_t(x / block)]) {
        x += block - 1;
        continue;
      }
      if (!is_above(x)) continue;
      PeakedRun found{{y, x, x}, 0.0f, x};
      for (; x < columns && is_above(x); ++x) {
        const float snr = filtered_[std::size_t(x)] / (unit * sigma_[std::size_t(x)]);
        if (snr > found.peak_snr) {
          found.peak_snr = snr;
          found.peak_x = x;
        }
      }
      found.run.last_x = x - 1;
      out.push_back(found);
    }
  }

  const CountImage& counts_;
  const Background& background_;
  const std::vector<float>& kernel_;
  int radius_;
  std::size_t width_;
  std::vector<float> ring_;  // rows smoothed along x
  std::vector<float> line_, level_, sigma_, filtered_;
  std::vector<std::uint8_t> blocks_;
  const decltype(&sse2::weigh_rows) weigh_rows_ =
      kernel_of(best_simd_level(), sse2::weigh_rows, avx2::weigh_rows, avx512::weigh_rows);
  const decltype(&sse2::above_level) above_level_ =
      kernel_of(best_simd_level(), sse2::above_level, avx2::above_level, avx512::above_level);
  const decltype(&sse2::mark_above) mark_above_ =
      kernel_of(best_simd_level(), sse2::mark_above, avx2::mark_above, avx512::mark_above);
  const decltype(&sse2::steps_of) steps_of_ =
      kernel_of(best_simd_level(), sse2::steps_of, avx2::steps_of, avx512::steps_of);
};

/// Disjoint sets of runs.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);  // the earliest run names the set
  }

 private:
  std::vector<std::size_t> parent_;
};

std::vector<Component> connect(const std::vector<PeakedRun>& runs, float high) {
  Sets sets(runs.size());
  std::size_t above = 0;  // first run of the previous row that may still touch
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i].run;
    while (above < i &&
           (runs[above].run.y < run.y - 1 ||
            (runs[above].run.y == run.y - 1 && runs[above].run.last_x < run.first_x - 1)))
      ++above;
    for (std::size_t j = above;
         j < i && runs[j].run.y == run.y - 1 && runs[j].run.first_x <= run.last_x + 1; ++j)
      sets.join(i, j);
  }
  std::vector<float> peak(runs.size(), 0.0f);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    float& p = peak[sets.root(i)];
    p = std::max(p, runs[i].peak_snr);
  }
  std::vector<Component> out;
  std::vector<std::size_t> place(runs.size(), 0);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::size_t root = sets.root(i);
    if (peak[root] < high) continue;
    const Run& run = runs[i].run;
    if (root == i) {
      place[i] = out.size();
      Component first;
      first.min_x = run.first_x;
      first.max_x = run.last_x;
      first.min_y = run.y;
      out.push_back(std::move(first));
    }
    Component& component = out[place[root]];
    component.runs.push_back(run);
    component.min_x = std::min(component.min_x, run.first_x);
    component.max_x = std::max(component.max_x, run.last_x);
    component.max_y = run.y;
    component.pixels += run.last_x - run.first_x + 1;
    if (runs[i].peak_snr > component.peak_snr) {
      component.peak_snr = runs[i].peak_snr;
      component.peak_x = runs[i].peak_x;
      component.peak_y = run.y;
    }
  }
  return out;
}

}  // namespace

double kernel_square_sum(double sigma_px) {
  const auto half = half_kernel(sigma_px);
  double sum = 0.0;
  for (std::size_t i = 0; i < half.size(); ++i) sum += (i ? 2.0 : 1.0) * half[i] * half[i];
  return sum * sum;
}

double limiting_point_e(double noise_e, double sigma_px) {
  return detection_limits::seed_snr * noise_e / std::sqrt(kernel_square_sum(sigma_px));
}

std::vector<Component> find_components(const CountImage& counts, const Background& background,
                                       double sigma_px, double low, double high, Threads& threads,
                                       FilteredFrame* filtered) {
  const auto kernel = half_kernel(sigma_px);
  const float unit = float(std::sqrt(kernel_square_sum(sigma_px)));
  const std::size_t bands = std::size_t((counts.rows + band_rows - 1) / band_rows);
  std::vector<std::vector<PeakedRun>> found(bands);
  threads.for_ranges(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      Band band(counts, background, kernel);
      const int first = int(b) * band_rows;
      found[b] =
          band.runs(first, std::min(first + band_rows, counts.rows), float(low), unit, filtered);
    }
  });
  std::vector<PeakedRun> runs;
  for (const auto& part : found) runs.insert(runs.end(), part.begin(), part.end());
  return connect(runs, float(high));
}

std::vector<Component> parts_of(const Component& component, const FilteredFrame& frame, double low,
                                double high) {
  const int least = frame.steps_of(low, component.peak_x, component.peak_y);
  const int seed = frame.steps_of(high, component.peak_x, component.peak_y);
  std::vector<PeakedRun> runs;
  for (const Run& run : component.runs) {
    const std::int8_t* row = frame.row(run.y);
    for (int x = run.first_x; x <= run.last_x; ++x) {
      if (row[x] < least) continue;
      PeakedRun part{{run.y, x, x}, 0.0f, x};
      for (; x <= run.last_x && row[x] >= least; ++x) {
        part.run.last_x = x;
        const float snr = float(row[x]) / FilteredFrame::steps;
        if (snr > part.peak_snr) part.peak_snr = snr, part.peak_x = x;
      }
      runs.push_back(part);
    }
  }
  return connect(runs, float(seed) / FilteredFrame::steps);
}

}  // namespace dmise
