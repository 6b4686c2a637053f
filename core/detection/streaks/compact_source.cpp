#include "core/detection/streaks/compact_source.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/algebra/symmetric2.h"
#include "core/base/units.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/source_fit.h"
#include "core/detection/source/star_hypothesis.h"
#include "core/detection/source/template_snr.h"
#include "core/detection/streaks/faint_streaks.h"
#include "core/detection/streaks/points_beside.h"

namespace dmise {
namespace {

// Relative error of the PSF where two points are compared with a line: a PSF that is too long looks
// like a line.
constexpr double pair_model_error = 0.01;
constexpr double fit_keeps = 0.8;  // a fit of the sky too leaves so much of a faint source's SNR

struct Light {
  std::vector<FitPixel> usable;   // pixels to fit
  std::vector<FitPixel> clipped;  // saturated
};

/// Pixels of a component and their neighbours.
Light light_around(const Scene& scene, const Component& component) {
  std::map<int, std::vector<std::pair<int, int>>> rows;
  for (const Run& run : component.runs)
    for (int y = run.y - 1; y <= run.y + 1; ++y)
      if (y >= 0 && y < scene.counts.rows)
        rows[y].push_back(
            {std::max(0, run.first_x - 1), std::min(scene.counts.columns - 1, run.last_x + 1)});
  Light out;
  for (auto& [y, spans] : rows) {
    std::sort(spans.begin(), spans.end());
    int done = -1;
    for (const auto& [first, last] : spans)
      for (int x = std::max(first, done + 1); x <= last; ++x) {
        done = x;
        if (scene.has_value(x, y) && !scene.is_hidden(x, y))
          (scene.is_usable(x, y) ? out.usable : out.clipped).push_back(scene.pixel(x, y));
      }
  }
  return out;
}

/// Moments of the light: centroid, and the uniform trail of the same spread.
Trail moments(const std::vector<FitPixel>& pixels, double sigma_px) {
  double f = 0, x = 0, y = 0;
  for (const auto& p : pixels) {
    const double w = std::max(p.signal_e, 0.0f);
    f += w;
    x += w * p.x;
    y += w * p.y;
  }
  if (!(f > 0)) return {};
  x /= f;
  y /= f;
  Symmetric2 spread{};
  auto& [xx, xy, yy] = spread;
  double total = 0;
  for (const auto& p : pixels) {
    const double w = std::max(p.signal_e, 0.0f) / f, dx = p.x - x, dy = p.y - y;
    xx += w * dx * dx;
    xy += w * dx * dy;
    yy += w * dy * dy;
    total += p.signal_e;
  }
  const double major = mean_of_axes(spread) + half_of_axes(spread);
  return {.x_px = x,
          .y_px = y,
          .flux_e = std::max(total, 1.0),
          .length_px = std::sqrt(12 * std::max(major - sigma_px * sigma_px, 0.1)),
          .angle_rad = axis_angle_rad(spread)};
}

/// Relative error of the PSF outside `clipped` pixels.
double wings_error(std::size_t clipped, double sigma_px) {
  const double radius_in_sigmas = std::sqrt(double(clipped) / pi) / sigma_px;
  return std::clamp(detection_limits::wings_error * radius_in_sigmas * radius_in_sigmas,
                    detection_limits::min_wings_error, detection_limits::max_wings_error);
}

/// Fits the wings alone. The flux is that of the wings times a factor given by the PSF, with an
/// error of 0.01 for each square of the sigma at which they begin (2 ln of peak over clip).
std::optional<Source> from_wings(const Scene& scene, const Trail& start, bool streak,
                                 const std::vector<FitPixel>& clipped, double model_error) {
  auto source = fit_source(scene, start, streak, 0.3 * model_error);
  if (!source) return source;
  source->model_error = model_error;
  double excess = 1.0;
  for (const FitPixel& p : clipped)
    excess = std::max(excess, trail_value(source->trail(), scene.sigma_px, p.x, p.y) /
                                  std::max(double(p.signal_e), 1.0));
  const double flux_error_e = 0.02 * std::log(excess) * source->trail().flux_e;
  source->fit.add_cov(2, 2, flux_error_e * flux_error_e);
  return source;
}

/// Whether the source would clip a pixel that is clipped; wings alone are ambiguous.
bool explains_saturation(const Scene& scene, const Source& source,
                         const std::vector<FitPixel>& clipped) {
  return std::ranges::any_of(clipped, [&](const FitPixel& p) {
    return trail_value(source.trail(), scene.sigma_px, p.x, p.y) > 0.7 * p.signal_e;
  });
}

/// A component with the pixels around it, and the fits that compare what it may be.
class Candidate {
 public:
  Candidate(const Scene& scene, const Component& component)
      : scene_(scene), around_(light_around(scene, component)) {
    std::vector<FitPixel> all = around_.usable;
    all.insert(all.end(), around_.clipped.begin(), around_.clipped.end());
    light_ = moments(all, scene.sigma_px);
    model_error_ = is_saturated() ? wings_error(around_.clipped.size(), scene.sigma_px)
                                  : detection_limits::model_error;
  }

  /// Whether there are enough pixels to compare fits.
  bool has_light() const { return around_.usable.size() >= 8; }
  bool is_saturated() const { return !around_.clipped.empty(); }
  double model_error() const { return model_error_; }
  /// Uniform trail of the same light and spread.
  const Trail& light() const { return light_; }

  TrailFit fit(const Psf& psf, Trail start, unsigned free, int max_steps,
               std::optional<double> good_enough_sigmas = std::nullopt) const {
    FitSettings fit_settings = comparison(psf, max_steps);
    fit_settings.good_enough_sigmas = good_enough_sigmas;
    return fit_trails(around_.usable, {std::move(start)}, {free}, fit_settings);
  }
  TrailFit as_point() const {
    Trail point = light_;  // not from a fitted star trail, which may lie anywhere along it
    point.length_px = 0.0;
    return fit(psf(), point, trail_place, 8);
  }
  TrailFit as_line() const { return fit(psf(), light_, trail_line, 15); }
  /// Two points, where they explain the light better than one, than an even line, and to its noise.
  std::optional<TwoPoints> as_two_points(const TrailFit& as_point, const TrailFit& as_line) const {
    if (is_saturated() || as_line.deviance > as_point.deviance - detection_limits::line_margin)
      return std::nullopt;  // it is round
    FitSettings fit_settings = comparison(psf(), 20);
    fit_settings.model_error = pair_model_error;
    TwoPoints two = fit_as_two_points(around_.usable, light_, fit_settings);
    const auto deviance_as = [&](const TrailFit& one, unsigned free) {
      return fit_trails(around_.usable, one.trails, {free}, fit_settings).deviance;
    };
    const double best =
        std::min(deviance_as(as_point, trail_place), deviance_as(as_line, trail_line));
    if (!two.fit.good(5.0) || two.fit.deviance > best - detection_limits::blend_margin)
      return std::nullopt;
    return two;
  }
  double deviance_as_two_stars(const Trail& star, double model_error) const {
    FitSettings fit_settings = comparison(psf(), 15);
    fit_settings.model_error = model_error;
    return deviance_of_stars(around_.usable, light_, star, 2, fit_settings);
  }

  /// Without the pixels beside a source's core to which others add light, and with the error of a
  /// PSF that differs as much; empty if few are left.
  std::optional<Candidate> without_others(Trail of) const {
    constexpr double psf_error = 0.15, min_kept = 0.6, reach_sigmas = 3.0, core_sigmas = 1.5;
    constexpr int rounds = 3;
    if (is_saturated()) return std::nullopt;
    Candidate alone = *this;
    alone.model_error_ = psf_error;
    for (int round = 0; round < rounds; ++round) {
      const Around around(of, reach_sigmas * scene_.sigma_px + 0.5);
      auto near = around_.usable;
      std::erase_if(near, [&](const FitPixel& p) { return !around.has(p.x, p.y); });
      alone.around_.usable = without_outliers(near, {&of, 1}, 0.0, 2 * psf_error, psf());
      const Around core(of, core_sigmas * scene_.sigma_px);
      const auto in_core = [&](const FitPixel& p) { return core.has(p.x, p.y); };
      if (!alone.has_light() ||
          double(alone.around_.usable.size()) < min_kept * double(near.size()) ||
          std::ranges::count_if(alone.around_.usable, in_core) <
              std::ranges::count_if(near, in_core))
        return std::nullopt;
      of = alone.fit(psf(), of, of.length_px > 0 ? trail_line : trail_place, 8).trails[0];
    }
    alone.light_ = moments(alone.around_.usable, scene_.sigma_px);
    return alone;
  }

  /// The final fit; empty if it fails or does not explain what is saturated.
  std::optional<Source> source(const Trail& start, bool streak) const {
    auto source = is_saturated() ? from_wings(scene_, start, streak, around_.clipped, model_error_)
                                 : fit_source(scene_, start, streak, 0.0);
    if (!source || (is_saturated() && !explains_saturation(scene_, *source, around_.clipped)))
      return std::nullopt;
    return source;
  }
  /// The source, empty also if it is too faint.
  std::optional<Source> bright_source(const Trail& start, bool streak) const {
    auto bright = source(start, streak);
    if (bright && bright->snr() < detection_limits::min_snr) bright.reset();
    return bright;
  }

  /// Two points that blend, empty also if one is too faint.
  std::vector<Source> pair(const TwoPoints& two) const { return points_beside(scene_, two.points); }
  /// Two points that blend, neither of which may be a star.
  std::vector<Source> pair_without_stars(const TwoPoints& two) const {
    auto found = pair(two);
    const bool may_be_stars = std::ranges::any_of(found, [&](const Source& source) {
      const Trail& t = source.trail();
      return !scene_.would_be_known(t.x_px, t.y_px, t.flux_e) || may_be_star(t);
    });
    if (may_be_stars) found.clear();
    return found;
  }

  /// The source, empty also if it does not stand out from the noise by `min_snr`.
  std::optional<Source> significant_source(const Trail& start, double min_snr) const {
    auto significant = source(start, start.length_px > 0.0);
    if (!significant) return significant;
    const Trail& t = significant->trail();
    min_snr *= crowding(*scene_.flat, t);
    if (may_be_star(t) || (!is_saturated() && (template_snr(scene_, t) < min_snr ||
                                               significant->snr() < fit_keeps * min_snr)))
      significant.reset();
    return significant;
  }

  bool may_be_line(const TrailFit& as_line) const {
    return plausible(scene_, as_line.trails[0]) && as_line.trails[0].length_px >= 1.0;
  }
  bool is_line(const TrailFit& as_line) const { return as_line.good(4.0) && may_be_line(as_line); }

  Psf psf() const { return scene_.psf.at({light_.x_px, light_.y_px}); }
  Psf nearest_gaussian() const { return scene_.psf.sigma_at({light_.x_px, light_.y_px}); }

 private:
  /// Whether it may be a known star that is brighter than expected, by scintillation or by nature.
  bool may_be_star(const Trail& t) const {
    const double within_px = 1.2 * scene_.sigma_px + 0.5 * t.length_px;
    return t.length_px < 6 * scene_.sigma_px &&
           scene_.known->may_be_at({t.x_px, t.y_px}, within_px, t.flux_e);
  }
  FitSettings comparison(const Psf& psf, int max_steps) const {
    return {.psf = psf,
            .model_error = model_error_,
            .max_steps = max_steps,
            .settled_chi2 = comparison_settled_chi2};
  }

  const Scene& scene_;
  Light around_;
  Trail light_;
  double model_error_ = 0.0;
};

std::vector<Source> listed(std::optional<Source> source) {
  std::vector<Source> out;
  if (source) out.push_back(std::move(*source));
  return out;
}

/// The judgement where every star is known: one point or two or a line, whatever the shape of
/// stars.
std::vector<Source> judge_without_stars(const Candidate& candidate) {
  const TrailFit as_point = candidate.as_point(), as_line = candidate.as_line();
  if (const auto two = candidate.as_two_points(as_point, as_line))
    if (auto pair = candidate.pair_without_stars(*two); !pair.empty()) return pair;
  if (as_point.good(5.0) && as_point.deviance < as_line.deviance + detection_limits::line_margin)
    return listed(candidate.significant_source(as_point.trails[0], detection_limits::min_snr));
  if (!candidate.is_line(as_line)) return {};
  const Trail& line = as_line.trails[0];
  return listed(candidate.significant_source(line, min_streak_snr(line.length_px)));
}

bool are_long(const Trail& stars, const Scene& scene) {
  return stars.length_px >= detection_limits::long_trail_sigmas * scene.sigma_px;
}

/// Two points that blend, where stars trail and are neither of them.
std::vector<Source> pair_among_trails(const Scene& scene, const Candidate& candidate,
                                      const TrailFit& as_point, const TrailFit& as_line,
                                      const Trail& star) {
  if (!are_long(star, scene)) return {};
  const auto two = candidate.as_two_points(as_point, as_line);
  if (!two || two->fit.deviance > candidate.deviance_as_two_stars(star, pair_model_error) -
                                      detection_limits::blend_margin)
    return {};
  auto pair = candidate.pair(*two);
  for (const Source& source : pair)
    if (source.at_edge || is_of_overlapping_trails(scene, source)) return {};
  return pair;
}

/// Sources that are no stars; if there are none, what explains the light better than a star, though
/// not to its noise.
struct AmongStars {
  std::vector<Source> sources;
  std::optional<Trail> unexplained;
};

/// The judgement by the shape of stars.
AmongStars judge_among_stars(const Scene& scene, const Candidate& candidate) {
  const Trail& light = candidate.light();
  Trail star = scene.star_trail(light.x_px, light.y_px);
  star.flux_e = light.flux_e;
  constexpr double surely_star_sigmas = 0.5;
  TrailFit as_star =
      candidate.fit(candidate.nearest_gaussian(), star, trail_place, 8, surely_star_sigmas);
  if (as_star.good(surely_star_sigmas)) return {};
  if (!scene.psf.is_round_gaussian()) {  // most stars are known by the nearest Gaussian
    as_star = candidate.fit(candidate.psf(), as_star.trails[0], trail_place, 8, surely_star_sigmas);
    if (as_star.good(surely_star_sigmas)) return {};
  }
  const bool stars_trail = star.length_px >= detection_limits::min_difference_px;
  TrailFit as_point;
  if (stars_trail) as_point = candidate.as_point();
  const bool may_be_point =
      stars_trail && as_point.deviance < as_star.deviance - detection_limits::blend_margin;
  if (as_star.good(3.5) && !may_be_point) return {};

  const TrailFit as_line = candidate.as_line();
  if (stars_trail)
    if (auto pair = pair_among_trails(scene, candidate, as_point, as_line, star); !pair.empty())
      return {.sources = std::move(pair)};
  if (may_be_point && as_point.good(5.0) &&
      as_point.deviance < as_line.deviance + detection_limits::blend_margin) {
    auto source = candidate.bright_source(as_point.trails[0], false);
    // A star cut by the frame's edge looks like a point.
    if (source && !source->at_edge && point_beats_star(scene, *source) &&
        !is_of_overlapping_trails(scene, *source))
      return {.sources = listed(std::move(source))};
    return {};
  }
  // With the error of a PSF a point is no different from a short trail.
  if (may_be_point && are_long(star, scene) &&
      as_point.deviance < as_line.deviance + detection_limits::blend_margin)
    return {.unexplained = as_point.trails[0]};
  if (!candidate.may_be_line(as_line) ||
      as_line.deviance > as_star.deviance - 2 * detection_limits::blend_margin ||
      as_line.deviance > candidate.deviance_as_two_stars(star, candidate.model_error()) -
                             detection_limits::blend_margin)
    return {};
  if (!candidate.is_line(as_line)) return {.unexplained = as_line.trails[0]};
  auto source = candidate.bright_source(as_line.trails[0], true);
  // A star cut by the frame's edge looks like a short line, too.
  if (!source || (source->at_edge && source->trail().length_px < star.length_px)) return {};
  const double sigma_length_px = std::sqrt(source->fit.cov(3, 3));
  double tolerance_px = std::max(detection_limits::min_difference_px, 4 * sigma_length_px);
  if (candidate.is_saturated()) tolerance_px += 2 * scene.sigma_px;  // wings show ends less sharply
  if (moves_like_star(scene, *source, star, tolerance_px) || is_wide_body(scene, *source) ||
      !beats_stars(scene, *source) || is_of_overlapping_trails(scene, *source))
    return {};
  return {.sources = listed(std::move(source))};
}

}  // namespace

CompactJudgement judge_compact(const Scene& scene, const Component& component) {
  const Candidate candidate(scene, component);
  if (!candidate.has_light()) return {.star_like = true};
  const Trail& light = candidate.light();
  if (scene.would_be_known(light.x_px, light.y_px, light.flux_e))
    return {.sources = judge_without_stars(candidate)};
  AmongStars found = judge_among_stars(scene, candidate);
  if (found.unexplained)
    if (const auto alone = candidate.without_others(*found.unexplained))
      found = judge_among_stars(scene, *alone);
  const bool star_like = found.sources.empty();
  return {std::move(found.sources), star_like};
}

}  // namespace dmise
