#include "core/detection/source/line_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/numeric/simd_level.h"
#include "core/detection/source/line_kernels.h"

namespace dmise {
namespace {

constexpr double max_bend = 0.03;  // sagitta over length
constexpr int max_rounds = 8;      // moves of the ends

/// The samples of a frame along a trail: one in each row or column, between two pixels.
class Walk {
 public:
  LineSamples line;
  double spacing_px = 1.0;

  Walk(const FilteredFrame& frame, const Trail& t) {
    const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
    const bool by_columns = std::abs(c) >= std::abs(s);
    spacing_px = 1.0 / std::max(std::abs(c), std::abs(s));
    const auto columns = std::size_t(frame.columns);
    line.pixels = frame.snr.data();
    line.count = frame.snr.size();
    line.across = by_columns ? frame.rows : frame.columns;
    line.centre = by_columns ? t.x_px : t.y_px;
    const int size = by_columns ? frame.columns : frame.rows;
    const double half = std::max(t.length_px / 2, 0.5);
    const double reach = half / spacing_px;
    line.from = std::max(0, int(std::ceil(std::max(line.centre - reach, -1.0))));
    line.to = std::min(size - 1, int(std::floor(std::min(line.centre + reach, double(size)))));
    line.along_step = by_columns ? 1 : columns;
    line.across_step = by_columns ? columns : 1;
    line.middle = by_columns ? t.y_px : t.x_px;
    line.slope = by_columns ? s / c : c / s;
    line.bend = t.sagitta_px * (by_columns ? 1 / c : -1 / s);
    line.to_r = spacing_px / half;
    rises_ = (by_columns ? c : s) > 0;
  }

  /// Calls `visit` (row or column, value, whether it is seen), with value 0 where it is not.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (int k = line.from; k <= line.to; ++k) {
      const double d = k - line.centre, r = d * line.to_r;
      const double place = line.middle + line.slope * d + line.bend * (1.0 / 3 - r * r);
      if (!(place >= 0 && place < line.across - 1)) {
        visit(k, 0.0, false);
        continue;
      }
      const int m = int(place);
      const std::int8_t* at =
          line.pixels + std::size_t(k) * line.along_step + std::size_t(m) * line.across_step;
      const std::int8_t a = at[0], b = at[line.across_step];
      if (a == 0 || b == 0)
        visit(k, 0.0, false);
      else
        visit(k, a + (place - m) * (b - a), true);
    }
  }

  /// Distance along the trail from its middle to a row or column.
  double along_px(double k) const { return (rises_ ? 1 : -1) * (k - line.centre) * spacing_px; }

 private:
  bool rises_;
};

/// Noise of sums of samples along a line.
class SumNoise {
 public:
  SumNoise(const FilteredFrame& frame, double spacing_px)
      : averaged_((2 + frame.correlation(1.0)) / 3) {
    for (int k = 1; k < most && k * spacing_px < 8 * frame.sigma_px; ++k)
      twice_[std::size_t(correlated_++)] = 2 * frame.correlation(k * spacing_px);
  }
  double of(int samples) const {
    const int n = std::max(samples, 1);
    double variance = 1.0;
    for (int k = 1; k < n && k <= correlated_; ++k)
      variance += twice_[std::size_t(k - 1)] * (1.0 - double(k) / n);
    // Interpolation averages the noise of two pixels, with all weights.
    return FilteredFrame::steps * std::sqrt(n * variance * averaged_);
  }

 private:
  static constexpr int most = 257;  // samples over 8 sigma of a PSF of 32 px
  double averaged_;
  std::array<double, most - 1> twice_;
  int correlated_ = 0;
};

SampleSum sum_of(const LineSamples& line) {
  static const auto sum_samples =
      kernel_of(best_simd_level(), sse2::sum_samples, avx2::sum_samples, avx512::sum_samples);
  return sum_samples(line);
}

struct Fit {
  Trail trail;
  double snr = 0.0;
};

/// The best offset, direction and curvature of a trail near it.
Fit polished(const FilteredFrame& frame, Fit best) {
  for (double step_px = 1.0; step_px > 0.2;) {
    bool better = false;
    for (const auto what : {TrailChange::offset, TrailChange::direction, TrailChange::curvature}) {
      if (what == TrailChange::curvature && best.trail.length_px < 40) continue;
      for (const double side : {1.0, -1.0}) {
        const Trail trial = changed(best.trail, what, side * step_px);
        const double snr = snr_along(frame, trial);
        if (!(snr > best.snr) || std::abs(trial.sagitta_px) > max_bend * trial.length_px) continue;
        best = {trial, snr};
        better = true;
        break;
      }
    }
    if (!better) step_px /= 2;
  }
  return best;
}

/// A part of a trail, between two distances from its middle.
Trail part_of(const Trail& t, double begin_px, double end_px) {
  Trail part = t;
  const double middle = 0.5 * (begin_px + end_px), share = (end_px - begin_px) / t.length_px;
  const double r = 2 * middle / t.length_px;
  // The parabola's height at the part's middle, and its mean height over the part.
  const double bend = t.sagitta_px * (1.0 / 3 - r * r - share * share / 3);
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  part.length_px = std::max(end_px - begin_px, 1.0);
  part.sagitta_px = t.sagitta_px * share * share;
  part.angle_rad += std::atan(-4 * t.sagitta_px * r / t.length_px);
  part.x_px += middle * c - bend * s;
  part.y_px += middle * s + bend * c;
  return part;
}

/// The best ends of a trail on its line and on lines a little turned, of all that lie within one
/// length beside it: the part of the line with the largest SNR.
Fit with_best_ends(const FilteredFrame& frame, const Fit& start) {
  constexpr double min_beyond_px = 24.0, turn_px = 0.6;
  constexpr int parts = 96;  // pieces of the line, between which ends are
  const double length = std::max(start.trail.length_px, 4.0);
  const double reach = length / 2 + std::max(min_beyond_px, length);
  Fit best = start;
  std::vector<double> sum;
  std::vector<int> count, at;
  for (const int turn : {0, -1, 1, -2, 2}) {
    Trail line = part_of(start.trail, -reach, reach);
    line.angle_rad += 2 * turn * turn_px / length;
    const Walk walk(frame, line);
    const int from = walk.line.from, to = walk.line.to;
    if (to < from) continue;
    const int step = (to - from) / parts + 1;
    sum.assign(1, 0.0), count.assign(1, 0), at.assign(1, from);
    double total = 0.0;
    int samples = 0;
    walk.visit([&](int k, double value, bool seen) {
      total += value;
      samples += seen;
      if ((k + 1 - from) % step != 0 && k != to) return;
      sum.push_back(total);
      count.push_back(samples);
      at.push_back(k + 1);
    });
    std::vector<double> noise(std::size_t(samples) + 1);
    const SumNoise sum_noise(frame, walk.spacing_px);
    for (int n = 1; n <= samples; ++n) noise[std::size_t(n)] = sum_noise.of(n);
    for (std::size_t i = 0; i + 1 < sum.size(); ++i)
      for (std::size_t j = i + 1; j < sum.size(); ++j) {
        const int n = count[j] - count[i];
        if (n < 3 || !(sum[j] - sum[i] > best.snr * noise[std::size_t(n)])) continue;
        const double a = walk.along_px(at[i] - 0.5), b = walk.along_px(at[j] - 0.5);
        if (std::min(a, b) > 0.25 * length || std::max(a, b) < -0.25 * length) continue;
        best = {part_of(line, std::min(a, b), std::max(a, b)),
                (sum[j] - sum[i]) / noise[std::size_t(n)]};
      }
  }
  if (!(best.snr > start.snr)) return start;
  best.snr = snr_along(frame, best.trail);
  return best;
}

}  // namespace

Trail changed(Trail t, TrailChange what, double by_px) {
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  switch (what) {
    case TrailChange::offset:
      t.x_px -= by_px * s, t.y_px += by_px * c;
      break;
    case TrailChange::direction:
      t.angle_rad += 2 * by_px / std::max(t.length_px, 1.0);
      break;
    case TrailChange::first_end:
    case TrailChange::last_end: {
      const double way = what == TrailChange::first_end ? -1.0 : 1.0;
      const double length = std::max(t.length_px + by_px, 1.0), moved = length - t.length_px;
      t.x_px += 0.5 * way * moved * c, t.y_px += 0.5 * way * moved * s;
      t.sagitta_px *= std::pow(length / std::max(t.length_px, 1.0), 2);
      t.length_px = length;
      break;
    }
    case TrailChange::curvature:
      t.sagitta_px += by_px;
  }
  return t;
}

LineSum sum_along(const FilteredFrame& frame, const Trail& t) {
  const Walk walk(frame, t);
  const SampleSum sum = sum_of(walk.line);
  LineSum out;
  out.sum = double(sum.sum) / (1 << SampleSum::bits);
  out.samples = sum.samples;
  out.noise = SumNoise(frame, walk.spacing_px).of(sum.samples);
  out.slices = std::max(walk.line.to - walk.line.from + 1, 1);
  return out;
}

double snr_along(const FilteredFrame& frame, const Trail& trail) {
  const LineSum line = sum_along(frame, trail);
  return line.samples > 0 ? line.sum / line.noise : 0.0;
}

Trail climbed(const FilteredFrame& frame, const Trail& start, double min_snr) {
  Fit best = polished(frame, {start, snr_along(frame, start)});
  if (best.snr < min_snr) return best.trail;
  for (int round = 0; round < max_rounds; ++round) {
    Fit next = with_best_ends(frame, best);
    if (!(next.snr > best.snr)) break;
    best = polished(frame, next);
  }
  return best.trail;
}

BandSums LineBand::of(int reach, bool has_odd) {
  const int width = (2 * reach + BandSums::block) / BandSums::block * BandSums::block;
  const auto size = std::size_t(width);
  sum.assign(size, 0);
  samples.assign(size, 0);
  part.assign(size, 0);
  part_count.assign(size, 0);
  row.assign(size + BandSums::spare, 0);
  return {.reach = reach,
          .width = width,
          .has_odd = has_odd,
          .sum = sum.data(),
          .samples = samples.data(),
          .part = part.data(),
          .part_count = part_count.data(),
          .row = row.data()};
}

ParallelLines parallel_lines(const FilteredFrame& frame, const TurnedFrame& turned,
                             const Trail& trail, LineBand& band) {
  constexpr int min_lines = 12;
  constexpr int widest_step = 24;  // farther lines are not summed together
  // On each side; what is beside a short line changes sooner.
  const int lines = trail.length_px > 100 ? 48 : 24;
  const Walk walk(frame, trail);
  LineSamples line = walk.line;
  if (line.across_step != 1) {
    line.pixels = turned.snr.data();
    line.along_step = std::size_t(turned.rows);
    line.across_step = 1;
  }
  // Lines are moved along rows, or columns: so far that they are 4 sigma apart.
  const int step = std::max(1, int(std::lround(4 * frame.sigma_px * walk.spacing_px)));
  const SumNoise noise(frame, walk.spacing_px);
  static const auto sum_band =
      kernel_of(best_simd_level(), sse2::sum_band, avx2::sum_band, avx512::sum_band);
  const bool together = step <= widest_step;
  BandSums sums;
  if (together) {
    sums = band.of(lines * step, step % 2 != 0);
    sum_band(line, sums);
  }
  std::vector<double> snr;
  snr.reserve(std::size_t(2 * lines + 1));
  for (int k = -lines; k <= lines; ++k) {
    if (std::abs(k) < 2) continue;
    double sum;
    int samples;
    if (together) {
      const std::size_t at = sums.place_of((lines + k) * step);
      sum = double(band.sum[at]) / (1 << BandSums::bits);
      samples = band.samples[at];
    } else {
      LineSamples other = line;
      other.middle += k * step;
      const SampleSum one = sum_of(other);
      sum = double(one.sum) / (1 << SampleSum::bits);
      samples = one.samples;
    }
    if (samples > 2) snr.push_back(sum / noise.of(samples));
  }
  if (snr.size() < min_lines) return {};
  std::sort(snr.begin(), snr.end());
  const double median = snr[snr.size() / 2];
  const double scatter = (snr[snr.size() * 9 / 10] - median) / 1.2816;
  return {std::max(median, 0.0), scatter > 1.35 ? scatter : 1.0};  // so few lines show no less
}

}  // namespace dmise
