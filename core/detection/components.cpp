#include "core/detection/components.h"

#include "core/base/simd_level.h"
#include "core/detection/filter_kernels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dmise {
namespace {

constexpr int band_rows = 64;

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

/// out = sum over i of k[|i|] in[+i rows], over `count` columns; `row(i)` returns the row at offset
/// i.
template <class Row>
void weigh_rows(const std::vector<float>& k, Row row, float* out, int count) {
  const float* centre = row(0);
  for (int x = 0; x < count; ++x) out[x] = k[0] * centre[x];
  for (int i = 1; i < int(k.size()); ++i) {
    const float *before = row(-i), *after = row(i), weight = k[std::size_t(i)];
    for (int x = 0; x < count; ++x) out[x] += weight * (before[x] + after[x]);
  }
}

class Band {
 public:
  Band(const CountImage& counts, const Background& background, const std::vector<float>& kernel)
      : counts_(counts), background_(background), kernel_(kernel) {}

  std::vector<PeakedRun> runs(int first_row, int last_row, float low, float unit,
                              FilteredFrame* keep) {
    const int columns = counts_.columns, radius = int(kernel_.size()) - 1;
    const int padded = columns + 2 * radius;
    // Rows of the band and its neighbours, smoothed along x; there is no light outside the frame.
    const int held = last_row - first_row + 2 * radius;
    const auto width = std::size_t(columns);
    std::vector<float> smoothed(std::size_t(held) * width, 0.0f);
    std::vector<float> line(std::size_t(padded), 0.0f);
    std::vector<float> level(width), sigma(width), filtered(width);
    for (int j = 0; j < held; ++j) {
      const int y = first_row - radius + j;
      if (y < 0 || y >= counts_.rows) continue;
      background_.level_row(y, level.data());
      const auto* in = counts_.row(y);
      float* middle = line.data() + radius;
      for (int x = 0; x < columns; ++x) middle[x] = float(in[x]) - level[std::size_t(x)];
      weigh_rows(
          kernel_, [&](int i) { return middle + i; }, smoothed.data() + std::size_t(j) * width,
          columns);
    }
    const auto steps_of =
        kernel_of(best_simd_level(), sse2::steps_of, avx2::steps_of, avx512::steps_of);
    std::vector<PeakedRun> out;
    for (int y = first_row; y < last_row; ++y) {
      const int j = y - first_row + radius;
      weigh_rows(
          kernel_, [&](int i) { return smoothed.data() + std::size_t(j + i) * width; },
          filtered.data(), columns);
      background_.sigma_row(y, sigma.data());
      append_runs(y, filtered, sigma, low, unit, out);
      if (!keep) continue;
      steps_of(filtered.data(), sigma.data(), unit, width, y % 2 != 0, keep->row(y));
    }
    return out;
  }

 private:
  static void append_runs(int y, const std::vector<float>& filtered,
                          const std::vector<float>& sigma, float low, float unit,
                          std::vector<PeakedRun>& out) {
    const int columns = int(filtered.size());
    const float bar = low * unit;
    for (int x = 0; x < columns; ++x) {
      if (filtered[std::size_t(x)] <= bar * sigma[std::size_t(x)]) continue;
      PeakedRun found{{y, x, x}, 0.0f, x};
      for (; x < columns && filtered[std::size_t(x)] > bar * sigma[std::size_t(x)]; ++x) {
        const float snr = filtered[std::size_t(x)] / (unit * sigma[std::size_t(x)]);
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

}  // namespace dmise
