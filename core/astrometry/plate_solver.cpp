#include "core/astrometry/plate_solver.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/base/error.h"
#include "core/frames/quaternion.h"

namespace dmise {
namespace {

/// Widths up to which shapes in a frame do not depend on its projection and scale.
constexpr double flat_rad = 20 * deg;
constexpr double width_step = 1.2;
constexpr double code_tolerance = 0.012;
constexpr std::size_t pattern_sources = 150, growing_sources = 300;
constexpr std::size_t quad_neighbours = 6, triangle_neighbours = 12;
/// Saturated stars take part in a fit only if there are fewer others.
constexpr std::size_t least_exact = 10;
/// A neighbour in the image may be measured fainter by this than its star.
constexpr double fainter = 0.75;
/// Sources, by falling flux, with which patterns begin: few first.
constexpr std::array<std::size_t, 4> rounds{0, 25, 60, 120};

/// A guess of the camera with which directions of sources are computed.
struct Trial {
  Projection projection;
  double focal_length_px = 0.0, focal_low_px = 0.0, focal_high_px = 0.0;
  bool mirrored = false;
};

using Stars = std::array<std::uint32_t, 4>;

class PlateSearcher {
 public:
  PlateSearcher(std::span<const PlateSource> sources, const PlateBelief& belief,
                const PlateSky& sky, const PlateSearch& search, PatternCache& cache);
  PlateSolution solve();

 private:
  Trial trial(double narrow_rad, double middle_rad, double wide_rad) const;
  std::vector<Trial> trials(double narrowest_rad, double widest_rad) const;
  double rank_in_frame(double width_rad) const;
  std::vector<std::uint32_t> stars_near_belief(double width_rad) const;
  void try_all(const PatternIndex& index, const std::vector<Trial>& trials);
  void try_round(const PatternIndex& index, const Trial& trial, std::size_t from, std::size_t to);
  void consider(const Trial& trial, const Stars& images, const Stars& stars);
  bool near_belief(const Trial& trial, const Rotation<CameraFrame, Gcrs>& upright) const;
  bool stars_beside(const PlateModel& model, const Stars& images, const Stars& stars);
  bool grow(const PlateModel& model, PixelPosition from, double size_px);
  void finish(PlateModel model);

  std::optional<Vec<CameraFrame>> upright(const Trial& trial, double focal_length_px,
                                          std::size_t source) const;
  PixelPosition place(std::size_t source) const {
    return {sources_[source].x_px, sources_[source].y_px};
  }
  double reach_rad(const PlateModel& model) const;
  double star_sigma_px(const PlateModel& model) const {
    return search_.star_sigma_rad * model.focal_length_px;
  }
  PixelPosition centre() const { return {(belief_.columns - 1) / 2.0, (belief_.rows - 1) / 2.0}; }
  /// Stars about a frame of which it shows somewhat more than it has sources.
  std::vector<SeenStar> stars_around(const PlateModel& model, std::size_t sources) const {
    constexpr double wider = 1.15;
    const double r = wider * half_diagonal_px();
    const double share = double(belief_.columns) * belief_.rows / (pi * r * r);
    return sky_.brightest(model.axis(), std::min(wider * reach_rad(model), pi),
                          std::size_t(1.3 * double(sources) / share) + 20);
  }
  double half_diagonal_px() const { return 0.5 * std::hypot(belief_.columns, belief_.rows); }

  const PlateBelief& belief_;
  const PlateSky& sky_;
  const PlateSearch& search_;
  PatternCache& cache_;
  std::vector<PlateSource> sources_;     // by falling flux
  std::vector<std::uint32_t> original_;  // their places in the caller's list
  std::optional<SourceGrid> bright_grid_;
  std::size_t bright_ = 0;
  double looked_up_ = 0.0, patterns_ = 0.0;
  std::size_t tried_ = 0;
  std::optional<PlateSolution> found_;
};

PlateSearcher::PlateSearcher(std::span<const PlateSource> sources, const PlateBelief& belief,
                             const PlateSky& sky, const PlateSearch& search,
                             PatternCache& cache)
    : belief_(belief), sky_(sky), search_(search), cache_(cache) {
  const auto usable = [&](const PlateSource& s) {
    const auto& c = s.covariance_px2;
    return std::isfinite(s.x_px) && std::isfinite(s.y_px) && s.x_px >= -0.5 && s.y_px >= -0.5 &&
           s.x_px <= belief.columns - 0.5 && s.y_px <= belief.rows - 0.5 && std::isfinite(s.flux) &&
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
    if (sources_.size() >= 4 * search.most_stars) break;
    const PlateSource& s = sources[i];
    bool twice = false;
    for (int j = -1; j <= 1 && !twice; ++j)
      for (int k = -1; k <= 1 && !twice; ++k) {
        const auto [from, to] = taken.equal_range(key(s.x_px + k, s.y_px + j));
        for (auto at = from; at != to; ++at)
          twice = twice ||
                  std::hypot(at->second.x_px - s.x_px, at->second.y_px - s.y_px) < 0.5;
      }
    if (twice) continue;
    taken.emplace(key(s.x_px, s.y_px), PixelPosition{s.x_px, s.y_px});
    sources_.push_back(s);
    kept.push_back(i);
  }
  original_ = std::move(kept);
  bright_ = std::min(sources_.size(), growing_sources);
  bright_grid_.emplace(std::span(sources_).first(bright_), belief.columns, belief.rows);
}

Trial PlateSearcher::trial(double narrow_rad, double middle_rad, double wide_rad) const {
  const auto focal_px = [&](double width_rad) {
    const double fold = belief_.projection.fold_rad().value_or(pi);
    return 0.5 * belief_.columns /
           belief_.projection.height(std::min({0.5 * width_rad, 0.999 * fold, 85 * deg}));
  };
  return {belief_.projection, focal_px(middle_rad), focal_px(wide_rad), focal_px(narrow_rad)};
}

std::vector<Trial> PlateSearcher::trials(double narrowest_rad, double widest_rad) const {
  std::vector<Trial> list;
  if (belief_.focal_length_px > 0) {
    const double f = belief_.focal_length_px;
    list.push_back({belief_.projection, f, f * (1 - search_.focal_error),
                    f * (1 + search_.focal_error)});
  } else if (widest_rad <= flat_rad) {
    list.push_back(trial(narrowest_rad, narrowest_rad, 1.1 * widest_rad));
  } else {
    const double half = std::sqrt(width_step);
    for (double w = narrowest_rad * half; w / half < widest_rad; w *= width_step)
      list.push_back(trial(w / half / 1.05, w, w * half * 1.05));
  }
  const bool told = belief_.camera_from_gcrs.has_value();
  const bool mirrored =
      told && PlateModel{.camera_from_gcrs = *belief_.camera_from_gcrs}.mirrored();
  const std::size_t count = list.size();
  for (std::size_t i = 0; i < count; ++i) {
    list[i].mirrored = mirrored;
    if (told) continue;
    list.push_back(list[i]);
    list.back().mirrored = true;
  }
  return list;
}

/// Rank of the stars of the whole sky of which a frame of that width shows some 300.
double PlateSearcher::rank_in_frame(double width_rad) const {
  const double w = std::min(width_rad, 120 * deg);
  return 300 * 4 * pi / std::max(w * w * belief_.rows / belief_.columns, 1e-12);
}

std::vector<std::uint32_t> PlateSearcher::stars_near_belief(double width_rad) const {
  const PlateModel model{.projection = belief_.projection,
                         .camera_from_gcrs = *belief_.camera_from_gcrs,
                         .focal_length_px = trials(width_rad, width_rad)[0].focal_low_px,
                         .centre = centre()};
  return sky_.catalogued(model.axis(), reach_rad(model) + search_.pointing_error_rad,
                         2 * rank_in_frame(width_rad));
}

/// Angle from the axis to the farthest corner.
double PlateSearcher::reach_rad(const PlateModel& model) const {
  const double r = half_diagonal_px() / model.focal_length_px;
  const auto corner = model.projection.axis_angle_rad(r, 0);
  return corner ? *corner : model.projection.fold_rad().value_or(pi);
}

std::optional<Vec<CameraFrame>> PlateSearcher::upright(const Trial& trial, double focal_length_px,
                                                       std::size_t source) const {
  const PixelPosition at = (place(source) - centre()) * (1 / focal_length_px);
  const auto c = trial.projection.direction_of(at.x_px, at.y_px);
  if (!c) return std::nullopt;
  return Vec<CameraFrame>{(*c)[0], trial.mirrored ? -(*c)[1] : (*c)[1], (*c)[2]};
}

void PlateSearcher::try_all(const PatternIndex& index, const std::vector<Trial>& trials) {
  patterns_ += double(index.size());
  for (std::size_t r = 0; r + 1 < rounds.size(); ++r)
    for (const Trial& trial : trials) {
      try_round(index, trial, rounds[r], rounds[r + 1]);
      if (found_) return;
    }
}

void PlateSearcher::try_round(const PatternIndex& index, const Trial& trial, std::size_t from,
                              std::size_t to) {
  const std::size_t count = std::min(sources_.size(), pattern_sources);
  std::vector<std::optional<Vec<CameraFrame>>> direction;
  for (std::size_t i = 0; i < count; ++i)
    direction.push_back(upright(trial, trial.focal_length_px, i));
  std::vector<std::uint32_t> near;
  std::vector<std::complex<double>> places;
  for (std::size_t i = from; i < std::min(to, count); ++i) {
    if (!direction[i]) continue;
    near.clear();
    for (std::size_t j = 0; j < count; ++j)
      if (j != i && direction[j] && sources_[j].flux >= fainter * sources_[i].flux)
        near.push_back(std::uint32_t(j));
    const auto kept =
        std::min(near.size(), index.others() == 3 ? quad_neighbours : triangle_neighbours);
    std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(kept), near.end(),
                      [&](std::uint32_t a, std::uint32_t b) {
                        const double da = dot(*direction[i], *direction[a]),
                                     db = dot(*direction[i], *direction[b]);
                        return da != db ? da > db : a < b;
                      });
    near.resize(kept);
    places.clear();
    for (const std::uint32_t j : near) places.push_back(plane_place(*direction[i], *direction[j]));
    visit_patterns(places, index.others(), [&](const StarPattern& pattern) {
      if (found_) return;
      looked_up_ += 1;
      Stars images;
      images.fill(std::uint32_t(i));
      for (std::size_t k = 0; k < std::size_t(index.others()); ++k)
        images[k + 1] = near[pattern.others[k]];
      index.find(pattern.code, code_tolerance, [&](const Stars& stars) {
        if (!found_) consider(trial, images, stars);
      });
    });
  }
}

bool PlateSearcher::near_belief(const Trial& trial,
                                const Rotation<CameraFrame, Gcrs>& upright) const {
  if (!belief_.camera_from_gcrs) return true;
  const auto believed =
      trial.mirrored ? flipped(*belief_.camera_from_gcrs) : *belief_.camera_from_gcrs;
  const Rotation<CameraFrame, CameraFrame> by = upright * believed.inverse();
  const double tilt = std::acos(std::clamp(by.m[2][2], -1.0, 1.0));
  const Quaternion q = quaternion_of(by);
  const double twist = std::remainder(2 * std::atan2(q.z, q.w), 2 * pi);
  return tilt <= search_.pointing_error_rad && std::abs(twist) <= search_.roll_error_rad;
}

/// Judges a pattern of the catalogue that looks like one of the image.
void PlateSearcher::consider(const Trial& trial, const Stars& images, const Stars& stars) {
  const auto u0 = upright(trial, trial.focal_length_px, images[0]),
             u1 = upright(trial, trial.focal_length_px, images[1]);
  const auto& catalogued = sky_.map().index.direction;
  const double in_catalogue = angle_rad(catalogued[stars[0]], catalogued[stars[1]]);
  const double focal = trial.focal_length_px * angle_rad(*u0, *u1) / in_catalogue;
  if (!(focal >= trial.focal_low_px && focal <= trial.focal_high_px)) return;
  const auto v0 = upright(trial, focal, images[0]), v1 = upright(trial, focal, images[1]);
  if (!v0 || !v1) return;
  const auto rotation = triad(*v0, *v1, sky_.direction(stars[0]), sky_.direction(stars[1]));
  if (!near_belief(trial, rotation)) return;
  ++tried_;
  PlateModel model{.projection = trial.projection,
                   .camera_from_gcrs = trial.mirrored ? flipped(rotation) : rotation,
                   .focal_length_px = focal,
                   .centre = centre(),
                   .unit_px = half_diagonal_px()};
  std::vector<PlateMatch> pairs;
  const int points = images[3] == images[0] ? 3 : 4;
  for (std::size_t i = 0; i < std::size_t(points); ++i)
    pairs.push_back({.source = images[i],
                     .pixel = place(images[i]),
                     .covariance_px2 = {1, 0, 1},
                     .direction = sky_.direction(stars[i])});
  const PixelPosition span = place(images[1]) - place(images[0]);
  const double size_px = std::hypot(span.x_px, span.y_px);
  const auto fit = fit_plate(model, pairs, {.focal_length = true}, {.outlier_sigmas = 1e9});
  if (!fit || !(fit->rms_px < 1.0 + 0.02 * size_px)) return;
  if (!(fit->model.focal_length_px > 0.9 * trial.focal_low_px &&
        fit->model.focal_length_px < 1.1 * trial.focal_high_px))
    return;
  if (stars_beside(fit->model, images, stars)) grow(fit->model, place(images[0]), size_px);
}

/// Whether stars beside a pattern are there, too, as far as there are any.
bool PlateSearcher::stars_beside(const PlateModel& model, const Stars& images,
                                 const Stars& stars) {
  const Vec<Gcrs> here = sky_.direction(stars[0]);
  const double size_rad = angle_rad(here, sky_.direction(stars[1]));
  const PixelPosition from = place(images[0]), span = place(images[1]) - from;
  const MatchReach reach{.from = from,
                         .near_px = 1.5,
                         .known_px = 0.0,
                         .growth = 0.02,
                         .most_px = 3 * std::hypot(span.x_px, span.y_px)};
  double odds = 0.0;
  int tested = 0;
  for (const SeenStar& star : sky_.brightest(here, 2.2 * size_rad, 24)) {
    if (std::find(stars.begin(), stars.end(), star.index) != stars.end()) continue;
    const auto at = model.pixel(star.direction);
    if (!at || at->x_px < 0 || at->y_px < 0 || at->x_px > belief_.columns - 1 ||
        at->y_px > belief_.rows - 1)
      continue;
    const double within = reach.at(*at);
    if (within < 0) continue;
    const double chance = std::min(0.5, double(bright_) * pi * within * within /
                                            (double(belief_.columns) * belief_.rows));
    const bool hit = bright_grid_->nearest(*at, within) >= 0;
    odds += hit ? std::log(0.6 / chance) : std::log(0.4 / (1 - chance));
    ++tested;
  }
  return tested < 3 ? odds > -2 : odds > 1;
}

/// Extends a plate from a pattern over the frame; false if the stars do not follow.
bool PlateSearcher::grow(const PlateModel& start, PixelPosition from, double size_px) {
  PlateModel model = start;
  const auto sources = std::span(sources_).first(bright_);
  const auto stars = stars_around(model, bright_);
  double known_px = size_px, rms_px = 1.0;
  for (double radius_px = 1.5 * size_px;; radius_px *= 1.6) {
    const auto pairs = match(model, stars, sources, *bright_grid_, belief_.columns, belief_.rows,
                             {.from = from,
                              .near_px = std::max(1.5, 3 * rms_px),
                              .known_px = known_px,
                              .growth = 0.02,
                              .most_px = radius_px});
    const PlateFitSettings settings{.least_sigma_px = std::max(0.3, star_sigma_px(model))};
    auto fit = fit_plate(model, pairs, {.focal_length = pairs.size() > 2}, settings);
    if (!fit || fit->count < 3) return false;
    // The lens is not quite what is believed.
    if (fit->count >= 30 && fit->rms_px > 0.7)
      if (auto bent = fit_plate(model, pairs, {.focal_length = true, .order = 3}, settings);
          bent && bent->rms_px < 0.7 * fit->rms_px)
        fit = bent;
    if (fit->rms_px > 4.0) return false;
    model = fit->model;
    rms_px = fit->rms_px;
    known_px = radius_px;
    if (radius_px > 2 * half_diagonal_px()) break;
  }
  finish(model);
  return found_.has_value();
}

/// Fits the plate with all sources, as freely as the stars support, and judges it.
void PlateSearcher::finish(PlateModel model) {
  PlateSolution solution;
  std::size_t count = 0, exact = 0;  // of sources, and of those that are not saturated
  while (count < sources_.size() && exact < search_.most_stars)
    exact += !sources_[count++].saturated;
  const auto sources = std::span(sources_).first(count);
  const SourceGrid grid(sources, belief_.columns, belief_.rows);
  solution.stars = stars_around(model, count);
  const PlateFitSettings settings{.least_sigma_px = star_sigma_px(model)};
  const auto pairs_within = [&](double near_px) {
    auto pairs = match(model, solution.stars, sources, grid, belief_.columns, belief_.rows,
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
    best.reset();
    double least = 0.0;
    const auto ignored = std::count_if(pairs.begin(), pairs.end(),
                                       [](const PlateMatch& m) { return m.ignored; });
    const double all = double(pairs.size()) - double(ignored), measured = 2 * all;
    std::vector<PlateFreedom> freedoms{{.focal_length = true},
                                       {.focal_length = true, .centre = true}};
    for (int order = 1; order <= search_.most_order; ++order)
      freedoms.push_back({.focal_length = true, .order = order});
    for (const PlateFreedom& free : freedoms) {
      if (free.size() > 4 && measured < 5.0 * free.size()) continue;
      PlateModel from = model;
      from.order = 0;
      from.distortion.clear();
      if (!free.centre) from.centre = centre();
      const auto fit = fit_plate(from, pairs, free, settings);
      const double degrees = fit ? 2.0 * fit->count - free.size() : 0.0;
      if (!(degrees > 0)) continue;
      // Bayes' information criterion; a residual of a hundredth of a sigma is as good as none.
      const double score = measured * std::log(std::max(fit->chi2 / fit->count, 1e-4)) -
                           2 * std::log(2.0) * (fit->count - all) * 2 +
                           free.size() * std::log(measured);
      if (best && score >= least) continue;
      best = fit;
      least = score;
    }
    if (!best) return;
    model = best->model;
    solution.matches = pairs;
    near_px = std::clamp(5 * best->rms_px, 0.4, near_px);
  }
  solution.fit = *best;
  const double priors = belief_.camera_from_gcrs
                            ? 2 * search_.focal_error * search_.roll_error_rad / pi
                            : 1.0;
  solution.log_odds =
      log_odds(best->model, solution.stars, *best, solution.matches, count, belief_.columns,
               belief_.rows) -
      std::log(std::max(100.0, patterns_ * looked_up_ * priors));
  solution.tried = tried_;
  if (solution.log_odds < search_.least_log_odds) return;
  for (PlateMatch& m : solution.matches) m.source = original_[m.source];
  found_ = std::move(solution);
}

PlateSolution PlateSearcher::solve() {
  const auto fail = [&](const std::string& reason) {
    throw Error("no plate solution: " + reason);
  };
  if (sky_.map().stars.size() == 0) fail("the catalogue has no stars");
  if (sources_.size() < 3) fail("3 sources are needed, got " + std::to_string(sources_.size()));
  double narrow = search_.narrowest_rad, wide = search_.widest_rad;
  if (belief_.focal_length_px > 0) {
    const auto half = belief_.projection.axis_angle_rad(
        0.5 * belief_.columns / belief_.focal_length_px, 0.0);
    narrow = wide = 2 * half.value_or(0.5 * pi);
  }
  // Wide frames first: they need few stars of the catalogue.
  for (const bool flat : {false, true}) {
    const double from = flat ? narrow : std::max(narrow, flat_rad),
                 to = flat ? std::min(wide, flat_rad) : wide;
    if (found_ || from > to || (flat && from >= flat_rad)) continue;
    const auto list = trials(from, to);
    if (!belief_.camera_from_gcrs) {
      try_all(cache_.whole_sky(sky_, rank_in_frame(from)), list);
      continue;
    }
    const auto stars = stars_near_belief(from);
    try_all(PatternIndex(sky_, stars, 5, 3), list);
    if (!found_) try_all(PatternIndex(sky_, stars, triangle_neighbours, 2), list);
  }
  if (!found_)
    fail("no stars of the catalogue are where " + std::to_string(sources_.size()) +
         " sources are, in " + std::to_string(tried_) + " candidates");
  return std::move(*found_);
}

}  // namespace

PlateSolution solve_plate(std::span<const PlateSource> sources, const PlateBelief& belief,
                          const PlateSky& sky, const PlateSearch& search, PatternCache* cache) {
  PatternCache own;
  return PlateSearcher(sources, belief, sky, search, cache ? *cache : own).solve();
}

}  // namespace dmise
