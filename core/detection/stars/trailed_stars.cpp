#include "core/detection/stars/trailed_stars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>

#include "core/base/units.h"
#include "core/detection/source/source_fit.h"
#include "core/detection/stars/trail_scan.h"

namespace dmise {
namespace {

constexpr double min_trail_sigmas = 5.0;    // length from which on trails are told from points
constexpr double far_trail_sigmas = 20.0;   // from which on no short streak looks like one
constexpr double point_like_sigmas = 16.0;  // length up to which a bright point may look like one
constexpr double brightness_error = 0.12;   // relative scatter of brightness along a trail
constexpr double too_dark_sigmas = 3.5;     // by which a part of a trail may be too dark
constexpr double tolerance = 0.15;          // outliers are off by more of the trail's light
constexpr double first_snr = 8.0, last_snr = 5.0;
constexpr std::size_t min_pixels = 12;  // a fit needs as many

// Bound of a search, so that it takes no longer than the frame's detection without it: pixels read,
// for each pixel of the frame. A pixel costs more in a step of a fit.
constexpr double max_reads_per_px = 500.0, reads_per_fitted_px = 60.0;

TrailedStar star_of(const TrailFit& fit) {
  const double scale = std::max(1.0, fit.reduced_chi2());
  return {fit.trails[0],
          {scale * fit.cov(0, 0), scale * fit.cov(0, 1), scale * fit.cov(1, 1)},
          std::sqrt(scale * fit.cov(2, 2))};
}

FitSettings settings(const Psf& psf, const std::vector<FitPixel>& pixels) {
  return {.psf = psf,
          .model_error = ResidualFrame::light_error,
          .background_sigma_e = background_sigma_e(pixels.front()),
          .max_steps = 15,
          .settled_chi2 = 0.01};
}

double trail_in_middle_px(const Scene& scene) {
  return scene.star_trail((scene.counts.columns - 1) / 2.0, (scene.counts.rows - 1) / 2.0)
      .length_px;
}

PixelPosition from_end_to_end(const Trail& t) {
  return {t.length_px * std::cos(t.angle_rad), t.length_px * std::sin(t.angle_rad)};
}

/// Searches a frame for trails.
class TrailSearch {
 public:
  explicit TrailSearch(const Scene& scene)
      : scene_(scene),
        residual_(scene, point_snr(scene)),
        scan_(scene, residual_),
        reads_left_(max_reads_per_px * double(scene.counts.pixels.size())) {}

  /// Whether the search has used up its bound.
  bool is_spent() const { return reads_left_ < 0; }

  /// Finds stars in what is left of the frame, the brightest first.
  void find(double min_snr) {
    constexpr double much_darker = 0.8;  // than it was before stars were subtracted beside it
    reads_left_ -= scan_.reads_of_peaks();
    if (is_spent()) return;
    Queue queue;
    for (const TrailPlace& place : scan_.peaks(min_snr)) queue.push(place);
    while (!queue.empty() && !is_spent()) {
      TrailPlace place = queue.top();
      queue.pop();
      const double before = place.score;
      reads_left_ -= scan_.climb(place);
      if (place.score < min_snr) continue;
      if (place.score < much_darker * before)
        queue.push(place);
      else
        try_at(place, queue);
    }
  }

  /// Fits all stars again, each without the light of the others.
  void fit_again() {
    std::vector<TrailedStar> kept;
    for (TrailedStar& star : stars_) {
      if (is_spent()) return;
      residual_.restore(star.trail);
      if (const auto fit = fitted(star.trail, scene_.psf.at({star.trail.x_px, star.trail.y_px})))
        star = star_of(*fit);
      if (star.trail.flux_e < 3 * star.flux_sigma_e) continue;
      residual_.subtract(star.trail);
      kept.push_back(star);
    }
    stars_ = std::move(kept);
  }

  /// Ends `find`, which makes `fit_again` quicker.
  void end_finding() { residual_.drop_snr(); }

  std::vector<TrailedStar> take() { return std::move(stars_); }

 private:
  using Queue = std::priority_queue<TrailPlace>;

  /// Subtracts the star of which a place is the middle, if there is one.
  void try_at(TrailPlace place, Queue& queue) {
    Trail start = scene_.star_trail(place.x_px, place.y_px);
    const double noise_e = scene_.noise_e_at(start.x_px, start.y_px);
    start.flux_e = place.score * noise_e *
                   std::sqrt(2 * std::sqrt(pi) * scene_.sigma_px * std::max(start.length_px, 1.0));
    const auto fit = fitted(start, scene_.psf.sigma_at({start.x_px, start.y_px}));
    if (!fit) return;
    const TrailedStar star = star_of(*fit);
    if (star.trail.flux_e < last_snr * star.flux_sigma_e || !is_even(star.trail)) return;
    const int bright_ends = ends_with_light_beyond(star.trail);
    if (bright_ends > 0 && !place.is_second_try) {
      // Another star may lie there, which is found before the second try.
      place.is_second_try = true;
      place.score *= 0.5;
      if (place.score > last_snr) queue.push(place);
      return;
    }
    if (bright_ends > 1 || (is_short(star.trail) && has_other_shape(star.trail))) return;
    residual_.subtract(star.trail);
    stars_.push_back(star);
  }

  /// The fit of a star's trail without what stands out of it; empty if there is no such star.
  std::optional<TrailFit> fitted(const Trail& start, const Psf& psf) {
    constexpr int rounds = 3;
    if (!is_bounded(scene_, start)) return std::nullopt;
    const auto all = residual_.pixels_around(start, 2.5 * scene_.sigma_px + 0.5);
    if (all.size() < min_pixels) return std::nullopt;
    auto pixels = all;
    std::optional<TrailFit> fit;
    Trail trail = start;
    for (int round = 0; round < rounds; ++round) {
      reads_left_ -= reads_per_fitted_px * double(pixels.size());
      fit = fit_trails(pixels, {trail}, {trail_place}, settings(psf, pixels));
      const Trail& t = fit->trails[0];
      if (!(t.flux_e > 0) || !(fit->cov(2, 2) > 0) || !is_bounded(scene_, t) ||
          std::hypot(t.x_px - start.x_px, t.y_px - start.y_px) >
              3 * scene_.sigma_px + 0.2 * start.length_px)
        return std::nullopt;
      trail = t;
      if (round + 1 == rounds) break;
      pixels = without_outliers(all, {&trail, 1}, fit->background_e, tolerance, psf);
      if (pixels.size() < min_pixels || pixels.size() < all.size() / 3) return std::nullopt;
    }
    const Trail here = scene_.star_trail(trail.x_px, trail.y_px);
    fit->trails[0].length_px = here.length_px;
    fit->trails[0].angle_rad = here.angle_rad;
    if (!is_bounded(scene_, fit->trails[0])) return std::nullopt;
    return fit;
  }

  /// Whether no part of a trail is much darker than the whole.
  bool is_even(const Trail& t) const {
    const double sigma_px = scan_.filtered_sigma_px(t);
    const double inside_px = t.length_px - sigma_px;  // half of the light is at an end
    const int parts = int(std::clamp(inside_px / (3 * sigma_px), 2.0, 12.0));
    const double level = scan_.level_of(t);
    int dark = 0, seen = 0;
    for (int k = 0; k < parts; ++k) {
      const auto part = scan_.part_of(t, (double(k) / parts - 0.5) * inside_px,
                                      (double(k + 1) / parts - 0.5) * inside_px);
      if (part.samples < 2) continue;
      ++seen;
      const double error = std::hypot(part.noise, brightness_error * level);
      dark += part.mean < 0.9 * level - too_dark_sigmas * error || part.mean < 0.25 * level;
    }
    return seen >= 2 && dark <= seen / 6;
  }

  /// Beyond how many of its ends a trail's light goes on.
  int ends_with_light_beyond(const Trail& t) const {
    const double sigma_px = scan_.filtered_sigma_px(t);
    const double gap_px = t.length_px / 2 + 2.5 * sigma_px;
    const double part_px = std::max(2 * sigma_px, t.length_px / 6);
    const double level = scan_.level_of(t);
    int ends = 0;
    for (const double side : {-1.0, 1.0}) {
      const double from = side > 0 ? gap_px : -gap_px - part_px;
      const auto part = scan_.part_of(t, from, from + part_px);
      ends += part.samples >= 2 && part.mean > 0.6 * level && part.mean > 3.5 * part.noise;
    }
    return ends;
  }

  bool is_short(const Trail& t) const { return t.length_px < point_like_sigmas * scene_.sigma_px; }

  /// Whether the light of a short trail is rather a point's, or that of a line of another length or
  /// direction.
  bool has_other_shape(const Trail& t) const {
    constexpr double line_margin = 25.0;  // deviance by which another line must fit better
    const Psf psf = scene_.psf.at({t.x_px, t.y_px});
    const auto all = residual_.pixels_around(t, 3 * scene_.sigma_px + 0.5);
    // Another source before the trail does not make it another shape.
    const auto pixels = without_outliers(all, {&t, 1}, 0.0, tolerance, psf);
    if (pixels.size() < min_pixels || 10 * pixels.size() < 6 * all.size()) return true;
    const auto fit = [&](const Trail& start, unsigned free) {
      return fit_trails(pixels, {start}, {free}, settings(psf, pixels));
    };
    const double as_star = fit(t, trail_place).deviance;
    const TrailFit line = fit(t, trail_line);
    const PixelPosition apart = from_end_to_end(line.trails[0]) - from_end_to_end(t);
    if (line.cov(3, 3) > 0 && line.deviance < as_star - line_margin &&
        std::hypot(apart.x_px, apart.y_px) > 0.3 * t.length_px)
      return true;
    Trail point = t;
    point.length_px = 0.0;
    return std::ranges::any_of(std::array{-0.3, 0.0, 0.3}, [&](double along) {
      const auto [x, y] = t.at(along * t.length_px);
      point.x_px = x, point.y_px = y;
      return fit(point, trail_place).deviance < as_star;
    });
  }

  const Scene& scene_;
  ResidualFrame residual_;
  TrailScan scan_;
  double reads_left_;
  std::vector<TrailedStar> stars_;
};

}  // namespace

bool stars_trail(const Scene& scene) {
  return trail_in_middle_px(scene) > min_trail_sigmas * scene.sigma_px;
}

bool stars_trail_far(const Scene& scene) {
  return trail_in_middle_px(scene) > far_trail_sigmas * scene.sigma_px;
}

std::vector<TrailedStar> find_trailed_stars(const Scene& scene) {
  TrailSearch search(scene);
  search.find(first_snr);
  search.fit_again();
  search.find(last_snr);
  search.end_finding();
  search.fit_again();
  search.fit_again();
  if (search.is_spent()) return {};
  return search.take();
}

StarlessFrame without_stars(const Scene& scene, const std::vector<TrailedStar>& stars) {
  constexpr double noisier = 0.5;  // share of a pixel's variance
  ResidualFrame residual(scene);
  for (const TrailedStar& star : stars) residual.subtract(star.trail);
  StarlessFrame out{scene.counts, BitMask(scene.counts.columns, scene.counts.rows)};
  for (int y = 0; y < scene.counts.rows; ++y)
    for (int x = 0; x < scene.counts.columns; ++x) {
      const float e = residual.light_e(x, y);
      if (e == 0.0F) continue;
      const double noise_e = scene.noise_e_at(x, y);
      const bool is_usable = scene.is_usable(x, y);
      if (!is_usable || double(ResidualFrame::variance_e2(e)) > noisier * noise_e * noise_e)
        out.lit.set(x, y);
      if (!is_usable) continue;
      const double dn = scene.counts.at(x, y) - double(e) / scene.gain_e_per_dn;
      out.counts.at(x, y) = std::uint16_t(std::clamp(std::round(dn), 0.0, 65535.0));
    }
  return out;
}

}  // namespace dmise
