#include "core/astrometry/plate_frame.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace dmise {
namespace {

constexpr std::size_t growing_sources = 300;
/// Saturated stars take part in a fit only if there are fewer others.
constexpr std::size_t least_exact = 10;
/// Measurements a parameter from which on it may be chosen, and be heard as a rival.
constexpr double min_measured = 5.0, least_of_rivals = 1.5;
constexpr double min_weight = 0.01;  // a rival has at least so much
/// Distortion of a lens of which nothing is known, at the corner, relative to the way there.
constexpr double unknown_distortion = 0.003;
/// The rest of the distortion of a lens, over its radial term of third order.
constexpr double next_order = 0.1;
constexpr std::size_t radial_term = 8;  // u^3 along x

/// Radial distortion of third order at the corner [px, rms] that a fit with this term allows: what
/// is believed of lenses before, and its measurement.
double allowed_radial_px(const PlateFit& fit, double before_px) {
  const double variance = fit.variance(fit.free.size() - 1);
  const double shrink = before_px * before_px / (before_px * before_px + variance);
  const double mean_px = shrink * fit.model.distortion[radial_term];
  return std::sqrt(mean_px * mean_px + shrink * variance);
}

}  // namespace

PlateFrame::PlateFrame(std::span<const PlateSource> sources, const PlateHint& hint,
                       const PlateSky& sky, const PlateSearch& search)
    : hint_(hint), sky_(sky), search_(search) {
  const auto usable = [&](const PlateSource& s) {
    const auto& c = s.covariance_px2;
    return std::isfinite(s.x_px) && std::isfinite(s.y_px) && s.x_px >= -0.5 && s.y_px >= -0.5 &&
           s.x_px <= hint.columns - 0.5 && s.y_px <= hint.rows - 0.5 && std::isfinite(s.flux) &&
           s.flux > 0 && c[0] >= 0 && c[2] >= 0 && std::isfinite(c[0] + c[1] + c[2]);
  };
  for (std::size_t i = 0; i < sources.size(); ++i)
    if (usable(sources[i])) original_.push_back(std::uint32_t(i));
  std::stable_sort(original_.begin(), original_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return sources[a].flux > sources[b].flux;
  });
  // One source a place: the brightest of those within half a pixel.
  std::vector<std::uint32_t> kept;
  std::unordered_multimap<std::int64_t, PixelPosition> taken;  // by pixel
  const auto key = [](double x, double y) {
    return std::int64_t(std::lround(y)) * (std::int64_t(1) << 32) + std::lround(x);
  };
  for (const std::uint32_t i : original_) {
    if (sources_.size() >= 4 * search.max_stars) break;
    const PlateSource& s = sources[i];
    bool twice = false;
    for (int j = -1; j <= 1 && !twice; ++j)
      for (int k = -1; k <= 1 && !twice; ++k) {
        const auto [from, to] = taken.equal_range(key(s.x_px + k, s.y_px + j));
        for (auto at = from; at != to; ++at)
          twice = twice || std::hypot(at->second.x_px - s.x_px, at->second.y_px - s.y_px) < 0.5;
      }
    if (twice) continue;
    taken.emplace(key(s.x_px, s.y_px), PixelPosition{s.x_px, s.y_px});
    sources_.push_back(s);
    kept.push_back(i);
  }
  original_ = std::move(kept);
  bright_ = std::min(sources_.size(), growing_sources);
  bright_grid_.emplace(std::span(sources_).first(bright_), hint.columns, hint.rows);
}

double PlateFrame::reach_rad(const PlateModel& model) const {
  const double r = half_diagonal_px() / model.focal_length_px;
  const auto corner = model.projection.axis_angle_rad(r, 0);
  return corner ? *corner : model.projection.fold_rad().value_or(pi);
}

std::vector<SeenStar> PlateFrame::stars_around(const PlateModel& model, std::size_t sources) const {
  constexpr double wider = 1.15;
  const double r = wider * half_diagonal_px();
  const double share = double(hint_.columns) * hint_.rows / (pi * r * r);
  return sky_.brightest(model.axis(), std::min(wider * reach_rad(model), pi),
                        std::size_t(1.3 * double(sources) / share) + 20);
}

bool PlateFrame::stars_beside(const PlateModel& model, std::span<const std::uint32_t> pattern,
                              PixelPosition from, double size_px) const {
  const Vec<Gcrs> here = sky_.direction(pattern[0]);
  const double size_rad = angle_rad(here, sky_.direction(pattern[1]));
  const MatchReach reach{
      .from = from, .near_px = 1.5, .known_px = 0.0, .growth = 0.02, .max_px = 3 * size_px};
  double odds = 0.0;
  int tested = 0;
  for (const SeenStar& star : sky_.brightest(here, 2.2 * size_rad, 24)) {
    if (std::find(pattern.begin(), pattern.end(), star.index) != pattern.end()) continue;
    const auto at = model.pixel(star.direction);
    if (!at || at->x_px < 0 || at->y_px < 0 || at->x_px > hint_.columns - 1 ||
        at->y_px > hint_.rows - 1)
      continue;
    const double within = reach.at(*at);
    if (within < 0) continue;
    const double chance = std::min(
        0.5, double(bright_) * pi * within * within / (double(hint_.columns) * hint_.rows));
    const bool hit = bright_grid_->nearest(*at, within) >= 0;
    odds += hit ? std::log(0.6 / chance) : std::log(0.4 / (1 - chance));
    ++tested;
  }
  return tested < 3 ? odds > -2 : odds > 1;
}

std::optional<PlateModel> PlateFrame::grow(const PlateModel& start, PixelPosition from,
                                           double size_px) const {
  PlateModel model = start;
  const auto sources = std::span(sources_).first(bright_);
  const auto stars = stars_around(model, bright_);
  double known_px = size_px, rms_px = 1.0;
  for (double radius_px = 1.5 * size_px;; radius_px *= 1.6) {
    const auto pairs = match(model, stars, sources, *bright_grid_, hint_.columns, hint_.rows,
                             {.from = from,
                              .near_px = std::max(1.5, 3 * rms_px),
                              .known_px = known_px,
                              .growth = 0.02,
                              .max_px = radius_px});
    const PlateFitSettings settings{.min_sigma_px = std::max(0.3, star_sigma_px(model))};
    auto fit = fit_plate(model, pairs, {.focal_length = pairs.size() > 2}, settings);
    if (!fit || fit->count < 3) return std::nullopt;
    // The lens is not quite what is believed.
    if (fit->count >= 8 && fit->rms_px > 0.7)
      if (auto bent = fit_plate(model, pairs, {.focal_length = true, .radial = true}, settings);
          bent && bent->rms_px < 0.7 * fit->rms_px)
        fit = bent;
    if (fit->count >= 30 && fit->rms_px > 0.7)
      if (auto bent = fit_plate(model, pairs, {.focal_length = true, .order = 3}, settings);
          bent && bent->rms_px < 0.7 * fit->rms_px)
        fit = bent;
    if (fit->rms_px > 4.0) return std::nullopt;
    model = fit->model;
    rms_px = fit->rms_px;
    known_px = radius_px;
    if (radius_px > 2 * half_diagonal_px()) return model;
  }
}

std::optional<PlateFit> PlateFrame::best_fit(const PlateModel& model,
                                             std::span<const PlateMatch> pairs,
                                             PlateSolution& solution) const {
  const PlateFitSettings settings{.min_sigma_px = star_sigma_px(model)};
  struct Candidate {
    PlateFit fit;
    double score;
  };
  std::vector<Candidate> candidates;
  std::optional<std::size_t> best;
  const auto ignored =
      std::count_if(pairs.begin(), pairs.end(), [](const PlateMatch& m) { return m.ignored; });
  const double all = double(pairs.size()) - double(ignored), measured = 2 * all;
  std::vector<PlateFreedom> freedoms{{.focal_length = true},
                                     {.focal_length = true, .centre = true},
                                     {.focal_length = true, .radial = true}};
  for (int order = 1; order <= search_.max_order; ++order)
    freedoms.push_back({.focal_length = true, .order = order});
  const double unknown_px = unknown_distortion * half_diagonal_px();
  solution.left_out_px = unknown_px;
  for (const PlateFreedom& free : freedoms) {
    if (free.size() > 4 && measured < least_of_rivals * free.size()) continue;
    PlateModel from = model;
    from.order = 0;
    from.distortion.clear();
    if (!free.centre) from.centre = centre();
    const auto fit = fit_plate(from, pairs, free, settings);
    const double degrees = fit ? 2.0 * fit->count - free.size() : 0.0;
    if (!(degrees > 0)) continue;
    if (free.radial) solution.left_out_px = allowed_radial_px(*fit, unknown_px);
    // Bayes' information criterion; a residual of a hundredth of a sigma is as good as none.
    const double score = measured * std::log(std::max(fit->chi2 / fit->count, 1e-4)) -
                         2 * std::log(2.0) * (fit->count - all) * 2 +
                         free.size() * std::log(measured);
    candidates.push_back({*fit, score});
    // Outliers do not determine parameters.
    const bool determined = free.size() <= 4 || 2.0 * fit->count >= min_measured * free.size();
    if (determined && (!best || score < candidates[*best].score)) best = candidates.size() - 1;
  }
  solution.rivals.clear();
  if (!best) return std::nullopt;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double weight = std::exp(0.5 * (candidates[*best].score - candidates[i].score));
    if (i != *best && weight >= min_weight)
      solution.rivals.push_back({std::move(candidates[i].fit), std::min(weight, 1.0)});
  }
  const PlateFit& chosen = candidates[*best].fit;
  if (chosen.free.radial)
    solution.left_out_px = next_order * std::abs(chosen.model.distortion[radial_term]);
  if (chosen.free.order >= 3) solution.left_out_px = 0.0;
  return chosen;
}

double PlateSolution::sigma_px(const Vec<Gcrs>& direction, PixelPosition pixel) const {
  const double own = fit.sigma_px(direction, pixel);
  double sum = own * own, weights = 1.0;
  for (const PlateRival& rival : rivals) {
    const auto at = rival.fit.model.pixel(direction);
    if (!at) continue;
    const PixelPosition off = *at - pixel;
    const double sigma = rival.fit.sigma_px(direction, *at);
    sum += rival.weight * (sigma * sigma + 0.5 * (off.x_px * off.x_px + off.y_px * off.y_px));
    weights += rival.weight;
  }
  double variance = sum / weights;
  const PlateModel& model = fit.model;
  const PixelPosition at = pixel - model.centre;
  const double r = std::hypot(at.x_px, at.y_px) / model.unit_px, known = reach_px / model.unit_px;
  const double beyond_px = left_out_px * std::max(0.0, r * r * r - known * known * known);
  variance += 0.5 * beyond_px * beyond_px;
  return std::sqrt(variance);
}

std::optional<PlateSolution> PlateFrame::fit(PlateModel model) const {
  PlateSolution solution;
  std::size_t count = 0, exact = 0;  // sources, and those that are not saturated
  while (count < sources_.size() && exact < search_.max_stars)
    exact += !sources_[count++].saturated;
  const auto sources = std::span(sources_).first(count);
  const SourceGrid grid(sources, hint_.columns, hint_.rows);
  solution.stars = stars_around(model, count);
  const auto pairs_within = [&](double near_px) {
    auto pairs = match(model, solution.stars, sources, grid, hint_.columns, hint_.rows,
                       {.near_px = near_px});
    std::size_t sharp = 0;
    for (PlateMatch& m : pairs) {
      m.ignored = sources[m.source].saturated;
      sharp += !m.ignored;
    }
    if (sharp < least_exact)
      for (PlateMatch& m : pairs) m.ignored = false;
    return pairs;
  };
  std::optional<PlateFit> best;
  double near_px = 2.0;
  for (int pass = 0; pass < 3; ++pass) {
    const auto pairs = pairs_within(near_px);
    best = best_fit(model, pairs, solution);
    if (!best) return std::nullopt;
    model = best->model;
    solution.matches = pairs;
    near_px = std::clamp(5 * best->rms_px, 0.4, near_px);
  }
  solution.fit = *best;
  for (std::size_t k = 0; k < solution.matches.size(); ++k) {
    if (!best->used[k]) continue;
    const PixelPosition at = solution.matches[k].pixel - centre();
    solution.reach_px = std::max(solution.reach_px, std::hypot(at.x_px, at.y_px));
  }
  solution.log_odds = log_odds(best->model, solution.stars, *best, solution.matches, count,
                               hint_.columns, hint_.rows);
  for (PlateMatch& m : solution.matches) m.source = original_[m.source];
  return solution;
}

}  // namespace dmise
