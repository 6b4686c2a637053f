#include "core/detection/trailed_stars.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <span>

#include "core/base/units.h"
#include "core/detection/detection_limits.h"
#include "core/detection/source_fit.h"
#include "core/detection/starlight.h"

namespace dmise {
namespace {

constexpr double least_trail_sigmas = 5.0;  // length from which on trails are told from points
constexpr double point_like_sigmas = 16.0;  // length up to which a bright point may look like one
constexpr double fit_error = 0.05;          // of the PSF
constexpr double brightness_error = 0.12;   // of a trail's brightness along it
constexpr double too_dark_sigmas = 3.5;     // by which a part of a trail may be too dark
constexpr double first_snr = 8.0, last_snr = 5.0;
constexpr double most_outside = 0.35;  // of the frame's edge, of a trail whose middle is beyond

// Bound of a search, so that it takes no longer than the frame's detection without it: pixels read,
// for each pixel of the frame. A pixel costs more in a step of a fit.
constexpr double max_reads_per_px = 250.0, reads_per_fitted_px = 60.0;

/// A place where the light along a trail is greatest.
struct TrailPlace {
  double score, x, y;
  bool again = false;

  bool operator<(const TrailPlace& other) const { return score < other.score; }
};

/// The nearest pixel of a coordinate above -65536, faster than std::lround.
int nearest(double px) { return int(px + 65536.5) - 65536; }

/// Length of the longest trail of stars, and how far their middles may be beside the frame.
struct TrailReach {
  double longest_px = 0.0, out_x_px = 0.0, out_y_px = 0.0;
};

TrailReach reach_of_trails(const Scene& scene) {
  TrailReach out;
  for (const double x : {0.0, 0.5, 1.0})
    for (const double y : {0.0, 0.5, 1.0}) {
      const PixelPosition t =
          scene.stars.trail_at({x * (scene.counts.columns - 1), y * (scene.counts.rows - 1)});
      out.longest_px = std::max(out.longest_px, std::hypot(t.x_px, t.y_px));
      out.out_x_px = std::max(out.out_x_px, most_outside * std::abs(t.x_px));
      out.out_y_px = std::max(out.out_y_px, most_outside * std::abs(t.y_px));
    }
  return out;
}

/// Variances of sums of 0, 1, .. pixels of a filtered frame along a line, in that of one pixel.
std::vector<double> variances_of_sums(int most, double sigma_px) {
  const FilteredFrame frame(1, 1, sigma_px);
  std::vector<double> out = {1.0};
  for (int n = 1; n <= most; ++n) out.push_back(n * frame.sum_variance(1.0, n));
  return out;
}

/// Searches a frame for trails.
class TrailSearch {
 public:
  explicit TrailSearch(const Scene& scene)
      : scene_(scene),
        light_(scene),
        reach_(reach_of_trails(scene)),
        variance_(variances_of_sums(int(2 * reach_.longest_px) + 64, scene.sigma_px)),
        reads_left_(max_reads_per_px * double(scene.counts.pixels.size())) {}

  /// Whether the search has used up its bound.
  bool is_spent() const { return reads_left_ < 0; }

  void find(double least_snr) {
    std::priority_queue<TrailPlace> queue;
    reads_left_ -= reads_of_scan();
    if (is_spent()) return;
    scan(least_snr, queue);
    while (!queue.empty() && !is_spent()) {
      TrailPlace candidate = queue.top();
      queue.pop();
      const double before = candidate.score;
      climb(candidate);
      if (candidate.score < least_snr) continue;
      if (candidate.score < 0.8 * before) {
        queue.push(candidate);
        continue;
      }
      try_at(candidate, queue);
    }
  }

  /// Fits all again, each without the light of the others. `last`: nothing is found afterwards.
  void polish(bool last) {
    const auto add = last ? &Starlight::add_electrons : &Starlight::add;
    std::vector<TrailedStar> kept;
    for (TrailedStar& star : stars_) {
      if (is_spent()) return;
      (light_.*add)(star.trail, -1.0);
      const auto again = fitted(star.trail, scene_.psf.at({star.trail.x_px, star.trail.y_px}));
      if (again) star = star_of(*again);
      if (star.trail.flux_e < 3 * star.flux_sigma_e) continue;
      (light_.*add)(star.trail, 1.0);
      kept.push_back(star);
    }
    stars_ = std::move(kept);
  }

  std::vector<TrailedStar> take() { return std::move(stars_); }

 private:
  static constexpr int step_px = 2;      // of the scan
  static constexpr int same_trail = 16;  // steps in which trails hardly differ

  /// SNR of the light along a trail without its brightest quarter, which may be of something else.
  double score_at(double x, double y) const { return score_at(x, y, scene_.star_trail(x, y)); }

  double score_at(double x, double y, const Trail& t) const {
    const int samples = std::max(8, int(std::lround(t.length_px)));
    const double ux = std::cos(t.angle_rad), uy = std::sin(t.angle_rad);
    std::array<double, 4> sum{};
    std::array<int, 4> count{};
    for (int i = 0; i < samples; ++i) {
      const double along = ((i + 0.5) / samples - 0.5) * t.length_px;
      const int px = nearest(x + along * ux), py = nearest(y + along * uy);
      if (!scene_.contains(px, py)) continue;
      const auto quarter = std::size_t(4 * i / samples);
      sum[quarter] += double(light_.snr(px, py));
      ++count[quarter];
    }
    return score_of(sum, count, samples);
  }

  double score_of(const std::array<double, 4>& sum, const std::array<int, 4>& count,
                  int samples) const {
    double total = 0.0, most = 0.0;
    int all = 0, seen = 0, brightest = 0;
    for (std::size_t q = 0; q < 4; ++q) {
      total += sum[q];
      all += count[q];
      if (8 * count[q] < samples) continue;
      ++seen;
      const double mean = sum[q] / count[q];
      if (mean > most) most = mean, brightest = int(q);
    }
    if (10 * all < 4 * samples) return 0.0;
    if (seen >= 3) {
      total -= sum[std::size_t(brightest)];
      const int kept = all - count[std::size_t(brightest)];
      total *= std::sqrt(double(all) / kept);
      all = kept;
    }
    return total / std::sqrt(variance_[std::size_t(all)]);
  }

  /// Scores of places that follow each other by the scan's step and have the same trail.
  void score_row(double x, double y, const Trail& t, std::span<float> scores) const {
    const int samples = std::max(8, int(std::lround(t.length_px)));
    const double ux = std::cos(t.angle_rad), uy = std::sin(t.angle_rad);
    const double reach_px = t.length_px / 2 + 1;
    const double last_x = x + double(scores.size()) * step_px;
    if (std::min({x, y, scene_.counts.columns - 1 - last_x, scene_.counts.rows - 1 - y}) <=
        reach_px) {
      for (std::size_t k = 0; k < scores.size(); ++k)
        scores[k] = float(score_at(x + double(k) * step_px, y, t));
      return;
    }
    std::array<std::array<float, same_trail>, 4> sums{};
    std::array<int, 4> count{};
    for (int i = 0; i < samples; ++i) {
      const double along = ((i + 0.5) / samples - 0.5) * t.length_px;
      const float* snr = light_.snr_from(nearest(x + along * ux), nearest(y + along * uy));
      const auto quarter = std::size_t(4 * i / samples);
      for (std::size_t k = 0; k < scores.size(); ++k)
        sums[quarter][k] += snr[k * std::size_t(step_px)];
      ++count[quarter];
    }
    for (std::size_t k = 0; k < scores.size(); ++k) {
      const std::array<double, 4> sum{sums[0][k], sums[1][k], sums[2][k], sums[3][k]};
      scores[k] = float(score_of(sum, count, samples));
    }
  }

  double reads_of_scan() const {
    const double px = (scene_.counts.columns + 2 * reach_.out_x_px) *
                      (scene_.counts.rows + 2 * reach_.out_y_px) / (step_px * step_px);
    return px * std::max(8.0, reach_.longest_px);
  }

  void scan(double least_snr, std::priority_queue<TrailPlace>& queue) const {
    const double out_x = reach_.out_x_px, out_y = reach_.out_y_px;
    const int wide = int((scene_.counts.columns + 2 * out_x) / step_px) + 1,
              high = int((scene_.counts.rows + 2 * out_y) / step_px) + 1;
    std::vector<float> scores(std::size_t(wide) * std::size_t(high));
    const auto at = [&](int i, int j) { return scores[std::size_t(j * wide + i)]; };
    for (int j = 0; j < high; ++j)
      for (int i = 0; i < wide; i += same_trail) {
        const double x = i * step_px - out_x, y = j * step_px - out_y;
        const Trail t = scene_.star_trail(x + same_trail / 2 * step_px, y);
        const std::size_t many = std::size_t(std::min(same_trail, wide - i));
        score_row(x, y, t, {&scores[std::size_t(j * wide + i)], many});
      }
    for (int j = 0; j < high; ++j)
      for (int i = 0; i < wide; ++i) {
        const float here = at(i, j);
        if (here < 0.8F * float(least_snr)) continue;
        bool highest = true;
        for (int y = std::max(j - 1, 0); y <= std::min(j + 1, high - 1); ++y)
          for (int x = std::max(i - 1, 0); x <= std::min(i + 1, wide - 1); ++x)
            highest &= at(x, y) <= here;
        if (highest) queue.push({double(here), i * step_px - out_x, j * step_px - out_y});
      }
  }

  /// Moves to the best place around, by steps along and across the trail.
  void climb(TrailPlace& candidate) {
    constexpr int most_steps = 40;
    candidate.score = score_at(candidate.x, candidate.y);
    const double angle = scene_.star_trail(candidate.x, candidate.y).angle_rad;
    const double c = std::cos(angle), s = std::sin(angle);
    constexpr std::array<std::array<double, 2>, 6> moves = {
        {{1, 0}, {-1, 0}, {0, 0.7}, {0, -0.7}, {3, 0}, {-3, 0}}};
    for (int step = 0; step < most_steps; ++step) {
      reads_left_ -= double(moves.size()) * std::max(8.0, reach_.longest_px);
      TrailPlace best = candidate;
      for (const auto& [along, across] : moves) {
        const double x = candidate.x + along * c - across * s;
        const double y = candidate.y + along * s + across * c;
        const double score = score_at(x, y);
        if (score > best.score) best.score = score, best.x = x, best.y = y;
      }
      if (!(best.score > candidate.score)) return;
      candidate = best;
    }
  }

  void try_at(TrailPlace candidate, std::priority_queue<TrailPlace>& queue) {
    Trail start = scene_.star_trail(candidate.x, candidate.y);
    const double noise_e = scene_.noise_e_at(start.x_px, start.y_px);
    start.flux_e =
        candidate.score * noise_e *
        std::sqrt(2 * std::sqrt(pi) * light_.filter_px() * std::max(start.length_px, 1.0));
    const auto fit = fitted(start, light_.gaussian_at(start));
    if (!fit) return;
    const TrailedStar star = star_of(*fit);
    if (star.trail.flux_e < last_snr * star.flux_sigma_e || !is_even(star)) return;
    const int going_on = goes_on(star);
    if (going_on > 0 && !candidate.again) {
      candidate.again = true;  // after what lies behind it
      candidate.score *= 0.5;
      if (candidate.score > last_snr) queue.push(candidate);
      return;
    }
    if (going_on > 1 || (is_short(star.trail) && is_other_shape(star))) return;
    light_.add(star.trail, 1.0);
    stars_.push_back(star);
  }

  static TrailedStar star_of(const TrailFit& fit) {
    const double scale = std::max(1.0, fit.reduced_chi2());
    return {fit.trails[0],
            {scale * fit.cov(0, 0), scale * fit.cov(0, 1), scale * fit.cov(1, 1)},
            std::sqrt(scale * fit.cov(2, 2))};
  }

  FitSettings settings(const Psf& psf, const std::vector<FitPixel>& pixels) const {
    return {.psf = psf,
            .model_error = fit_error,
            .background_sigma_e = background_sigma_e(pixels.front()),
            .most_steps = 15,
            .settled_chi2 = 0.01};
  }

  /// The fit of a star's trail without what stands out of it; empty if there is no such star.
  std::optional<TrailFit> fitted(const Trail& start, const Psf& psf) {
    constexpr int rounds = 3;
    constexpr std::size_t least_pixels = 12;
    const double margin_px = 2.5 * light_.filter_px() + 0.5;
    const auto all = light_.pixels_less_stars(start, margin_px);
    if (all.size() < least_pixels) return std::nullopt;
    auto pixels = all;
    std::optional<TrailFit> fit;
    Trail trail = start;
    for (int round = 0; round < rounds; ++round) {
      reads_left_ -= reads_per_fitted_px * double(pixels.size());
      fit = fit_trails(pixels, {trail}, {trail_place}, settings(psf, pixels));
      const Trail& t = fit->trails[0];
      if (!(t.flux_e > 0) || !(fit->cov(2, 2) > 0) || !is_bounded(scene_, t) ||
          std::hypot(t.x_px - start.x_px, t.y_px - start.y_px) >
              3 * light_.filter_px() + 0.2 * start.length_px)
        return std::nullopt;
      trail = t;
      if (round + 1 == rounds) break;
      pixels = without_outliers(all, {&trail, 1}, fit->background_e, 0.15, psf);
      if (pixels.size() < least_pixels || pixels.size() < all.size() / 3) return std::nullopt;
    }
    const Trail here = scene_.star_trail(trail.x_px, trail.y_px);
    fit->trails[0].length_px = here.length_px;
    fit->trails[0].angle_rad = here.angle_rad;
    return fit;
  }

  /// Mean of the filtered frame over a part of a trail's line, and how many pixels it is of.
  struct PartMean {
    double mean = 0.0;
    int samples = 0;
  };
  PartMean mean_between(const Trail& t, double from_px, double to_px) const {
    PartMean out;
    for (double along = from_px + 0.5; along < to_px; along += 1.0) {
      const auto [x, y] = t.at(along);
      const int px = int(std::lround(x)), py = int(std::lround(y));
      if (!scene_.contains(px, py) || !scene_.has_value(px, py)) continue;
      out.mean += double(light_.snr(px, py));
      ++out.samples;
    }
    if (out.samples) out.mean /= out.samples;
    return out;
  }

  /// What a trail's line has in the filtered frame, far from its ends.
  double level_of(const Trail& t) const {
    const double sigma_px = std::hypot(light_.sigma_at(t), light_.filter_px());
    Trail middle = t;
    middle.x_px = middle.y_px = 0.0;
    return trail_value(middle, sigma_px, 0.0, 0.0) /
           (scene_.noise_e_at(t.x_px, t.y_px) * light_.unit());
  }

  double noise_of(int samples) const {
    return std::sqrt(variance_[std::size_t(samples)]) / samples;
  }

  /// Whether no part of a trail is much darker than the whole.
  bool is_even(const TrailedStar& star) const {
    const Trail& t = star.trail;
    const double sigma_px = std::hypot(light_.sigma_at(t), light_.filter_px());
    const double inside_px = t.length_px - sigma_px;  // half of the light is at an end
    const int parts = std::clamp(int(inside_px / (3 * sigma_px)), 2, 12);
    const double level = level_of(t);
    int dark = 0, seen = 0;
    for (int k = 0; k < parts; ++k) {
      const PartMean part = mean_between(t, (double(k) / parts - 0.5) * inside_px,
                                         (double(k + 1) / parts - 0.5) * inside_px);
      if (part.samples < 2) continue;
      ++seen;
      const double error = std::hypot(noise_of(part.samples), brightness_error * level);
      dark += part.mean < 0.9 * level - too_dark_sigmas * error || part.mean < 0.25 * level;
    }
    return seen >= 2 && dark <= seen / 6;
  }

  /// At how many of its ends a trail's light goes on.
  int goes_on(const TrailedStar& star) const {
    const Trail& t = star.trail;
    const double sigma_px = std::hypot(light_.sigma_at(t), light_.filter_px());
    const double gap_px = t.length_px / 2 + 2.5 * sigma_px;
    const double part_px = std::max(2 * sigma_px, t.length_px / 6);
    const double level = level_of(t);
    int ends = 0;
    for (const double side : {-1.0, 1.0}) {
      const double from = side > 0 ? gap_px : -gap_px - part_px;
      const PartMean part = mean_between(t, from, from + part_px);
      if (part.samples < 2) continue;
      ends += part.mean > 0.6 * level && part.mean > 3.5 * noise_of(part.samples);
    }
    return ends;
  }

  bool is_short(const Trail& t) const {
    return t.length_px < point_like_sigmas * light_.filter_px();
  }

  /// Whether the light of a short trail is rather a point's, or that of a line of another length or
  /// direction.
  bool is_other_shape(const TrailedStar& star) const {
    const Trail& t = star.trail;
    const Psf psf = scene_.psf.at({t.x_px, t.y_px});
    const auto all = light_.pixels_less_stars(t, 3 * light_.filter_px() + 0.5);
    // Another source before the trail does not make it another shape.
    const auto pixels = without_outliers(all, {&t, 1}, 0.0, 0.15, psf);
    if (pixels.size() < 12 || 10 * pixels.size() < 6 * all.size()) return true;
    const auto with = [&](const Trail& start, unsigned free) {
      return fit_trails(pixels, {start}, {free}, settings(psf, pixels));
    };
    const double as_star = with(t, trail_place).deviance;
    const TrailFit line = with(t, trail_line);
    const Trail& l = line.trails[0];
    const double apart_px =
        std::hypot(l.length_px * std::cos(l.angle_rad) - t.length_px * std::cos(t.angle_rad),
                   l.length_px * std::sin(l.angle_rad) - t.length_px * std::sin(t.angle_rad));
    if (line.cov(3, 3) > 0 && line.deviance < as_star - 25.0 && apart_px > 0.3 * t.length_px)
      return true;
    Trail point = t;
    point.length_px = 0.0;
    for (const double along : {-0.3, 0.0, 0.3}) {
      const auto [x, y] = t.at(along * t.length_px);
      point.x_px = x, point.y_px = y;
      if (with(point, trail_place).deviance < as_star) return true;
    }
    return false;
  }

  const Scene& scene_;
  Starlight light_;
  TrailReach reach_;
  std::vector<double> variance_;  // of sums of so many pixels along a trail
  double reads_left_;
  std::vector<TrailedStar> stars_;
};

}  // namespace

bool stars_trail(const Scene& scene) {
  const Trail middle =
      scene.star_trail((scene.counts.columns - 1) / 2.0, (scene.counts.rows - 1) / 2.0);
  return middle.length_px > least_trail_sigmas * scene.sigma_px;
}

std::vector<TrailedStar> find_trailed_stars(const Scene& scene) {
  TrailSearch search(scene);
  search.find(first_snr);
  search.polish(false);
  search.find(last_snr);
  search.polish(true);
  search.polish(true);
  if (search.is_spent()) return {};
  return search.take();
}

StarlessFrame without_stars(const Scene& scene, const std::vector<TrailedStar>& stars) {
  constexpr double noisier = 0.5;  // share of a pixel's variance
  Starlight light(scene);
  for (const TrailedStar& star : stars) light.add_electrons(star.trail, 1.0);
  StarlessFrame out{scene.counts, BitMask(scene.counts.columns, scene.counts.rows)};
  for (int y = 0; y < scene.counts.rows; ++y)
    for (int x = 0; x < scene.counts.columns; ++x) {
      const double e = light.electrons(x, y);
      if (e == 0.0) continue;
      const double noise_e = scene.noise_e_at(x, y), error_e = fit_error * e;
      const bool usable = scene.is_usable(x, y);
      if (!usable || e + error_e * error_e > noisier * noise_e * noise_e) out.lit.set(x, y);
      if (!usable) continue;
      const double dn = scene.counts.at(x, y) - e / scene.gain_e_per_dn;
      out.counts.at(x, y) = std::uint16_t(std::clamp(std::round(dn), 0.0, 65535.0));
    }
  return out;
}

}  // namespace dmise
