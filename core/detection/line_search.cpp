#include "core/detection/line_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dmise {
namespace {

constexpr double most_bend = 0.03;        // sagitta over length
constexpr double climbed_from_snr = 5.2;  // of a beamlet with the best offset and direction
constexpr int most_rounds = 100;          // of moving the ends

/// A trail with one of its five parameters changed by `by_px`: its offset, its direction, either
/// end along it, its curvature.
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

}  // namespace

LineSum sum_along(const FilteredFrame& frame, const Trail& t) {
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const bool by_columns = std::abs(c) >= std::abs(s);
  const double spacing = 1.0 / std::max(std::abs(c), std::abs(s));
  const int size = by_columns ? frame.columns : frame.rows;
  const int across = by_columns ? frame.rows : frame.columns;
  const double centre = by_columns ? t.x_px : t.y_px;
  const double half = std::max(t.length_px / 2, 0.5);
  const double reach = half / spacing;
  const int from = std::max(0, int(std::ceil(centre - reach)));
  const int to = std::min(size - 1, int(std::floor(centre + reach)));
  const std::size_t along_step = by_columns ? 1 : std::size_t(frame.columns);
  const std::size_t across_step = by_columns ? std::size_t(frame.columns) : 1;
  // Along the row or column k the line is at middle + slope (k - centre) + bend (1/3 - r^2).
  const double middle = by_columns ? t.y_px : t.x_px;
  const double slope = by_columns ? s / c : c / s;
  const double bend = t.sagitta_px * (by_columns ? 1 / c : -1 / s);
  const double to_r = spacing / half;
  LineSum out;
  double sum = 0.0;
  int samples = 0;
  for (int k = from; k <= to; ++k) {
    const double d = k - centre, r = d * to_r;
    const double place = middle + slope * d + bend * (1.0 / 3 - r * r);
    if (!(place >= 0 && place < across - 1)) continue;
    const int m = int(place);
    const std::int16_t* at =
        frame.snr.data() + std::size_t(k) * along_step + std::size_t(m) * across_step;
    const std::int16_t a = at[0], b = at[across_step];
    if (a == 0 || b == 0) continue;
    sum += a + (place - m) * (b - a);
    ++samples;
  }
  out.sum = sum;
  out.samples = samples;
  out.slices = std::max(to - from + 1, 1);
  // Interpolation averages the noise of two pixels, with all weights.
  const double averaged = (2 + frame.correlation(1.0)) / 3;
  out.noise = FilteredFrame::steps *
              std::sqrt(std::max(out.samples, 1) * frame.sum_variance(spacing) * averaged);
  return out;
}

double snr_along(const FilteredFrame& frame, const Trail& trail) {
  const LineSum line = sum_along(frame, trail);
  return line.samples > 0 ? line.sum / line.noise : 0.0;
}

Trail climbed(const FilteredFrame& frame, const Trail& start) {
  Fit best = polished(frame, {start, snr_along(frame, start)});
  if (best.snr < climbed_from_snr) return best.trail;
  double along_px = std::max(start.length_px, 4.0);
  for (int round = 0; round < most_rounds && along_px > std::max(1.0, 0.02 * best.trail.length_px);
       ++round) {
    Fit next = best;
    for (const int end : {2, 3})
      for (const double side : {1.0, -1.0}) {
        const Trail trial = changed(best.trail, end, side * along_px);
        const double snr = snr_along(frame, trial);
        // A longer line may need another direction to be the better one.
        if (snr < 0.75 * best.snr) continue;
        const Fit fit = polished(frame, {trial, snr});
        if (fit.snr > next.snr) next = fit;
      }
    if (next.snr > best.snr)
      best = next;
    else
      along_px /= 2;
  }
  return best.trail;
}

Beside beside(const FilteredFrame& frame, const Trail& trail) {
  constexpr int lines = 24, least_lines = 12;  // on each side; in all
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
