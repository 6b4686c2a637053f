#include "core/astrometry/plate_solver.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/frames/quaternion.h"

namespace dmise {
namespace {

/// Widths up to which shapes in a frame do not depend on its projection and scale.
constexpr double flat_rad = 20 * deg;
constexpr double width_step = 1.2;
constexpr double code_tolerance = 0.012;
constexpr std::size_t pattern_sources = 150;
constexpr std::size_t quad_neighbours = 6, triangle_neighbours = 12;
/// Stars that a frame is expected to show, over those of which patterns are whole in it.
constexpr double shown_more = 10.0;
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
  PlateSearcher(std::span<const PlateSource> sources, const PlateHint& hint, const PlateSky& sky,
                const PlateSearch& search, PatternCache& cache);
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
  void judge(const PlateModel& model);

  std::optional<Vec<CameraFrame>> upright(const Trial& trial, double focal_length_px,
                                          std::size_t source) const;

  const PlateHint& hint_;
  const PlateSky& sky_;
  const PlateSearch& search_;
  PatternCache& cache_;
  PlateFrame frame_;
  double looked_up_ = 0.0, patterns_ = 0.0;
  std::size_t tried_ = 0;
  std::optional<PlateSolution> found_;
};

PlateSearcher::PlateSearcher(std::span<const PlateSource> sources, const PlateHint& hint,
                             const PlateSky& sky, const PlateSearch& search, PatternCache& cache)
    : hint_(hint), sky_(sky), search_(search), cache_(cache), frame_(sources, hint, sky, search) {}

Trial PlateSearcher::trial(double narrow_rad, double middle_rad, double wide_rad) const {
  const auto focal_px = [&](double width_rad) {
    const double fold = hint_.projection.fold_rad().value_or(pi);
    return 0.5 * hint_.columns /
           hint_.projection.height(std::min({0.5 * width_rad, 0.999 * fold, 85 * deg}));
  };
  return {hint_.projection, focal_px(middle_rad), focal_px(wide_rad), focal_px(narrow_rad)};
}

std::vector<Trial> PlateSearcher::trials(double narrowest_rad, double widest_rad) const {
  std::vector<Trial> list;
  if (hint_.focal_length_px > 0) {
    const double f = hint_.focal_length_px;
    list.push_back(
        {hint_.projection, f, f * (1 - search_.focal_error), f * (1 + search_.focal_error)});
  } else if (widest_rad <= flat_rad) {
    list.push_back(trial(narrowest_rad, narrowest_rad, 1.1 * widest_rad));
  } else {
    const double half = std::sqrt(width_step);
    for (double w = narrowest_rad * half; w / half < widest_rad; w *= width_step)
      list.push_back(trial(w / half / 1.05, w, w * half * 1.05));
  }
  const bool told = hint_.camera_from_gcrs.has_value();
  const bool mirrored = told && PlateModel{.camera_from_gcrs = *hint_.camera_from_gcrs}.mirrored();
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
  return 300 * 4 * pi / std::max(w * w * hint_.rows / hint_.columns, 1e-12);
}

std::vector<std::uint32_t> PlateSearcher::stars_near_belief(double width_rad) const {
  PlateModel model{.projection = hint_.projection,
                   .camera_from_gcrs = {},
                   .focal_length_px = trials(width_rad, width_rad)[0].focal_low_px,
                   .centre = frame_.centre()};
  if (hint_.camera_from_gcrs) model.camera_from_gcrs = *hint_.camera_from_gcrs;
  return sky_.catalogued(hint_.camera_from_gcrs ? model.axis() : *hint_.axis,
                         frame_.reach_rad(model) + search_.pointing_error_rad,
                         2 * rank_in_frame(width_rad));
}

std::optional<Vec<CameraFrame>> PlateSearcher::upright(const Trial& trial, double focal_length_px,
                                                       std::size_t source) const {
  const PixelPosition at = (frame_.place(source) - frame_.centre()) * (1 / focal_length_px);
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
  const std::size_t count = std::min(frame_.sources().size(), pattern_sources);
  std::vector<std::optional<Vec<CameraFrame>>> direction;
  for (std::size_t i = 0; i < count; ++i)
    direction.push_back(upright(trial, trial.focal_length_px, i));
  std::vector<std::uint32_t> near;
  std::vector<std::complex<double>> places;
  for (std::size_t i = from; i < std::min(to, count); ++i) {
    if (!direction[i]) continue;
    near.clear();
    for (std::size_t j = 0; j < count; ++j)
      if (j != i && direction[j] && frame_.sources()[j].flux >= fainter * frame_.sources()[i].flux)
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
  if (!hint_.camera_from_gcrs)
    return !hint_.axis || angle_rad(upright.inverse() * Vec<CameraFrame>{0, 0, 1}, *hint_.axis) <=
                              search_.pointing_error_rad;
  const auto believed = trial.mirrored ? flipped(*hint_.camera_from_gcrs) : *hint_.camera_from_gcrs;
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
                   .centre = frame_.centre(),
                   .unit_px = frame_.half_diagonal_px()};
  std::vector<PlateMatch> pairs;
  const int points = images[3] == images[0] ? 3 : 4;
  for (std::size_t i = 0; i < std::size_t(points); ++i)
    pairs.push_back({.source = images[i],
                     .pixel = frame_.place(images[i]),
                     .covariance_px2 = {1, 0, 1},
                     .direction = sky_.direction(stars[i])});
  const PixelPosition span = frame_.place(images[1]) - frame_.place(images[0]);
  const double size_px = std::hypot(span.x_px, span.y_px);
  const auto fit = fit_plate(model, pairs, {.focal_length = true}, {.outlier_sigmas = 1e9});
  if (!fit || !(fit->rms_px < 1.0 + 0.02 * size_px)) return;
  if (!(fit->model.focal_length_px > 0.9 * trial.focal_low_px &&
        fit->model.focal_length_px < 1.1 * trial.focal_high_px))
    return;
  if (!frame_.stars_beside(fit->model, stars, frame_.place(images[0]), size_px)) return;
  if (const auto grown = frame_.grow(fit->model, frame_.place(images[0]), size_px)) judge(*grown);
}

/// Keeps a plate that is no chance after all that was compared.
void PlateSearcher::judge(const PlateModel& model) {
  auto solution = frame_.fit(model);
  if (!solution) return;
  const double priors =
      hint_.camera_from_gcrs ? 2 * search_.focal_error * search_.roll_error_rad / pi : 1.0;
  solution->log_odds -= std::log(std::max(100.0, patterns_ * looked_up_ * priors));
  solution->tried = tried_;
  if (solution->log_odds >= search_.min_log_odds) found_ = std::move(solution);
}

PlateSolution PlateSearcher::solve() {
  const auto fail = [&](const std::string& reason) { throw Error("no plate solution: " + reason); };
  if (sky_.map().stars.size() == 0) fail("the catalogue has no stars");
  if (frame_.sources().size() < 3)
    fail("3 sources are needed, got " + std::to_string(frame_.sources().size()));
  double narrow = search_.narrowest_rad, wide = search_.widest_rad;
  if (hint_.focal_length_px > 0) {
    const auto half =
        hint_.projection.axis_angle_rad(0.5 * hint_.columns / hint_.focal_length_px, 0.0);
    narrow = wide = 2 * half.value_or(0.5 * pi);
  }
  // Wide frames first: they need few stars of the catalogue.
  for (const bool flat : {false, true}) {
    const double from = flat ? narrow : std::max(narrow, flat_rad),
                 to = flat ? std::min(wide, flat_rad) : wide;
    if (found_ || from > to || (flat && from >= flat_rad)) continue;
    const auto list = trials(from, to);
    // Without a focal length patterns of all sizes are needed; those of the whole sky are kept.
    const bool is_near = hint_.camera_from_gcrs || (hint_.axis && hint_.focal_length_px > 0);
    if (!is_near) {
      try_all(cache_.whole_sky(sky_, rank_in_frame(from)), list);
      if (found_) continue;
      if (const auto* deeper = cache_.fainter(sky_, rank_in_frame(from) / shown_more))
        try_all(*deeper, list);
      continue;
    }
    const auto stars = stars_near_belief(from);
    try_all(PatternIndex(sky_, stars, 5, 3), list);
    if (!found_) try_all(PatternIndex(sky_, stars, triangle_neighbours, 2), list);
  }
  if (!found_)
    fail("stars of the catalogue match the " + std::to_string(frame_.sources().size()) +
         " sources in none of " + std::to_string(tried_) + " candidates");
  return std::move(*found_);
}

}  // namespace

PlateSolution solve_plate(std::span<const PlateSource> sources, const PlateHint& hint,
                          const PlateSky& sky, const PlateSearch& search, PatternCache* cache) {
  PatternCache own;
  return PlateSearcher(sources, hint, sky, search, cache ? *cache : own).solve();
}

}  // namespace dmise
