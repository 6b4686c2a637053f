#include "core/sequences/motion_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/base/numeric/simd_level.h"
#include "core/base/units.h"
#include "core/sequences/stack_kernels.h"

namespace dmise {
namespace {

constexpr int cell_px = 64;
constexpr double step_sigmas = 2.5;  // between rates, over the whole sequence
constexpr double max_false = 0.001;  // a sequence, of normal noise: that of frames has more tails
constexpr std::size_t max_of_cell = 30, max_candidates = 2000;
constexpr std::size_t batch = 64;  // cells between two calls of `progress`

/// Terms of the sum at each pixel of a frame: weight times SNR, and square of the weight. Zeros
/// beside and beyond.
struct Terms {
  int columns, rows;
  std::size_t stride;
  std::vector<float> light, weight2;

  explicit Terms(const MovingLight& frame)
      : columns(frame.snr.columns),
        rows(frame.snr.rows),
        stride(std::size_t(columns) + 2 * cell_px),
        light(stride * std::size_t(rows + 1)),
        weight2(light.size()) {
    const auto most = float(max_snr_of_frame);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        const float w = frame.weight.at(x, y);
        light[place(x, y)] = w * std::clamp(frame.snr.at(x, y), -most, most);
        weight2[place(x, y)] = w * w;
      }
  }
  /// Where `cell_px` values from (x, y) on begin.
  std::size_t place(long x, long y) const {
    if (y < 0 || y >= rows || x < -cell_px || x > columns) return std::size_t(rows) * stride;
    return std::size_t(y) * stride + std::size_t(x + cell_px);
  }
};

struct Candidate {
  float snr2;
  int x, y;
  std::size_t rate;
};

/// Part of the reference frame, over which places in the frames shift by whole pixels.
class StackCell {
 public:
  StackCell(const TrackScene& scene, const std::vector<Terms>& terms, int x0, int y0)
      : scene_(scene),
        terms_(terms),
        x0_(x0),
        y0_(y0),
        shifts_(terms.size()),
        lights_(terms.size()),
        weights_(terms.size()),
        kernel_(
            kernel_of(best_simd_level(), sse2::stack_rows, avx2::stack_rows, avx512::stack_rows)) {
    const FilteredSequence& s = scene.sequence;
    const PixelPosition middle{x0 + (cell_px - 1) / 2.0, y0 + (cell_px - 1) / 2.0};
    for (std::size_t i = 0; i < s.frames.size(); ++i) {
      const PixelPosition at = middle + scene.range.middle * s.frames[i].time_s;
      maps_.push_back(scene.registration.around(s.reference, i, at, cell_px / 2.0));
    }
    middle_ = middle;
  }

  std::vector<Candidate> search(const std::vector<PixelPosition>& rates, float min_snr2) {
    best_.fill(0.0F);
    for (std::size_t r = 0; r < rates.size(); ++r) {
      for (std::size_t i = 0; i < maps_.size(); ++i) set_shift(i, rates[r]);
      for (int y = 0; y < cell_px; ++y) add_row(y, std::uint32_t(r));
    }
    return peaks(min_snr2);
  }

 private:
  static constexpr std::size_t size = std::size_t(cell_px) * cell_px;

  void set_shift(std::size_t frame, PixelPosition rate) {
    const PixelPosition from = middle_ + rate * scene_.sequence.frames[frame].time_s;
    const PixelPosition shift = maps_[frame](from) - middle_;
    shifts_[frame] = {std::lround(shift.x_px), std::lround(shift.y_px)};
  }

  void add_row(int y, std::uint32_t rate) {
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const auto [dx, dy] = shifts_[i];
      const std::size_t at = terms_[i].place(x0_ + dx, y0_ + y + dy);
      lights_[i] = terms_[i].light.data() + at;
      weights_[i] = terms_[i].weight2.data() + at;
    }
    const std::size_t at = std::size_t(y) * cell_px;
    kernel_({lights_.data(), weights_.data(), terms_.size()}, cell_px, rate,
            {best_.data() + at, rate_.data() + at});
  }

  bool is_peak(int x, int y) const {
    const float here = best_[std::size_t(y) * cell_px + std::size_t(x)];
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, cell_px - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, cell_px - 1); ++u)
        if (best_[std::size_t(v) * cell_px + std::size_t(u)] > here) return false;
    return true;
  }

  std::vector<Candidate> peaks(float min_snr2) const {
    std::vector<Candidate> out;
    for (int y = 0; y < cell_px; ++y)
      for (int x = 0; x < cell_px; ++x) {
        const std::size_t p = std::size_t(y) * cell_px + std::size_t(x);
        if (best_[p] >= min_snr2 && is_peak(x, y))
          out.push_back({best_[p], x0_ + x, y0_ + y, rate_[p]});
      }
    std::stable_sort(out.begin(), out.end(),
                     [](const Candidate& a, const Candidate& b) { return a.snr2 > b.snr2; });
    if (out.size() > max_of_cell) out.resize(max_of_cell);
    return out;
  }

  const TrackScene& scene_;
  const std::vector<Terms>& terms_;
  int x0_, y0_;
  PixelPosition middle_;
  std::vector<LinearMap> maps_;
  std::vector<std::array<long, 2>> shifts_;
  std::vector<const float*> lights_, weights_;  // rows of the frames
  decltype(&sse2::stack_rows) kernel_;
  std::array<float, size> best_{};
  std::array<std::uint32_t, size> rate_{};
};

double step_px_per_s(const FilteredSequence& sequence) {
  return step_sigmas * sequence.sigma_px / sequence.span_s();
}

/// Expected number of maxima of noise above an SNR.
double expected_maxima(double volume, double snr) {
  return volume * std::pow(2 * pi, -2.5) * (snr * snr * snr - 3 * snr) * std::exp(-snr * snr / 2);
}

}  // namespace

double count_of_trial_rates(const FilteredSequence& sequence, const MotionRange& range) {
  return pi * std::pow(range.max_px_per_s / step_px_per_s(sequence), 2);
}

std::vector<PixelPosition> trial_rates(const FilteredSequence& sequence, const MotionRange& range) {
  std::vector<PixelPosition> rates;
  const double step = step_px_per_s(sequence);
  const int reach = int(std::floor(range.max_px_per_s / step));
  for (int v = -reach; v <= reach; ++v)
    for (int u = -reach; u <= reach; ++u)
      if (const PixelPosition rate = range.middle + PixelPosition{u * step, v * step};
          range.has(rate))
        rates.push_back(rate);
  return rates;
}

double stack_threshold(const FilteredSequence& sequence, const MotionRange& range) {
  double mean_s = 0.0, square_s2 = 0.0;
  const auto n = double(sequence.frames.size());
  for (const FilteredLight& frame : sequence.frames) mean_s += frame.time_s / n;
  for (const FilteredLight& frame : sequence.frames)
    square_s2 += std::pow(frame.time_s - mean_s, 2) / n;
  // Noise through the filter has the correlation exp(-r^2 / (4 sigma^2)) over r px.
  const double by_px = 1 / (2 * sequence.sigma_px * sequence.sigma_px);
  const double pixels = double(sequence.columns) * double(sequence.rows);
  const double rates = pi * range.max_px_per_s * range.max_px_per_s;
  const double volume = pixels * by_px * rates * by_px * square_s2;
  double low = 4.0, high = 20.0;
  while (high - low > 1e-6) {
    const double snr = (low + high) / 2;
    (expected_maxima(volume, snr) > max_false ? low : high) = snr;
  }
  return high;
}

std::vector<SkyMotion> stack_motions(const TrackScene& scene, double min_snr, Threads& threads,
                                     const StackProgress& progress) {
  const FilteredSequence& sequence = scene.sequence;
  std::vector<Terms> terms;
  for (const MovingLight& frame : scene.light) terms.emplace_back(frame);
  const std::vector<PixelPosition> rates = trial_rates(sequence, scene.range);
  std::vector<std::pair<int, int>> cells;
  for (int y = 0; y < sequence.rows; y += cell_px)
    for (int x = 0; x < sequence.columns; x += cell_px) cells.emplace_back(x, y);
  std::vector<std::vector<Candidate>> found(cells.size());
  for (std::size_t first = 0; first < cells.size(); first += batch) {
    const std::size_t count = std::min(batch, cells.size() - first);
    threads.for_ranges(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = first + begin; c < first + end; ++c)
        found[c] = StackCell(scene, terms, cells[c].first, cells[c].second)
                       .search(rates, float(min_snr * min_snr));
    });
    if (progress) progress(double(first + count) / double(cells.size()));
  }
  std::vector<Candidate> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.snr2 > b.snr2; });
  if (all.size() > max_candidates) all.resize(max_candidates);
  std::vector<SkyMotion> motions;
  for (const Candidate& c : all) motions.push_back({{double(c.x), double(c.y)}, rates[c.rate]});
  return motions;
}

}  // namespace dmise
