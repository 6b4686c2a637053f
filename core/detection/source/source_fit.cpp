#include "core/detection/source/source_fit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/detection/source/line_search.h"

namespace dmise {
namespace {

constexpr double bent_from_px = 15.0;      // shorter streaks are straight
constexpr double sloped_from_px = 15.0;    // and uniformly bright
constexpr int max_rounds = 8;              // fits, each with outliers rejected by the one before
constexpr double settled_px = 0.5;         // convergence of the ends
constexpr double uneven_settled_px = 2.0;  // where the model is far from the light
constexpr double uneven_error = 0.2;

/// Whether a pixel within one pixel of the line is clipped.
bool is_saturated(const Scene& scene, const Trail& trail) {
  const double c = std::cos(trail.angle_rad), s = std::sin(trail.angle_rad);
  const int steps = int(std::ceil(trail.length_px)) + 1;
  const Around around(trail, 1.0);
  for (int i = 0; i <= steps; ++i) {
    const double along = (double(i) / steps - 0.5) * trail.length_px;
    const int x = int(std::lround(trail.x_px + along * c));
    const int y = int(std::lround(trail.y_px + along * s));
    for (int py = y - 1; py <= y + 1; ++py)
      for (int px = x - 1; px <= x + 1; ++px)
        if (scene.contains(px, py) && scene.saturated(px, py) && around.has(px, py)) return true;
  }
  return false;
}

/// Moves `trail` to `target`, but neither end by more than `limit_px`: light beyond was not
/// examined. Returns the requested distance of the farther end.
double move_ends(Trail& trail, const Trail& target, double limit_px) {
  double farthest = 0.0;
  std::array<PixelPosition, 2> ends;
  for (std::size_t i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1 : 1;
    const PixelPosition from = trail.at(side * trail.length_px / 2);
    const PixelPosition way = target.at(side * target.length_px / 2) - from;
    const double distance = std::hypot(way.x_px, way.y_px);
    farthest = std::max(farthest, distance);
    ends[i] = from + way * (distance > limit_px ? limit_px / distance : 1.0);
  }
  trail = target;
  if (farthest <= limit_px) return farthest;
  const PixelPosition chord = ends[1] - ends[0];
  trail.x_px = (ends[0].x_px + ends[1].x_px) / 2;
  trail.y_px = (ends[0].y_px + ends[1].y_px) / 2;
  trail.length_px = std::hypot(chord.x_px, chord.y_px);
  trail.angle_rad = std::atan2(chord.y_px, chord.x_px);
  trail.flux_e *= trail.length_px / std::max(target.length_px, 1.0);
  return farthest;
}

/// Where a trail, followed from its centre to one side, leaves the frame [px]; infinite: nowhere.
double way_to_edge_px(const Trail& t, const Scene& scene, double side) {
  const double c = side * std::cos(t.angle_rad), s = side * std::sin(t.angle_rad);
  const auto way = [](double at, double slope, double size) {
    if (std::abs(slope) < 1e-9) return HUGE_VAL;
    return ((slope > 0 ? size - 0.5 : -0.5) - at) / slope;
  };
  return std::min(way(t.x_px, c, scene.counts.columns), way(t.y_px, s, scene.counts.rows));
}

/// The part of a trail from its centre to one side that is measured: without what leaves the frame
/// and without the pixels that have no value, if it ends in them. May be 0.
double measured_px(const Trail& t, const Scene& scene, double side) {
  constexpr double step_px = 0.25;
  double way_px = std::min(t.length_px / 2, way_to_edge_px(t, scene, side));
  while (way_px > 0 && !has_values_at(scene, t, side * way_px)) way_px -= step_px;
  return std::max(way_px, 0.0);
}

/// Puts an end outside the frame on its edge, and one among pixels without a value on theirs: no
/// pixel measures what is beyond, so that length and light would have no bound. The measured part
/// stays as it is; errors are those after a measurement of that end, by the gain of a Kalman
/// filter.
void end_at_edge(TrailFit& fit, const Scene& scene, double side) {
  Trail& t = fit.trails[0];
  const double way_px = measured_px(t, scene, side) - t.length_px / 2;
  if (!(way_px < 0)) return;
  constexpr double edge_px2 = 0.3 * 0.3;
  const auto n = std::size_t(fit.parameters);
  std::vector<double> h(n, 0.0), gain(n, 0.0);
  h[0] = side * std::cos(t.angle_rad);
  h[1] = side * std::sin(t.angle_rad);
  h[3] = 0.5;
  double variance = edge_px2;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) gain[i] += fit.covariance[i * n + k] * h[k];
  for (std::size_t i = 0; i < n; ++i) variance += h[i] * gain[i];
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) fit.covariance[i * n + k] -= gain[i] * gain[k] / variance;
  const Trail part = changed(t, side < 0 ? TrailChange::first_end : TrailChange::last_end, way_px);
  const double share = part.length_px / t.length_px;
  t = part;
  t.flux_e *= share;
  t.slope *= share;
}

/// Cuts a trail at the frame's edge; returns whether it left it. Where an end is so far beyond that
/// no pixel tells its place, its length can't be fitted.
bool cut_to_frame(const Scene& scene, Trail& t) {
  bool cut = false;
  for (const double side : {-1.0, 1.0}) {
    const double way_px = way_to_edge_px(t, scene, side) - t.length_px / 2, whole_px = t.length_px;
    if (!(way_px < 0) || !(way_px > -whole_px)) continue;
    t = changed(t, side < 0 ? TrailChange::first_end : TrailChange::last_end, way_px);
    t.flux_e *= t.length_px / whole_px;
    cut = true;
  }
  return cut;
}

/// A start without the ends that lie among pixels without a value.
Trail measured_part(Trail t, const Scene& scene) {
  if (!scene.unusable) return t;
  for (const double side : {-1.0, 1.0}) {
    const double way_px = measured_px(t, scene, side) - t.length_px / 2, whole_px = t.length_px;
    if (!(way_px < 0)) continue;
    t = changed(t, side < 0 ? TrailChange::first_end : TrailChange::last_end, way_px);
    t.flux_e *= t.length_px / whole_px;
  }
  return t;
}

bool are_same(const std::vector<FitPixel>& a, const std::vector<FitPixel>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const FitPixel& p, const FitPixel& q) { return p.x == q.x && p.y == q.y; });
}

}  // namespace

std::vector<FitPixel> without_outliers(const std::vector<FitPixel>& pixels,
                                       std::span<const Trail> trails, double background_e,
                                       double tolerance, const Psf& psf) {
  const std::vector<double> light = light_in(pixels, trails, psf);
  std::vector<const FitPixel*> outliers;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const FitPixel& p = pixels[i];
    const double model = light[i];
    const double tolerated = tolerance * model;
    const double limit =
        4.0 * std::sqrt(p.variance_e2 + std::max(model, 0.0) + tolerated * tolerated);
    const double residual = p.signal_e - model - background_e;
    if (residual > limit || residual < -1.5 * limit) outliers.push_back(&p);
  }
  if (outliers.empty()) return pixels;
  std::vector<FitPixel> out;
  for (const FitPixel& p : pixels) {
    const bool near = std::any_of(outliers.begin(), outliers.end(), [&](const FitPixel* o) {
      return std::abs(o->x - p.x) <= 1 && std::abs(o->y - p.y) <= 1;
    });
    if (!near) out.push_back(p);
  }
  return out;
}

std::vector<FitPixel> pixels_near(const Scene& scene, const Trail& trail, double margin_px) {
  const Around around(trail, margin_px);
  std::vector<FitPixel> out;
  std::vector<float> level, sigma;
  around.for_rows(scene.counts.columns, scene.counts.rows, [&](int y, int begin, int end) {
    const std::size_t count = std::size_t(end - begin);
    if (level.size() < count) level.resize(count), sigma.resize(count);
    scene.background.level_row(y, begin, end, level.data());
    scene.background.sigma_row(y, begin, end, sigma.data());
    for (int x = begin; x < end; ++x)
      if (around.has(x, y) && scene.is_usable(x, y))
        out.push_back(
            scene.pixel(x, y, level[std::size_t(x - begin)], sigma[std::size_t(x - begin)]));
  });
  return out;
}

double background_sigma_e(const FitPixel& pixel) {
  return 0.1 * std::sqrt(double(pixel.variance_e2));
}

bool is_bounded(const Scene& scene, const Trail& t) {
  constexpr double max_diagonals = 2.0;  // longest streak through the frame, with room for its fit
  const double max_px = max_diagonals * (scene.diagonal_px() + 6 * scene.sigma_px);
  return std::isfinite(t.x_px + t.y_px + t.flux_e + t.angle_rad + t.slope) &&
         t.length_px <= max_px && std::abs(t.sagitta_px) <= max_px &&
         std::abs(t.x_px) + std::abs(t.y_px) <= 2 * max_px;
}

bool plausible(const Scene& scene, const Trail& t) {
  return is_bounded(scene, t) && t.flux_e > 0 && t.x_px > -1 && t.y_px > -1 &&
         t.x_px < scene.counts.columns && t.y_px < scene.counts.rows;
}

bool has_values_at(const Scene& scene, const Trail& t, double along_px) {
  if (!scene.unusable) return true;
  const auto [x, y] = t.at(along_px);
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double beside_px = 1.5 * scene.sigma_px;
  for (const double off_px : {0.0, -beside_px, beside_px}) {
    const int px = std::clamp(int(std::lround(x - off_px * s)), 0, scene.counts.columns - 1);
    const int py = std::clamp(int(std::lround(y + off_px * c)), 0, scene.counts.rows - 1);
    if (scene.has_value(px, py)) return true;
  }
  return false;
}

Around::Around(const Trail& trail, double margin_px)
    : trail_(trail),
      margin_px_(margin_px),
      cos_(std::cos(trail.angle_rad)),
      sin_(std::sin(trail.angle_rad)) {}

/// The first and the last column of a row outside of which nothing is.
std::pair<int, int> Around::columns_near(int y) const {
  constexpr double most = 1e9, min_sine = 1e-3;
  if (std::abs(sin_) < min_sine) return {int(-most), int(most)};
  const double reach_px = margin_px_ + std::abs(trail_.sagitta_px) + 1;
  const double middle = trail_.x_px + (y - trail_.y_px) * cos_ / sin_;
  const double half = reach_px / std::abs(sin_);
  return {int(std::clamp(middle - half, -most, most)), int(std::clamp(middle + half, -most, most))};
}

std::optional<Source> fit_source(const Scene& scene, const Trail& start, bool streak,
                                 double model_error, bool draft, unsigned free) {
  Source source;
  source.streak = streak;
  source.free = free                                ? free
                : !streak                           ? unsigned(trail_place)
                : start.length_px >= bent_from_px   ? unsigned(trail_bent_line)
                : start.length_px >= sloped_from_px ? unsigned(trail_line | trail_slope)
                                                    : unsigned(trail_line);
  Trail trail = streak ? measured_part(start, scene) : start;
  if (!streak) trail.length_px = 0.0;
  const PixelPosition middle{start.x_px, start.y_px};
  const double sigma_px = scene.psf.sigma_at(middle);
  const double margin_px = 3 * sigma_px + 2.5;
  const double settles_px = model_error > uneven_error ? uneven_settled_px : settled_px;
  const double tolerance = std::clamp(3 * model_error, 0.15, 0.45);
  std::vector<FitPixel> pixels, before;
  double moved_px = 0.0;
  const int min_rounds = draft ? 2 : 3, last_round = draft ? 2 : max_rounds;
  for (int round = 0; round < min_rounds || (round < last_round && moved_px > settles_px);
       ++round) {
    if (!plausible(scene, trail)) return std::nullopt;
    // The nearest Gaussian until the place is known.
    const Psf psf = round + 1 < min_rounds || draft ? Psf(sigma_px) : scene.psf.at(middle);
    const auto all = pixels_near(scene, trail, margin_px);
    // A starting trail has a known brightness only for a streak.
    pixels = round > 0 ? without_outliers(all, {&trail, 1}, source.fit.background_e, tolerance, psf)
             : streak && start.length_px > sloped_from_px
                 ? without_outliers(all, {&trail, 1}, 0.0, 1.0, psf)
                 : all;
    if (pixels.size() < 12 || pixels.size() < all.size() / 2) return std::nullopt;
    FitSettings settings;
    settings.psf = psf;
    settings.model_error = model_error;
    settings.background_sigma_e = background_sigma_e(pixels.front());
    settings.max_steps = 20;
    // Nothing has changed since the round before.
    const bool same_psf = round + 1 != min_rounds || draft || scene.psf.is_round_gaussian();
    if (round > 0 && same_psf && source.fit.converged && moved_px <= settles_px &&
        are_same(pixels, before))
      continue;
    source.fit = fit_trails(pixels, {trail}, {source.free}, settings);
    if (!(source.fit.cov(2, 2) > 0) && cut_to_frame(scene, trail)) {
      source.free &= ~unsigned(trail_length);
      source.fit = fit_trails(pixels, {trail}, {source.free}, settings);
    }
    std::swap(pixels, before);
    hold_ends_at_edge(scene, source);
    moved_px = move_ends(trail, source.fit.trails[0], margin_px - 2 * sigma_px);
  }
  if ((!draft && moved_px > settles_px) || !plausible(scene, trail) ||
      !is_bounded(scene, source.trail()) || !(source.fit.cov(2, 2) > 0))
    return std::nullopt;
  set_flags(scene, trail, source);
  return source;
}

Source part_of(const TrailFit& fit, std::size_t which, unsigned free) {
  const auto parameters = std::size_t(std::popcount(free));
  Source out;
  out.beside = true;
  out.free = free;
  out.fit = fit;
  out.fit.trails = {fit.trails[which]};
  out.fit.parameters = int(parameters + 1);
  std::vector<int> from;
  for (std::size_t k = 0; k < parameters; ++k) from.push_back(int(which * parameters + k));
  from.push_back(fit.parameters - 1);
  out.fit.covariance.clear();
  for (const int i : from)
    for (const int j : from) out.fit.covariance.push_back(fit.cov(i, j));
  return out;
}

void hold_ends_at_edge(const Scene& scene, Source& source) {
  if ((source.free & trail_line) != trail_line || !(source.fit.cov(2, 2) > 0)) return;
  for (const double side : {-1.0, 1.0}) end_at_edge(source.fit, scene, side);
}

void set_flags(const Scene& scene, const Trail& trail, Source& source) {
  const double edge = 2 * scene.psf.sigma_at({trail.x_px, trail.y_px});
  for (const double side : {-1.0, 1.0}) {
    const double half = side * trail.length_px / 2;
    const auto [x, y] = trail.at(half);
    if (source.streak && !has_values_at(scene, trail, half + side * edge)) source.at_edge = true;
    if (x < edge || y < edge || x > scene.counts.columns - 1 - edge ||
        y > scene.counts.rows - 1 - edge)
      source.at_edge = true;
  }
  source.saturated = is_saturated(scene, trail);
}

}  // namespace dmise
