#include "core/detection/streaks/join_flashes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/base/units.h"
#include "core/detection/source/star_hypothesis.h"

namespace dmise {
namespace {

constexpr std::size_t max_candidates = 150;
constexpr std::size_t min_flashes = 3;
constexpr double spacing_share = 0.04, spacing_px = 1.5;     // by which spacings may differ
constexpr double length_share = 0.25, length_px = 2.0;       // by which lengths may differ
constexpr double most_brighter = 3.0;                        // ratio of two flashes' light per px
constexpr double off_line_px = 1.0, off_line_share = 0.005;  // and by length, for its bend
constexpr double turn_px = 2.0;          // from a flash's ends to the line through it
constexpr double most_on_trails = 0.05;  // share of stars' trails on the line

/// A source as a piece of a line: where it begins and ends along it.
struct RowFlash {
  std::size_t source = 0;
  double first_px = 0.0, last_px = 0.0, off_px = 0.0;
  double e_per_px = 0.0;

  double length_px() const { return last_px - first_px; }
  double middle_px() const { return 0.5 * (first_px + last_px); }
};

/// A straight line by a place and a direction.
struct RowAxis {
  double x = 0.0, y = 0.0, c = 1.0, s = 0.0;

  double along(const Trail& t) const { return (t.x_px - x) * c + (t.y_px - y) * s; }
  double off(const Trail& t) const { return (t.y_px - y) * c - (t.x_px - x) * s; }
};

RowAxis axis_through(const Trail& a, const Trail& b) {
  const double length = std::hypot(b.x_px - a.x_px, b.y_px - a.y_px);
  return {a.x_px, a.y_px, (b.x_px - a.x_px) / length, (b.y_px - a.y_px) / length};
}

bool may_flash(const Source& source) {
  return source.streak && source.flashes == 0 && !source.beside && source.broad_sigma_px == 0.0 &&
         !source.saturated;
}

/// A source on an axis as a piece of it; empty if it lies beside it or has another direction.
std::optional<RowFlash> piece_on(const RowAxis& axis, const Source& source, std::size_t number,
                                 double tolerance_px) {
  const Trail& t = source.trail();
  const double off = axis.off(t), length = t.length_px;
  if (std::abs(off) > tolerance_px) return std::nullopt;
  const double turn = std::remainder(t.angle_rad - std::atan2(axis.s, axis.c), pi);
  if (std::abs(std::sin(turn)) * length / 2 > turn_px || std::abs(turn) > pi / 3) {
    if (length > turn_px) return std::nullopt;
  }
  const double along = axis.along(t), half = length / 2;
  return RowFlash{.source = number,
                  .first_px = along - half,
                  .last_px = along + half,
                  .off_px = off,
                  .e_per_px = t.flux_e / std::max(length, 1.0)};
}

bool is_near(double a, double b, double share, double px) {
  return std::abs(a - b) < px + share * std::max(std::abs(a), std::abs(b));
}

/// Whether pieces behind each other are flashes of one light: the spacing of their beginnings, but
/// for the first, which may be cut, and of their ends, but for the last, is one; none is longer
/// than those within, which are alike.
bool are_even(std::span<const RowFlash> pieces) {
  const std::size_t n = pieces.size();
  if (n < min_flashes) return false;
  const double spacing = pieces[2].first_px - pieces[1].first_px;
  const double length = pieces[1].length_px();
  if (spacing - length < spacing_px) return false;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const RowFlash &one = pieces[k], &next = pieces[k + 1];
    if (k > 0 && !is_near(next.first_px - one.first_px, spacing, spacing_share, spacing_px))
      return false;
    if (k + 2 < n && !is_near(next.last_px - one.last_px, spacing, spacing_share, spacing_px))
      return false;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const bool within = k > 0 && k + 1 < n;
    const double longer = pieces[k].length_px() - length;
    if (longer > length_px + length_share * length) return false;
    if (within && longer < -(length_px + length_share * length)) return false;
    const double ratio = pieces[k].e_per_px / pieces[1].e_per_px;
    if (ratio > most_brighter || (within && ratio < 1 / most_brighter)) return false;
  }
  return true;
}

/// Whether the exposure cut a flash: it is clearly shorter than one that is whole.
bool is_cut(const RowFlash& piece, const RowFlash& whole) {
  return piece.length_px() < (1 - length_share) * whole.length_px() - length_px;
}

/// Whether the exposure has cut the first or the last: a train of objects has equal streaks.
bool is_no_train(std::span<const RowFlash> flashes) {
  return flashes.size() >= min_flashes &&
         (is_cut(flashes.front(), flashes[1]) || is_cut(flashes.back(), flashes[1]));
}

/// The longest row of flashes on a line through two sources.
std::vector<RowFlash> row_on(const RowAxis& axis, double reach_px,
                             const std::vector<Source>& sources) {
  std::vector<RowFlash> all, best;
  for (std::size_t i = 0; i < sources.size() && i < max_candidates; ++i) {
    if (!may_flash(sources[i])) continue;
    if (const auto piece = piece_on(axis, sources[i], i, off_line_px + off_line_share * reach_px))
      all.push_back(*piece);
  }
  std::ranges::sort(all, {}, &RowFlash::middle_px);
  for (std::size_t a = 0; a + min_flashes <= all.size(); ++a)
    for (std::size_t b = all.size(); b >= a + min_flashes && b - a > best.size(); --b) {
      const std::span row(all.begin() + long(a), b - a);
      if (are_even(row) && is_no_train(row)) best.assign(row.begin(), row.end());
    }
  return best;
}

/// Variance of a place along a source's line, and of its length.
struct AlongErrors {
  double place_px2 = 0.0, length_px2 = 0.0;
};

AlongErrors errors_along(const Source& source) {
  const double c = std::cos(source.trail().angle_rad), s = std::sin(source.trail().angle_rad);
  AlongErrors out;
  out.place_px2 = c * c * source.fit.cov(0, 0) + 2 * c * s * source.fit.cov(0, 1) +
                  s * s * source.fit.cov(1, 1);
  if (source.free & trail_length) {
    const int at = std::popcount(source.free & (unsigned(trail_length) - 1));
    out.length_px2 = source.fit.cov(at, at);
  }
  return out;
}

/// Variance of the end of a row: of its flash, and where that is whole of the dark beyond it.
double end_variance_px2(const Source& source, const RowFlash& end, const RowFlash& whole,
                        double spacing) {
  const AlongErrors errors = errors_along(source);
  const double dark = is_cut(end, whole) ? 0.0 : std::max(spacing - whole.length_px(), 0.0);
  return errors.place_px2 + errors.length_px2 / 4 + dark * dark / 12;
}

/// Straight line through pieces, weighted by their light: offset of its middle and slope, with the
/// variance of both by noise across.
struct Regression {
  double offset_px = 0.0, slope = 0.0, offset_px2 = 0.0, slope_px2 = 0.0;
};

Regression regression_of(std::span<const RowFlash> row, const std::vector<Source>& sources,
                         double middle_px, double sigma_px) {
  double w = 0, wx = 0, wxx = 0, wy = 0, wxy = 0;
  for (const RowFlash& piece : row) {
    const double weight = std::pow(sources[piece.source].snr() / sigma_px, 2);
    const double x = piece.middle_px() - middle_px;
    w += weight, wx += weight * x, wxx += weight * x * x;
    wy += weight * piece.off_px, wxy += weight * x * piece.off_px;
  }
  const double determinant = w * wxx - wx * wx;
  return {(wxx * wy - wx * wxy) / determinant, (w * wxy - wx * wy) / determinant, wxx / determinant,
          w / determinant};
}

/// The streak of which a row is the flashes.
Source joined(const Scene& scene, const RowAxis& axis, std::span<const RowFlash> row,
              const std::vector<Source>& sources) {
  const RowFlash &first = row.front(), &last = row.back();
  const double spacing = row[2].first_px - row[1].first_px;
  const double middle = 0.5 * (first.first_px + last.last_px);
  const Regression line = regression_of(row, sources, middle, scene.sigma_px);
  Source out;
  out.streak = true;
  out.flashes = int(row.size());
  out.free = trail_line | trail_slope;
  Trail t;
  double flux2 = 0.0, moment = 0.0;
  for (const RowFlash& piece : row) {
    const Source& one = sources[piece.source];
    t.flux_e += one.trail().flux_e;
    moment += one.trail().flux_e * (piece.middle_px() - middle);
    flux2 += one.fit.cov(2, 2);
    out.at_edge |= one.at_edge;
  }
  t.x_px = axis.x + middle * axis.c - line.offset_px * axis.s;
  t.y_px = axis.y + middle * axis.s + line.offset_px * axis.c;
  t.angle_rad = std::atan2(axis.s, axis.c) + std::atan(line.slope);
  t.length_px = last.last_px - first.first_px;
  t.slope = std::clamp(6 * moment / (t.flux_e * t.length_px), -1.0, 1.0);
  const double v1 = end_variance_px2(sources[first.source], first, row[1], spacing);
  const double v2 = end_variance_px2(sources[last.source], last, row[1], spacing);
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double along = (v1 + v2) / 4, across = line.offset_px2, both = (v2 - v1) / 2;
  out.fit.trails = {t};
  out.fit.parameters = 6;
  out.fit.converged = true;
  out.fit.covariance.assign(36, 0.0);
  out.fit.add_cov(0, 0, along * c * c + across * s * s);
  out.fit.add_cov(0, 1, (along - across) * c * s);
  out.fit.add_cov(1, 1, along * s * s + across * c * c);
  out.fit.add_cov(2, 2, flux2);
  out.fit.add_cov(3, 3, v1 + v2);
  out.fit.add_cov(0, 3, both * c);
  out.fit.add_cov(1, 3, both * s);
  out.fit.add_cov(4, 4, line.slope_px2);
  out.fit.add_cov(5, 5, 3 * flux2 / (t.flux_e * t.flux_e));
  return out;
}

/// The best row of all pairs of sources, with its axis.
std::pair<RowAxis, std::vector<RowFlash>> best_row(const Scene& scene,
                                                   const std::vector<Source>& sources) {
  std::pair<RowAxis, std::vector<RowFlash>> best;
  const std::size_t count = std::min(sources.size(), max_candidates);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j) {
      const Trail &a = sources[i].trail(), &b = sources[j].trail();
      const double apart = std::hypot(a.x_px - b.x_px, a.y_px - b.y_px);
      if (!may_flash(sources[i]) || !may_flash(sources[j]) || apart < 4 * scene.sigma_px) continue;
      const RowAxis axis = axis_through(a, b);
      Trail line = a;
      line.angle_rad = std::atan2(axis.s, axis.c);
      line.length_px = apart;
      if (share_of_trails_on(scene, line) > most_on_trails) continue;
      auto row = row_on(axis, apart, sources);
      if (row.size() > best.second.size()) best = {axis, std::move(row)};
    }
  return best;
}

}  // namespace

std::vector<Source> with_joined_flashes(const Scene& scene, std::vector<Source> sources) {
  while (true) {
    const auto best = best_row(scene, sources);
    const std::vector<RowFlash>& row = best.second;
    if (row.empty()) return sources;
    Source whole = joined(scene, best.first, row, sources);
    std::vector<Source> left;
    for (std::size_t i = 0; i < sources.size(); ++i)
      if (std::ranges::none_of(row, [&](const RowFlash& piece) { return piece.source == i; }))
        left.push_back(std::move(sources[i]));
    left.push_back(std::move(whole));
    sources = std::move(left);
  }
}

}  // namespace dmise
