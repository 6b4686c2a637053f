#include "core/sequences/registration.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/base/algebra/small_matrix.h"
#include "core/base/error.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double nowhere_px = -1e9;
constexpr std::size_t voting_stars = 150;  // the brightest, of both frames
constexpr double vote_cell_px = 4.0;
constexpr std::size_t min_votes = 5;
constexpr std::size_t min_for_affine = 12;
constexpr double min_over_chance = 1.2;
constexpr double outlier_scatters = 3.5, min_reach_px = 0.3;
constexpr double max_outlier_chi2 = 14.0;  // 2 degrees of freedom: 1 in 1000 by chance
constexpr double star_error_px = 0.02;     // in the place of a star, by the shape of pixels

struct Pair {
  PixelPosition from, to;
  double ratio;  // light in the frame over that in the reference
  Symmetric2 covariance_px2;
};

double distance_px(PixelPosition a, PixelPosition b) {
  return std::hypot(a.x_px - b.x_px, a.y_px - b.y_px);
}

/// Shift that most pairs of bright stars have in common, and how many; none: {}.
std::pair<PixelPosition, std::size_t> common_shift(const std::vector<PixelPosition>& expected,
                                                   const std::vector<PlateSource>& seen) {
  std::map<std::pair<long, long>, std::size_t> votes;
  const auto cell = [](double px) { return std::lround(px / vote_cell_px); };
  for (std::size_t a = 0; a < std::min(expected.size(), voting_stars); ++a)
    for (std::size_t b = 0; b < std::min(seen.size(), voting_stars); ++b)
      ++votes[{cell(seen[b].x_px - expected[a].x_px), cell(seen[b].y_px - expected[a].y_px)}];
  const auto count = [&](long x, long y) {
    const auto at = votes.find({x, y});
    return at == votes.end() ? std::size_t(0) : at->second;
  };
  std::pair<PixelPosition, std::size_t> best;
  for (const auto& [at, own] : votes) {  // a shift on the border of cells votes in several
    const auto [x, y] = at;
    std::size_t sum = 0;
    for (long v = y - 1; v <= y + 1; ++v)
      for (long u = x - 1; u <= x + 1; ++u) sum += count(u, v);
    sum = 8 * sum + own;
    if (sum > best.second) best = {{double(x) * vote_cell_px, double(y) * vote_cell_px}, sum};
  }
  best.second /= 8;
  return best;
}

/// Error of the way from one star to the other.
Symmetric2 covariance_of(const PlateSource& from, const PlateSource& to) {
  Symmetric2 out;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = from.covariance_px2[k] + to.covariance_px2[k];
  out[0] += 2 * star_error_px * star_error_px;
  out[2] += 2 * star_error_px * star_error_px;
  return out;
}

/// Pairs of stars within reach of each other; each star is in one.
std::vector<Pair> pairs_within(const LinearMap& map, const std::vector<PixelPosition>& expected,
                               const FilteredSequence& sequence, std::size_t frame,
                               double reach_px) {
  const auto &seen = sequence.frames[frame].stars,
             &stars = sequence.frames[sequence.reference].stars;
  const SourceGrid grid(seen, sequence.columns, sequence.rows);
  std::map<int, Pair> best;
  for (std::size_t a = 0; a < expected.size(); ++a) {
    if (stars[a].saturated) continue;
    const PixelPosition at = map(expected[a]);
    const int b = grid.nearest(at, reach_px);
    if (b < 0 || seen[std::size_t(b)].saturated) continue;
    const PlateSource& star = seen[std::size_t(b)];
    const PixelPosition to{star.x_px, star.y_px};
    const auto known = best.find(b);
    if (known == best.end() || distance_px(at, to) < distance_px(map(known->second.from), to))
      best[b] = {expected[a], to, star.flux / std::max(stars[a].flux, 1e-9),
                 covariance_of(stars[a], star)};
  }
  std::vector<Pair> pairs;
  for (const auto& [b, pair] : best) pairs.push_back(pair);
  return pairs;
}

PixelPosition mean_of(const std::vector<Pair>& pairs, PixelPosition Pair::*member) {
  PixelPosition sum;
  for (const Pair& pair : pairs) sum = sum + pair.*member;
  return sum * (1.0 / double(pairs.size()));
}

/// Derivatives of x and of y in a frame by the parameters of a map: both shifts, then the matrix.
using PlaceBy = std::array<SmallVector, 2>;

PlaceBy place_by(PixelPosition from_about) {
  PlaceBy out{};
  for (std::size_t k = 0; k < 2; ++k) {
    out[k][k] = 1.0;
    out[k][2 + 2 * k] = from_about.x_px;
    out[k][3 + 2 * k] = from_about.y_px;
  }
  return out;
}

/// The map that has the least squares of ways over their errors.
RegisteredMap fitted(const std::vector<Pair>& pairs) {
  RegisteredMap out{
      .map = {.about = mean_of(pairs, &Pair::from), .shift = mean_of(pairs, &Pair::to)},
      .parameters = pairs.size() < min_for_affine ? std::size_t(2) : std::size_t(6),
      .factor = {}};
  NormalEquations equations;
  for (const Pair& pair : pairs) {
    const PlaceBy by = place_by(pair.from - out.map.about);
    const PixelPosition way = pair.to - pair.from - (out.map.shift - out.map.about);
    // Two numbers with independent errors of one sigma: W = L L', with the inverse covariance W.
    const Symmetric2 w = inverse_of(pair.covariance_px2);
    const double xx = std::sqrt(w[0]), xy = w[1] / xx, yy = std::sqrt(w[2] - xy * xy);
    SmallVector first{}, second{};
    for (std::size_t i = 0; i < out.parameters; ++i) {
      first[i] = xx * by[0][i] + xy * by[1][i];
      second[i] = yy * by[1][i];
    }
    equations.add(1.0, first, xx * way.x_px + xy * way.y_px);
    equations.add(1.0, second, yy * way.y_px);
  }
  if (!cholesky(equations.matrix, out.parameters)) return out;
  out.factor = equations.matrix;
  const SmallVector x = solve(out.factor, equations.right, out.parameters);
  out.map.shift = out.map.shift + PixelPosition{x[0], x[1]};
  out.map.matrix = {1 + x[2], x[3], x[4], 1 + x[5]};
  return out;
}

double scatter_px(const LinearMap& map, const std::vector<Pair>& pairs) {
  std::vector<double> off;
  for (const Pair& pair : pairs) off.push_back(distance_px(map(pair.from), pair.to));
  return off.empty() ? 0.0 : median_of(off) / 1.1774;  // a Rayleigh distribution has this median
}

std::vector<double> chi2_of(const LinearMap& map, const std::vector<Pair>& pairs) {
  std::vector<double> out;
  for (const Pair& pair : pairs) {
    const PixelPosition off = pair.to - map(pair.from);
    out.push_back(mahalanobis2(pair.covariance_px2, off.x_px, off.y_px));
  }
  return out;
}

/// Squares of ways over those that errors of stars explain; few stars tell little.
double misfit_of(const std::vector<double>& chi2) {
  constexpr double median_chi2 = 1.386;  // with two degrees of freedom
  if (chi2.size() < min_for_affine) return 1.0;
  const auto n = double(chi2.size());
  return median_of(chi2) / median_chi2 * n / (n - 3);  // a map has three unknowns in x and y each
}

/// Without pairs that are farther apart than their errors and the scatter of others allow.
std::vector<Pair> without_outliers(const LinearMap& map, const std::vector<Pair>& pairs) {
  const std::vector<double> chi2 = chi2_of(map, pairs);
  const double most = max_outlier_chi2 * std::max(misfit_of(chi2), 1.0);
  std::vector<Pair> kept;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (chi2[i] < most) kept.push_back(pairs[i]);
  return kept;
}

struct StarMatch {
  RegisteredMap map;
  std::vector<Pair> pairs;  // empty: there is no match
};

/// Pairs that stars at random have within reach.
double chance_pairs(std::size_t expected, std::size_t seen, const FilteredSequence& sequence,
                    double reach_px) {
  return double(expected) * double(seen) * pi * reach_px * reach_px /
         (double(sequence.columns) * double(sequence.rows));
}

/// The map from where stars of the reference frame are expected to where a frame shows them.
StarMatch match_stars(const std::vector<PixelPosition>& expected, const FilteredSequence& sequence,
                      std::size_t frame) {
  const auto& seen = sequence.frames[frame].stars;
  const auto [shift, votes] = common_shift(expected, seen);
  StarMatch match{.map = {.map = {.about = {}, .shift = shift}}, .pairs = {}};
  if (votes < min_votes) return match;
  for (double reach_px : {6.0, 3.0, 1.5, 1.0, 0.0}) {
    if (reach_px == 0.0)
      reach_px = std::max(outlier_scatters * scatter_px(match.map.map, match.pairs), min_reach_px);
    match.pairs = pairs_within(match.map.map, expected, sequence, frame, reach_px);
    const double by_chance = chance_pairs(expected.size(), seen.size(), sequence, reach_px);
    if (double(match.pairs.size()) < double(min_votes) + min_over_chance * by_chance)
      return {.map = {}, .pairs = {}};
    match.map = fitted(match.pairs);
  }
  for (int round = 0; round < 2; ++round) {
    match.pairs = without_outliers(match.map.map, match.pairs);
    match.map = fitted(match.pairs);
  }
  match.map.misfit = misfit_of(chi2_of(match.map.map, match.pairs));
  return match;
}

}  // namespace

LinearMap LinearMap::inverse() const {
  const double det = matrix[0] * matrix[3] - matrix[1] * matrix[2];
  return {.about = shift,
          .shift = about,
          .matrix = {matrix[3] / det, -matrix[1] / det, -matrix[2] / det, matrix[0] / det}};
}

Registration::Registration(const std::vector<SequenceFrame>& frames,
                           const FilteredSequence& sequence)
    : reference_(sequence.reference), maps_(frames.size()) {
  const bool known = std::ranges::none_of(frames, [](const SequenceFrame& frame) {
    return frame.header.unknown.has(FrameFact::pointing);
  });
  for (const SequenceFrame& frame : frames)
    if (known) wcs_.push_back(&frame.header.wcs);
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (i != reference_) fit(sequence, i, frames[i].name);
}

void Registration::fit(const FilteredSequence& sequence, std::size_t frame,
                       const std::string& name) {
  std::vector<PixelPosition> at;
  for (const PlateSource& star : sequence.frames[reference_].stars)
    at.push_back(expected(frame, {star.x_px, star.y_px}));
  const StarMatch match = match_stars(at, sequence, frame);
  if (match.pairs.empty()) {
    if (wcs_.empty())
      throw Error(name +
                  ": shares too few stars with the frame in the middle of the sequence, and "
                  "has no WCS");
    notes_.push_back("sequence: " + name +
                     ": shares too few stars with the frame in the middle of "
                     "the sequence: the WCS is taken as exact");
    return;
  }
  std::vector<double> ratios;
  for (const Pair& pair : match.pairs) ratios.push_back(pair.ratio);
  maps_[frame] = {match.map, match.map.map.inverse(), median_of(ratios)};
}

PixelPosition Registration::expected(std::size_t frame, PixelPosition reference) const {
  if (wcs_.empty() || frame == reference_) return reference;
  const auto pixel = wcs_pixel(*wcs_[frame], wcs_direction(*wcs_[reference_], reference));
  return pixel ? *pixel : PixelPosition{nowhere_px, nowhere_px};
}

PixelPosition Registration::in_frame(std::size_t frame, PixelPosition reference) const {
  return maps_[frame].by_stars.map(expected(frame, reference));
}

PixelPosition Registration::in_reference(std::size_t frame, PixelPosition place) const {
  const PixelPosition at = maps_[frame].back(place);
  if (wcs_.empty() || frame == reference_) return at;
  const auto pixel = wcs_pixel(*wcs_[reference_], wcs_direction(*wcs_[frame], at));
  return pixel ? *pixel : PixelPosition{nowhere_px, nowhere_px};
}

Symmetric2 Registration::error_px2(std::size_t frame, PixelPosition reference) const {
  const RegisteredMap& stars = maps_[frame].by_stars;
  Symmetric2 out{};
  if (stars.parameters == 0) return out;
  const PlaceBy by = place_by(expected(frame, reference) - stars.map.about);
  const auto product = [&](const SmallVector& a, const SmallVector& b) {
    const SmallVector spread = solve(stars.factor, b, stars.parameters);
    double sum = 0.0;
    for (std::size_t i = 0; i < stars.parameters; ++i) sum += a[i] * spread[i];
    return sum * stars.misfit;
  };
  return {product(by[0], by[0]), product(by[0], by[1]), product(by[1], by[1])};
}

LinearMap Registration::around(std::size_t from, std::size_t to, PixelPosition place,
                               double reach_px) const {
  const auto there = [&](PixelPosition p) { return in_frame(to, in_reference(from, p)); };
  const PixelPosition right = there(place + PixelPosition{reach_px, 0}),
                      left = there(place - PixelPosition{reach_px, 0}),
                      below = there(place + PixelPosition{0, reach_px}),
                      above = there(place - PixelPosition{0, reach_px});
  const PixelPosition by_x = (right - left) * (0.5 / reach_px),
                      by_y = (below - above) * (0.5 / reach_px);
  return {.about = place,
          .shift = (right + left + below + above) * 0.25,
          .matrix = {by_x.x_px, by_y.x_px, by_x.y_px, by_y.y_px}};
}

}  // namespace dmise
