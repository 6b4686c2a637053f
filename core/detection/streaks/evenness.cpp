#include "core/detection/streaks/evenness.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/detection/source/line_profile.h"

namespace dmise {
namespace {

/// Evenness of a trail, divided into pieces long enough to be significant: fractions of pieces with
/// its light, and with more than twice its light. Empty if there are too few pieces.
struct Evenness {
  double lit = 0.0, over = 1.0;
};

Evenness evenness_of(const Scene& scene, const Trail& t) {
  const Line line = line_of(t);
  const double level = t.flux_e / t.length_px;
  const Extent extent = in_frame(scene, line, extent_of(line, t.length_px / 2 - scene.sigma_px));
  std::vector<Slice> all;
  std::vector<double> expected;
  double noise = 0.0;
  for (int k = extent.from; k <= extent.to; ++k) {
    const Slice s = slice_at(scene, line, k, 0.0);
    if (!(s.variance > 0)) continue;
    const double along = line.by_columns() ? (k - line.x) / line.ux : (k - line.y) / line.uy;
    all.push_back(s);
    expected.push_back(level * (1 + t.slope * 2 * along / t.length_px));
    noise += s.variance;
  }
  if (all.size() < 6) return {};
  noise = std::sqrt(noise / double(all.size()));
  // Pieces long enough for 4 sigma each, at least 2 px.
  const auto length = std::size_t(std::clamp(std::ceil(std::pow(4 * noise / level, 2)), 2.0, 1e6));
  int pieces = 0, lit = 0, over = 0;
  for (std::size_t i = 0; i + length <= all.size(); i += length) {
    double sum = 0.0, want = 0.0;
    for (std::size_t k = i; k < i + length; ++k) {
      sum += all[k].e_per_px;
      want += expected[k];
    }
    ++pieces;
    lit += sum > 0.4 * want;
    over += sum > 2.0 * want;
  }
  if (pieces < 3) return {};
  return {double(lit) / pieces, double(over) / pieces};
}

}  // namespace

bool is_lit_throughout(const Scene& scene, const Trail& t) {
  constexpr double dimmest = 0.2, sigmas = 4.0;  // a lit piece's share of the mean light; its SNR
  constexpr double longest_sigmas = 6.0;  // piece: two stars at its ends would light a longer one
  const Line line = line_of(t);
  const double least = dimmest * t.flux_e / t.length_px;
  const Extent extent = in_frame(scene, line, extent_of(line, t.length_px / 2 - scene.sigma_px));
  const auto all = slices(scene, line, extent.from, extent.to, 0.0);
  const auto length = std::size_t(std::max(longest_sigmas * scene.sigma_px / line.slice_px(), 1.0));
  if (all.size() < 3 * length) return false;
  for (std::size_t i = 0; i + length <= all.size(); ++i) {
    double sum = 0.0, variance = 0.0;
    for (std::size_t k = i; k < i + length; ++k)
      sum += all[k].e_per_px, variance += all[k].variance;
    if (sum < 0.5 * least * double(length) || sum < sigmas * std::sqrt(variance)) return false;
  }
  return true;
}

bool is_continuous(const Scene& scene, const Trail& t) {
  const Evenness e = evenness_of(scene, t);
  return e.lit >= 0.8 && e.over <= 0.3;
}

bool is_hopeless(const Scene& scene, const Trail& t) {
  const Evenness e = evenness_of(scene, t);
  return e.lit < 0.5 || e.over > 0.4;
}

}  // namespace dmise
