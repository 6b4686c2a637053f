#include "core/detection/source/star_hypothesis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/source_fit.h"

namespace dmise {
namespace {

constexpr int max_stars = 4;  // in a row, that may imitate a streak
// Stars up to 2.5 FWHM apart are one light: its length for each, with their own widths.
constexpr double one_light_sigmas = 5.5;

/// `count` stars in a row along the line, which share its flux.
std::vector<Trail> stars_along(const Trail& line, const Trail& star, int count) {
  std::vector<Trail> out;
  for (int i = 0; i < count; ++i) {
    const double along = ((2 * i + 1.0) / count - 1) / 2 * line.length_px;
    Trail t = star;
    t.x_px = line.x_px + along * std::cos(line.angle_rad);
    t.y_px = line.y_px + along * std::sin(line.angle_rad);
    t.flux_e = line.flux_e / count;
    out.push_back(t);
  }
  return out;
}

/// Length of the smallest difference between two trails, up to their sign.
double difference_px(const Trail& a, const Trail& b) {
  const double ax = a.length_px * std::cos(a.angle_rad), ay = a.length_px * std::sin(a.angle_rad);
  const double bx = b.length_px * std::cos(b.angle_rad), by = b.length_px * std::sin(b.angle_rad);
  return std::min(std::hypot(ax - bx, ay - by), std::hypot(ax + bx, ay + by));
}

/// Length of the trail perpendicular to another.
double across_px(const Trail& trail, const Trail& other) {
  return trail.length_px * std::abs(std::sin(trail.angle_rad - other.angle_rad));
}

/// Fits that are compared with that of a source.
FitSettings comparison_of(const Scene& scene, const Source& source) {
  const Trail& t = source.trail();
  return {.psf = scene.psf.at({t.x_px, t.y_px}),
          .model_error = std::max(source.model_error, detection_limits::model_error),
          .max_steps = 15,
          .settled_chi2 = comparison_settled_chi2};
}

/// Whether the line may be a noisy piece of one star's trail.
bool is_piece_of_star(const Scene& scene, const Trail& line, const Trail& star, double margin_px,
                      const FitSettings& fit_settings) {
  const double spare_px = star.length_px - line.length_px;
  if (spare_px <= 0 || across_px(line, star) > detection_limits::min_difference_px) return false;
  for (const double side : {-0.5, 0.0, 0.5}) {
    Trail whole = star;
    whole.x_px = line.x_px + side * spare_px * std::cos(star.angle_rad);
    whole.y_px = line.y_px + side * spare_px * std::sin(star.angle_rad);
    whole.flux_e = line.flux_e * star.length_px / line.length_px;
    const auto pixels = pixels_near(scene, whole, margin_px);
    const double as_star = fit_trails(pixels, {whole}, {trail_place}, fit_settings).deviance;
    const double as_line = fit_trails(pixels, {line}, {trail_line}, fit_settings).deviance;
    if (as_star < as_line + detection_limits::blend_margin) return true;
  }
  return false;
}

/// Usable pixels around a star that was subtracted from the frame, with its light.
std::vector<FitPixel> with_star(const Scene& scene, const Trail& star, const Psf& psf) {
  Scene open = scene;
  open.known = nullptr;
  auto pixels = pixels_near(open, star, 2.5 * scene.sigma_px + 0.5);
  const std::vector<double> light = light_in(pixels, {&star, 1}, psf);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i].signal_e += float(light[i]);
  return pixels;
}

/// Whether two trails explain the light of a star as well as its trail and a point.
bool are_two_trails(const Scene& scene, const Trail& star, const Source& point) {
  FitSettings fit_settings = comparison_of(scene, point);
  const auto pixels = with_star(scene, star, fit_settings.psf);
  const auto deviance_with = [&](const Trail& other) {
    return fit_trails(pixels, {star, other}, {trail_place, trail_place}, fit_settings).deviance;
  };
  const double as_point = deviance_with(point.trail());
  return std::ranges::any_of(std::array{-0.5, 0.5}, [&](double side) {
    Trail other = star;
    other.x_px = point.trail().x_px + side * star.length_px * std::cos(star.angle_rad);
    other.y_px = point.trail().y_px + side * star.length_px * std::sin(star.angle_rad);
    other.flux_e = 0.5 * star.flux_e;
    return deviance_with(other) < as_point + detection_limits::trail_margin;
  });
}

/// How many rows of three or more stars along a line such as this one a frame of so many stars has
/// by chance. Two stars may belong together.
double chance_rows(const Scene& scene, const Trail& line, int count) {
  constexpr double counts_slope = 1.1;  // numbers fall with this power of the light
  constexpr double companions = 0.01;   // share of stars that have one so near, by nature
  const double noise_e =
      scene.noise_e_at(line.x_px, line.y_px) * 2 * std::sqrt(pi) * scene.sigma_px;
  const double snr = line.flux_e / count / noise_e;
  const double brighter = std::pow(detection_limits::seed_snr / std::max(snr, 1.0), counts_slope);
  const double per_px2 = scene.sources_per_px2 * brighter;
  const double step_px = line.length_px / count;
  const double second = pi * step_px * step_px, next = 2 * scene.sigma_px * step_px;
  const auto chance = [&](double area_px2) {
    return std::clamp(per_px2 * area_px2, companions, 1.0);
  };
  return per_px2 * double(scene.counts.pixels.size()) * chance(second) *
         std::pow(chance(next), count - 2);
}

/// Deviance by which chance disfavours a row of stars along a line: twice the negative logarithm of
/// the number of such rows.
double rarity_of_row(const Scene& scene, const Trail& line, int count) {
  constexpr double max_rarity = 40.0;  // what is beside all chance has other reasons
  if (count < 3 || !(scene.sources_per_px2 > 0)) return 0.0;
  return std::clamp(-2 * std::log(chance_rows(scene, line, count)), 0.0, max_rarity);
}

/// A point where a fit leaves the brightest pixel.
Trail brightest_beside(const std::vector<FitPixel>& pixels, const TrailFit& fit, const Psf& psf) {
  const std::vector<double> light = light_in(pixels, fit.trails, psf);
  double most = -HUGE_VAL;
  Trail out;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double left = pixels[i].signal_e - light[i];
    if (left <= most) continue;
    most = left;
    out = {.x_px = double(pixels[i].x), .y_px = double(pixels[i].y)};
  }
  const double sigma_px = psf.equivalent_sigma_px();
  out.flux_e = std::max(most, 1.0) * 2 * pi * sigma_px * sigma_px;
  return out;
}

}  // namespace

double share_of_trails_on(const Scene& scene, const Trail& line) {
  constexpr double min_trail_sigmas = 5.0, on_line_sigmas = 3.0;
  const Trail star = scene.star_trail(line.x_px, line.y_px);
  if (star.length_px < min_trail_sigmas * scene.sigma_px) return 0.0;
  const double on_line_px = on_line_sigmas * scene.sigma_px;
  const double share = on_line_px / std::max(across_px(star, line), on_line_px);
  return share * share;
}

bool is_beyond_stars(const Scene& scene, const Source& streak) {
  constexpr double min_star_snr = 4.0;
  constexpr double unlikely = 1e-2, excluded = 1e-5;  // rows in a frame
  if (!(scene.sources_per_px2 > 0)) return false;
  const Trail& t = streak.trail();
  const double apart_px =
      one_light_sigmas * scene.sigma_px + scene.star_trail(t.x_px, t.y_px).length_px;
  const int stars = int(std::max(t.length_px / apart_px, 3.0));
  if (streak.snr() < min_star_snr * std::sqrt(stars)) return false;
  const double rows = chance_rows(scene, t, stars);
  return rows < excluded || (rows < unlikely && beats_stars(scene, streak));
}

bool may_be_row_of_stars(const Scene& scene, const Trail& streak, double row_px) {
  constexpr double across_trails = 3.0, along_trails = 10.0;  // lengths of a star's trail
  // As long as four stars that are one light.
  constexpr double max_row_sigmas = 4 * one_light_sigmas;
  const Trail star = scene.star_trail(streak.x_px, streak.y_px);
  const double trails =
      across_trails + (along_trails - across_trails) * share_of_trails_on(scene, streak);
  const double as_one_px = max_row_sigmas * scene.sigma_px;
  return streak.length_px < std::max(row_px, as_one_px) + trails * star.length_px;
}

double deviance_of_stars(const std::vector<FitPixel>& pixels, const Trail& line, const Trail& star,
                         int count, const FitSettings& settings) {
  const std::vector<unsigned> free(std::size_t(count), trail_place);
  return fit_trails(pixels, stars_along(line, star, count), free, settings).deviance;
}

bool moves_like_star(const Scene& scene, const Source& source, const Trail& star,
                     double tolerance_px) {
  const Trail& t = source.trail();
  if (scene.would_be_known(t.x_px, t.y_px, t.flux_e)) return false;
  if (difference_px(t, star) < tolerance_px) return true;
  return source.at_edge && across_px(t, star) < tolerance_px &&
         t.length_px < star.length_px + tolerance_px;
}

bool point_beats_star(const Scene& scene, const Source& source) {
  const Trail& point = source.trail();
  Trail star = scene.star_trail(point.x_px, point.y_px);
  star.flux_e = point.flux_e;
  const auto pixels = pixels_near(scene, star, 2.5 * scene.sigma_px + 0.5);
  const FitSettings fit_settings = comparison_of(scene, source);
  const double as_star = fit_trails(pixels, {star}, {trail_place}, fit_settings).deviance;
  const TrailFit as_point = fit_trails(pixels, {point}, {trail_place}, fit_settings);
  const double limit = as_star - detection_limits::blend_margin;
  if (as_point.deviance < limit) return true;
  if (star.length_px < detection_limits::long_trail_sigmas * scene.sigma_px) return false;
  // Where another point is in the way of that trail, the trail has its light.
  return fit_trails(pixels, {point, brightest_beside(pixels, as_point, fit_settings.psf)},
                    {trail_place, trail_place}, fit_settings)
             .deviance < limit;
}

bool is_of_overlapping_trails(const Scene& scene, const Source& point) {
  constexpr double reach_sigmas = 4.0, beyond_ends_sigmas = 7.0;
  if (!scene.known) return false;
  const Trail& at = point.trail();
  return std::ranges::any_of(scene.known->subtracted(), [&](const Trail& star) {
    Trail longer = star;
    longer.length_px += 2 * (beyond_ends_sigmas - reach_sigmas) * scene.sigma_px;
    return Around(longer, reach_sigmas * scene.sigma_px).has(at.x_px, at.y_px) &&
           are_two_trails(scene, star, point);
  });
}

bool beats_stars(const Scene& scene, const Source& source) {
  const Trail& line = source.trail();
  if (scene.row_would_be_known(line)) return true;
  const Trail star = scene.star_trail(line.x_px, line.y_px);
  const double margin_px = 2.5 * scene.sigma_px + 0.5;
  const auto pixels = pixels_near(scene, line, margin_px);
  const FitSettings fit_settings = comparison_of(scene, source);
  if (is_piece_of_star(scene, line, star, margin_px, fit_settings)) return false;
  const double as_line = fit_trails(pixels, {line}, {trail_line}, fit_settings).deviance;
  // More stars fit better by chance, by about one per additional parameter.
  for (int count = 2; count <= max_stars; ++count) {
    const double freedom = 3.0 * count - 5.0;
    const double as_stars = deviance_of_stars(pixels, line, star, count, fit_settings) + freedom +
                            rarity_of_row(scene, line, count);
    if (as_stars < as_line + detection_limits::chain_margin) return false;
  }
  return true;
}

bool is_wide_body(const Scene& scene, const Source& source) {
  constexpr double wider = 1.7, min_gain = 10.0;  // width over the PSF's; gain in deviance
  const Trail& t = source.trail();
  const auto pixels = pixels_near(scene, t, 3 * wider * scene.sigma_px + 2.5);
  if (pixels.empty()) return false;
  FitSettings settings{.psf = scene.psf.at({t.x_px, t.y_px}),
                       .background_sigma_e = background_sigma_e(pixels.front()),
                       .max_steps = 20};
  const double narrow = fit_trails(pixels, {t}, {source.free}, settings).deviance;
  settings.psf = Psf(wider * scene.sigma_px);
  return narrow - fit_trails(pixels, {t}, {source.free}, settings).deviance > min_gain;
}

}  // namespace dmise
