#include "core/detection/curve/light_curve.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "core/detection/curve/light_period.h"
#include "core/detection/curve/streak_light.h"
#include "core/detection/source/line_search.h"

namespace dmise {
namespace {

constexpr double min_growth = 1.1;  // a line that grows so has its period measured anew

/// Adds the error of an end that was moved [px^2]: of length and middle.
void add_end_error(Source& source, double variance_px2) {
  if (!(source.free & trail_length)) return;
  const double c = std::cos(source.trail().angle_rad), s = std::sin(source.trail().angle_rad);
  source.fit.add_cov(0, 0, variance_px2 / 4 * c * c);
  source.fit.add_cov(0, 1, variance_px2 / 4 * c * s);
  source.fit.add_cov(1, 1, variance_px2 / 4 * s * s);
  const int length = std::popcount(source.free & (unsigned(trail_length) - 1));
  source.fit.add_cov(length, length, variance_px2);
}

/// Moves ends outwards, a piece at a time, while there is light beyond them; returns whether it
/// has, with the light of the longer line.
bool move_ends(const Scene& scene, StreakLight& light, Source& source) {
  constexpr double sure_sigmas = 3.0, min_share = 0.1, max_lengths = 0.25;
  constexpr std::array ends{TrailChange::first_end, TrailChange::last_end};
  const double length_px = source.trail().length_px, step_px = light.piece_px;
  bool has_moved = false;
  for (std::size_t end = 0; end < 2; ++end) {
    double moved_px = 0.0;
    while (moved_px < max_lengths * length_px) {
      const LightBeyond beyond = light_beyond(light)[end];
      if (beyond.sigmas < sure_sigmas || beyond.share < min_share) break;
      Source longer = source;
      longer.fit.trails[0] = changed(source.trail(), ends[end], step_px);
      auto more = streak_light(scene, longer);
      if (!more) break;
      light = std::move(*more);
      source = std::move(longer);
      moved_px += step_px;
    }
    if (moved_px > 0) add_end_error(source, step_px * step_px / 4);
    has_moved |= moved_px > 0;
  }
  return has_moved;
}

}  // namespace

std::optional<MeasuredCurve> light_curve_of(const Scene& scene, Source& source) {
  auto light = streak_light(scene, source);
  if (!light) return std::nullopt;
  FoundPeriod found = light_period(*light);
  if (found.period && source.flashes == 0) {
    const double before_px = light->length_px;
    if (move_ends(scene, *light, source)) {
      FoundPeriod longer = light_period(*light);
      found.dark_first_px = longer.dark_first_px;
      found.dark_last_px = longer.dark_last_px;
      // A little light beyond an end says little, and may be the wings of a flash beside it.
      if (longer.period && light->length_px > min_growth * before_px) found = longer;
    }
    set_light(*light, source);
  }
  const BinnedLight bins = binned(*light);
  MeasuredCurve out;
  LightCurve& curve = out.curve;
  curve.bin_px = light->piece_px * double(pieces_of_bin);
  bool gap = false;
  for (std::size_t i = 0; i < bins.light_e.size(); ++i) {
    if (!bins.is_measured[i]) {
      gap = true;
      continue;
    }
    if (gap && !curve.correlation.empty()) curve.correlation.back() = 0.0;
    gap = false;
    curve.along_px.push_back((double(i) + 0.5) * curve.bin_px);
    curve.light_e.push_back(bins.light_e[i]);
    curve.sigma_e.push_back(std::sqrt(bins.variance_e2[i]));
    const bool last = i + 1 == bins.light_e.size();
    curve.correlation.push_back(
        last ? 0.0 : bins.next_e2[i] / std::sqrt(bins.variance_e2[i] * bins.variance_e2[i + 1]));
  }
  if (curve.along_px.empty()) return std::nullopt;
  curve.correlation.back() = 0.0;
  curve.period = found.period;
  curve.min_period_px = found.min_period_px;
  out.dark_first_px = found.dark_first_px;
  out.dark_last_px = found.dark_last_px;
  return out;
}

LightCurve reversed(LightCurve curve, double length_px) {
  for (double& px : curve.along_px) px = length_px - px;
  std::ranges::reverse(curve.along_px);
  std::ranges::reverse(curve.light_e);
  std::ranges::reverse(curve.sigma_e);
  // Each is of a bin and the next one: the last has none.
  if (!curve.correlation.empty())
    std::reverse(curve.correlation.begin(), curve.correlation.end() - 1);
  return curve;
}

}  // namespace dmise
