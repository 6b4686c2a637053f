#include "core/detection/faint_ends.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/detection/components.h"
#include "core/detection/line_profile.h"

namespace dmise {
namespace {

constexpr double faint_per_px = 4.0;      // SNR over the root of the length; brighter ends are seen
constexpr double least_beyond_px = 24.0;  // beyond an end, where light may be its own
constexpr int most_places = 256;          // of an end
constexpr double least_step_px = 0.5;
constexpr double edge_sigmas = 4.0;  // of the PSF, within which an end is in a slice
constexpr double negligible = 20.0;  // logarithm of odds
constexpr int turns = 3;             // to each side, by so much at the ends:
constexpr double turn_px = 0.6;

double cumulative(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// A slice's light per px over its variance, and the inverse of that, at a place along the line.
struct Sample {
  double along_px, light, weight;
};

/// Light along a trail's line and beyond its ends, by rising place.
std::vector<Sample> samples_along(const Scene& scene, const Trail& t) {
  const Line line = line_of(t);
  const double reach_px = t.length_px / 2 + std::max(least_beyond_px, t.length_px);
  const Extent extent = extent_of(line, reach_px);
  double level_e = 0.0, scatter2 = 1.0;  // of the sky that faint stars make
  if (scene.flat) {
    const FilteredFrame::Cell cell = scene.flat->cell_at(t.x_px, t.y_px);
    const int x = std::clamp(int(t.x_px), 0, scene.counts.columns - 1);
    const int y = std::clamp(int(t.y_px), 0, scene.counts.rows - 1);
    const double in_pixel = double(cell.middle) / FilteredFrame::steps *
                            std::sqrt(kernel_square_sum(scene.flat->sigma_px)) *
                            std::sqrt(double(scene.pixel(x, y).variance_e2));
    level_e = in_pixel * 2 * std::sqrt(pi) * scene.sigma_px;
    scatter2 = double(cell.scatter) * double(cell.scatter);
  }
  const double centre = line.by_columns() ? line.x : line.y;
  const bool rises = (line.by_columns() ? line.ux : line.uy) > 0;
  std::vector<Sample> out;
  for (int k = extent.from; k <= extent.to; ++k) {
    const Slice s = slice_at(scene, line, k, 0.0);
    if (!(s.variance > 0)) continue;
    const double weight = 1 / (s.variance * scatter2);
    out.push_back({(rises ? 1 : -1) * (k - centre) * line.slice_px(),
                   (s.e_per_px - level_e) * weight, weight});
  }
  if (!rises) std::reverse(out.begin(), out.end());
  return out;
}

/// Sums over samples of light that is on one side of an end, blurred by the PSF.
struct Beyond {
  double along_px, light, weight, square;
};

std::vector<Beyond> sums_beyond(const std::vector<Sample>& samples, double sigma_px) {
  const double first = samples.front().along_px, last = samples.back().along_px;
  const double step = std::max(least_step_px, (last - first) / (most_places - 1));
  std::vector<double> light(samples.size() + 1), weight(samples.size() + 1);
  for (std::size_t k = samples.size(); k-- > 0;) {
    light[k] = light[k + 1] + samples[k].light;
    weight[k] = weight[k + 1] + samples[k].weight;
  }
  std::vector<Beyond> out;
  std::size_t begin = 0, end = 0;
  for (double at = first; at <= last; at += step) {
    while (begin < samples.size() && samples[begin].along_px < at - edge_sigmas * sigma_px) ++begin;
    while (end < samples.size() && samples[end].along_px <= at + edge_sigmas * sigma_px) ++end;
    Beyond b{at, light[end], weight[end], weight[end]};
    for (std::size_t k = begin; k < end; ++k) {
      const double share = cumulative((samples[k].along_px - at) / sigma_px);
      b.light += share * samples[k].light;
      b.weight += share * samples[k].weight;
      b.square += share * share * samples[k].weight;
    }
    out.push_back(b);
  }
  return out;
}

}  // namespace

std::optional<EndErrors> errors_of_faint_ends(const Scene& scene, const Source& source) {
  const Trail& t = source.trail();
  if (!source.streak || source.saturated ||
      !(source.snr() < faint_per_px * std::sqrt(std::max(t.length_px, 4.0))))
    return std::nullopt;
  // The light beyond may be on a line a little turned.
  std::vector<std::vector<Beyond>> lines;
  for (int turn = -turns; turn <= turns; ++turn) {
    Trail line = t;
    line.angle_rad += 2 * turn * turn_px / std::max(t.length_px, 4.0);
    const auto samples = samples_along(scene, line);
    if (samples.size() >= 3) lines.push_back(sums_beyond(samples, scene.sigma_px));
  }
  const double least_px = 3 * scene.sigma_px;
  // Logarithm of the odds of a line between two ends, of any brightness.
  const auto odds = [](const Beyond& a, const Beyond& b) {
    const double light = a.light - b.light;
    const double squares = a.square - 2 * b.weight + b.square;
    if (!(light > 0) || !(squares > 0)) return -HUGE_VAL;
    return 0.5 * light * light / squares - 0.5 * std::log(squares);
  };
  double most = -HUGE_VAL;
  const auto for_pairs = [&](const auto& visit) {
    for (const auto& ends : lines)
      for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t j = i + 1; j < ends.size(); ++j)
          if (ends[j].along_px - ends[i].along_px >= least_px) visit(ends[i], ends[j]);
  };
  for_pairs([&](const Beyond& a, const Beyond& b) { most = std::max(most, odds(a, b)); });
  if (!(most > -HUGE_VAL)) return std::nullopt;
  EndErrors errors;
  double all = 0.0;
  for_pairs([&](const Beyond& a, const Beyond& b) {
    const double less = most - odds(a, b);
    if (less > negligible) return;
    const double likely = std::exp(-less);
    const double middle_px = 0.5 * (a.along_px + b.along_px);
    const double longer_px = b.along_px - a.along_px - t.length_px;
    all += likely;
    errors.middle_px2 += likely * middle_px * middle_px;
    errors.length_px2 += likely * longer_px * longer_px;
  });
  errors.middle_px2 /= all;
  errors.length_px2 /= all;
  return errors;
}

}  // namespace dmise
