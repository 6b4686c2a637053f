#include "core/detection/source/hidden_ends.h"

#include <algorithm>
#include <cmath>

#include "core/detection/source/source_fit.h"

namespace dmise {
namespace {

/// Length of the gap behind an end, side -1 or 1.
double gap_px(const Scene& scene, const Trail& t, double side) {
  constexpr double step_px = 0.5;
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double max_px = std::min(t.length_px + 6 * scene.sigma_px, scene.diagonal_px());
  double gap = 0.0;
  // Light of the end itself reaches over a seen pixel or two.
  for (double beyond = 0.0; beyond < max_px; beyond += step_px) {
    const double along = side * (t.length_px / 2 + beyond);
    const int x = int(std::lround(t.x_px + along * c)), y = int(std::lround(t.y_px + along * s));
    if (!scene.contains(x, y)) break;
    if (scene.is_hidden(x, y))
      gap = beyond + step_px;
    else if (beyond - gap >= 1.5 * scene.sigma_px)
      break;
  }
  return gap;
}

}  // namespace

HiddenEnds hidden_ends(const Scene& scene, const Trail& trail) {
  return {gap_px(scene, trail, -1), gap_px(scene, trail, 1)};
}

void add_errors_of_hidden_ends(const Scene& scene, Source& source) {
  if (!source.streak || !(source.free & trail_length) || !is_bounded(scene, source.trail())) return;
  const Trail& t = source.trail();
  const HiddenEnds gaps = hidden_ends(scene, t);
  // Variance of the length: each end has a uniform error.
  const double ends_px2 = (gaps.first_px * gaps.first_px + gaps.last_px * gaps.last_px) / 3;
  if (!(ends_px2 > 0)) return;
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double e_per_px = t.flux_e / std::max(t.length_px, 1.0);
  source.fit.add_cov(0, 0, ends_px2 / 4 * c * c);
  source.fit.add_cov(0, 1, ends_px2 / 4 * c * s);
  source.fit.add_cov(1, 1, ends_px2 / 4 * s * s);
  source.fit.add_cov(2, 2, ends_px2 * e_per_px * e_per_px);
  source.fit.add_cov(2, 3, ends_px2 * e_per_px);
  source.fit.add_cov(3, 3, ends_px2);
}

}  // namespace dmise
