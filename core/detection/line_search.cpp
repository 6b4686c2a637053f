#include "core/detection/line_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace dmise {
namespace {

constexpr double most_bend = 0.03;  // sagitta over length
constexpr int most_rounds = 8;      // of moving the ends

/// The samples of a frame along a trail: one in each row or column, between two pixels.
class Walk {
 public:
  int from = 0, to = -1;  // rows or columns
  double spacing_px = 1.0;

  Walk(const FilteredFrame& frame, const Trail& t) : frame_(frame) {
    const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
    const bool by_columns = std::abs(c) >= std::abs(s);
    spacing_px = 1.0 / std::max(std::abs(c), std::abs(s));
    across_ = by_columns ? frame.rows : frame.columns;
    centre_ = by_columns ? t.x_px : t.y_px;
    const int size = by_columns ? frame.columns : frame.rows;
    const double half = std::max(t.length_px / 2, 0.5);
    const double reach = half / spacing_px;
    from = std::max(0, int(std::ceil(std::max(centre_ - reach, -1.0))));
    to = std::min(size - 1, int(std::floor(std::min(centre_ + reach, double(size)))));
    along_step_ = by_columns ? 1 : std::size_t(frame.columns);
    across_step_ = by_columns ? std::size_t(frame.columns) : 1;
    // Along the row or column k the line is at middle + slope (k - centre) + bend (1/3 - r^2).
    middle_ = by_columns ? t.y_px : t.x_px;
    slope_ = by_columns ? s / c : c / s;
    bend_ = t.sagitta_px * (by_columns ? 1 / c : -1 / s);
    to_r_ = spacing_px / half;
    rises_ = (by_columns ? c : s) > 0;
  }

  /// Calls `visit` (row or column, value, whether it is seen), with value 0 where it is not.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (int k = from; k <= to; ++k) {
      const double d = k - centre_, r = d * to_r_;
      const double place = middle_ + slope_ * d + bend_ * (1.0 / 3 - r * r);
      if (!(place >= 0 && place < across_ - 1)) {
        visit(k, 0.0, false);
        continue;
      }
      const int m = int(place);
      const std::int8_t* at =
          frame_.snr.data() + std::size_t(k) * along_step_ + std::size_t(m) * across_step_;
      const std::int8_t a = at[0], b = at[across_step_];
      if (a == 0 || b == 0)
        visit(k, 0.0, false);
      else
        visit(k, a + (place - m) * (b - a), true);
    }
  }

  /// Distance along the trail from its middle to a row or column.
  double along_px(double k) const { return (rises_ ? 1 : -1) * (k - centre_) * spacing_px; }

 private:
  const FilteredFrame& frame_;
  int across_ = 0;
  double centre_, middle_, slope_, bend_, to_r_;
  std::size_t along_step_, across_step_;
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
  static constexpr int most = 257;  // of a PSF of 32 px
  double averaged_;
  std::array<double, most - 1> twice_;
  int correlated_ = 0;
};

struct Fit {
  Trail trail;
  double snr = 0.0;
};

/// The best offset, direction and curvature of a trail near it.
Fit polished(const FilteredFrame& frame, Fit best) {
  for (double step_px = 1.0; step_px > 0.2;) {
    bool better = false;
    for (const int parameter : {0, 1, 4}) {
      if (parameter == 4 && best.trail.length_px < 40) continue;
      for (const double side : {1.0, -1.0}) {
        const Trail trial = changed(best.trail, parameter, side * step_px);
        const double snr = snr_along(frame, trial);
        if (!(snr > best.snr) || std::abs(trial.sagitta_px) > most_bend * trial.length_px) continue;
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
  constexpr double least_beyond_px = 24.0, turn_px = 0.6;
  constexpr int parts = 96;  // of the line, between which ends are
  const double length = std::max(start.trail.length_px, 4.0);
  const double reach = length / 2 + std::max(least_beyond_px, length);
  Fit best = start;
  std::vector<double> sum;
  std::vector<int> count, at;
  for (const int turn : {0, -1, 1, -2, 2}) {
    Trail line = part_of(start.trail, -reach, reach);
    line.angle_rad += 2 * turn * turn_px / length;
    const Walk walk(frame, line);
    if (walk.to < walk.from) continue;
    const int step = (walk.to - walk.from) / parts + 1;
    sum.assign(1, 0.0), count.assign(1, 0), at.assign(1, walk.from);
    double total = 0.0;
    int samples = 0;
    walk.visit([&](int k, double value, bool seen) {
      total += value;
      samples += seen;
      if ((k + 1 - walk.from) % step != 0 && k != walk.to) return;
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

Trail changed(Trail t, int parameter, double by_px) {
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  switch (parameter) {
    case 0:
      t.x_px -= by_px * s, t.y_px += by_px * c;
      break;
    case 1:
      t.angle_rad += 2 * by_px / std::max(t.length_px, 1.0);
      break;
    case 2:
    case 3: {
      const double way = parameter == 2 ? -1.0 : 1.0;
      const double length = std::max(t.length_px + by_px, 1.0), moved = length - t.length_px;
      t.x_px += 0.5 * way * moved * c, t.y_px += 0.5 * way * moved * s;
      t.sagitta_px *= std::pow(length / std::max(t.length_px, 1.0), 2);
      t.length_px = length;
      break;
    }
    default:
      t.sagitta_px += by_px;
  }
  return t;
}

LineSum sum_along(const FilteredFrame& frame, const Trail& t) {
  const Walk walk(frame, t);
  LineSum out;
  double sum = 0.0;
  walk.visit([&](int, double value, bool seen) {
    sum += value;
    out.samples += seen;
  });
  out.sum = sum;
  out.slices = std::max(walk.to - walk.from + 1, 1);
  out.noise = SumNoise(frame, walk.spacing_px).of(out.samples);
  return out;
}

double snr_along(const FilteredFrame& frame, const Trail& trail) {
  const LineSum line = sum_along(frame, trail);
  return line.samples > 0 ? line.sum / line.noise : 0.0;
}

Trail climbed(const FilteredFrame& frame, const Trail& start, double least_snr) {
  Fit best = polished(frame, {start, snr_along(frame, start)});
  if (best.snr < least_snr) return best.trail;
  for (int round = 0; round < most_rounds; ++round) {
    Fit next = with_best_ends(frame, best);
    if (!(next.snr > best.snr)) break;
    best = polished(frame, next);
  }
  return best.trail;
}

Beside beside(const FilteredFrame& frame, const Trail& trail) {
  constexpr int least_lines = 12;
  // On each side; what is beside a short line changes sooner.
  const int lines = trail.length_px > 100 ? 48 : 24;
  const double c = std::cos(trail.angle_rad), s = std::sin(trail.angle_rad);
  std::vector<double> snr;
  for (int k = -lines; k <= lines; ++k) {
    if (std::abs(k) < 2) continue;
    const double off_px = 4 * frame.sigma_px * k;
    Trail other = trail;
    other.x_px -= off_px * s;
    other.y_px += off_px * c;
    const LineSum line = sum_along(frame, other);
    if (line.samples > 2) snr.push_back(line.sum / line.noise);
  }
  if (snr.size() < least_lines) return {};
  std::sort(snr.begin(), snr.end());
  const double middle = snr[snr.size() / 2];
  const double scatter = (snr[snr.size() * 9 / 10] - middle) / 1.2816;
  return {std::max(middle, 0.0), scatter > 1.35 ? scatter : 1.0};  // so few lines show no less
}

}  // namespace dmise
