#include "core/detection/stars/psf_measure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "core/base/algebra/small_matrix.h"
#include "core/base/numeric/quantile.h"
#include "core/detection/light/psf_shape.h"
#include "core/detection/light/psf_star_fit.h"
#include "core/detection/source/residual_frame.h"
#include "core/detection/source/source_fit.h"
#include "core/detection/stars/psf_ellipse.h"
#include "core/detection/stars/psf_stars.h"

namespace dmise {
namespace {

constexpr std::size_t min_stars = 8, least_for_slopes = 30;
constexpr std::size_t max_candidates = 200, max_stars = 100;
constexpr std::size_t max_core_pixels = 12000, max_shape_pixels = 20000, min_shape_pixels = 30;
constexpr double shape_widths = 10.0;       // reach of the shape, in units of the width
constexpr double trail_shape_widths = 5.0;  // where trails lie beside each other
constexpr double width_floor = 0.01;        // scatter of widths that is no change over the frame
constexpr double trails_from_px = 1.5;      // a shorter trail can't be told from a point
// Rings of an obscured aperture are no Gaussian, by ten times the noise of a bright star.
constexpr double max_reduced_chi2 = 40.0, most_of_median_chi2 = 3.0;
constexpr double outlier_scatters = 4.0;

struct Star {
  const Component* component;  // null: it is known by its trail
  StarWidth fit;
};

double core_reach_px(double width_px) { return 3 * width_px + 1.5; }

/// The star's trail at the middle of a component's light.
Trail trail_of(const Scene& scene, const Component& c) {
  double f = 0.0, x = 0.0, y = 0.0;
  for (const Run& run : c.runs)
    for (int px = run.first_x; px <= run.last_x; ++px) {
      const double w = std::max(scene.pixel(px, run.y).signal_e, 0.0f);
      f += w;
      x += w * px;
      y += w * run.y;
    }
  Trail trail = f > 0 ? scene.star_trail(x / f, y / f) : scene.star_trail(c.peak_x, c.peak_y);
  trail.flux_e = std::max(f, 1.0);
  return trail;
}

bool is_whole(const Scene& scene, const Component& c) {
  for (const Run& run : c.runs)
    for (int x = run.first_x; x <= run.last_x; ++x)
      if (!scene.is_usable(x, run.y)) return false;
  return true;
}

/// Fits of candidates that are stars: as long as a star's trail, not a point.
std::vector<Star> fit_candidates(const Scene& scene, const ComponentMap& map,
                                 const std::vector<const Component*>& candidates, double width_px) {
  std::vector<Star> stars;
  std::size_t used = 0, tried = 0;
  for (const Component* c : candidates) {
    if (stars.size() == max_stars || tried == max_candidates || used > max_core_pixels) break;
    const Trail start = trail_of(scene, *c);
    const double reach_px = core_reach_px(width_px);
    if (!is_whole(scene, *c) || !map.is_alone(start, reach_px, *c)) continue;
    const auto pixels = map.pixels_around(scene, start, reach_px, *c, 1);
    if (pixels.empty()) continue;
    ++tried;
    used += pixels.size();
    const double sigma_e = background_sigma_e(pixels.front());
    const auto fit = fit_star_width(pixels, start, width_px, sigma_e);
    if (!fit || fit->reduced_chi2 > max_reduced_chi2) continue;
    if (start.length_px >= trails_from_px) {
      Trail point = fit->trail;
      point.length_px = 0.0;
      const auto as_point = fit_star_width(pixels, point, std::exp(fit->log_width), sigma_e);
      if (as_point && as_point->chi2 < fit->chi2) continue;
    }
    stars.push_back({c, *fit});
  }
  return stars;
}

double median_log_width(const std::vector<Star>& stars) {
  std::vector<double> values;
  for (const Star& star : stars) values.push_back(star.fit.log_width);
  return median_of(std::move(values));
}

/// Drops blends and others that fit worse than most.
void drop_bad_fits(std::vector<Star>& stars) {
  std::vector<double> values;
  for (const Star& star : stars) values.push_back(star.fit.reduced_chi2);
  if (values.empty()) return;
  const double limit = most_of_median_chi2 * median_of(std::move(values));
  std::erase_if(stars, [&](const Star& star) { return star.fit.reduced_chi2 > limit; });
}

/// Fit of log width over the frame, of the first `terms` powers.
struct WidthFit {
  PsfField::Polynomial polynomial{};
  double chi2 = 0.0;

  double at(const PsfField::Polynomial& powers) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < PsfField::terms; ++i) sum += polynomial[i] * powers[i];
    return sum;
  }
};

PsfField::Polynomial powers_of(const Star& star, const PsfField& field) {
  const PixelPosition p = field.unit({star.fit.trail.x_px, star.fit.trail.y_px});
  return PsfField::powers(p.x_px, p.y_px);
}

WidthFit fit_widths(const std::vector<Star>& stars, const PsfField& field, std::size_t terms) {
  NormalEquations equations;
  const auto weight_of = [](const Star& star) {
    return 1 / (star.fit.error * star.fit.error + width_floor * width_floor);
  };
  for (const Star& star : stars) {
    const auto by = powers_of(star, field);
    equations.add(weight_of(star), std::span(by).first(terms), star.fit.log_width);
  }
  WidthFit fit;
  if (!cholesky(equations.matrix, terms)) return {.chi2 = HUGE_VAL};
  const SmallVector solution = solve(equations.matrix, equations.right, terms);
  std::copy_n(solution.begin(), terms, fit.polynomial.begin());
  for (const Star& star : stars) {
    const double off = star.fit.log_width - fit.at(powers_of(star, field));
    fit.chi2 += weight_of(star) * off * off;
  }
  return fit;
}

/// Width and its change over the frame; stars far from it are dropped.
void fit_field(std::vector<Star>& stars, PsfField& field) {
  WidthFit best;
  for (int round = 0; round < 3 && stars.size() >= min_stars; ++round) {
    best = fit_widths(stars, field, 1);
    field.varies = false;
    if (stars.size() >= least_for_slopes) {
      const WidthFit sloped = fit_widths(stars, field, PsfField::terms);
      const double scale = std::max(1.0, sloped.chi2 / double(stars.size() - PsfField::terms));
      if ((best.chi2 - sloped.chi2) / scale > 8.0 * (PsfField::terms - 1)) {
        best = sloped;
        field.varies = true;
      }
    }
    std::vector<double> offs;
    const auto off = [&](const Star& star) {
      return std::abs(star.fit.log_width - best.at(powers_of(star, field)));
    };
    for (const Star& star : stars) offs.push_back(off(star));
    const double limit = std::max(outlier_scatters * 1.48 * median_of(std::move(offs)), 0.03);
    std::erase_if(stars, [&](const Star& star) { return off(star) > limit; });
  }
  field.width_px = std::exp(best.polynomial[0]);
  field.log_scale = best.polynomial;
  field.log_scale[0] = 0.0;
  for (const Star& star : stars) {
    const double log_scale = best.at(powers_of(star, field)) - best.polynomial[0];
    field.min_log_scale = std::min(field.min_log_scale, log_scale);
    field.max_log_scale = std::max(field.max_log_scale, log_scale);
  }
}

std::vector<ShapeStar> shape_stars(const Scene& scene, const ComponentMap& map,
                                   const std::vector<Star>& stars, const PsfField& field) {
  const int every = std::max(1, int(field.width_px / 0.8));
  std::vector<ShapeStar> out;
  std::size_t used = 0;
  for (const Star& star : stars) {
    if (used > max_shape_pixels) break;
    const double width_px = field.sigma_at({star.fit.trail.x_px, star.fit.trail.y_px});
    ShapeStar shape{.trail = star.fit.trail, .background_e = star.fit.background_e};
    shape.pixels = map.pixels_around(scene, star.fit.trail, std::max(shape_widths * width_px, 6.0),
                                     *star.component, every);
    if (shape.pixels.size() < min_shape_pixels) continue;
    used += shape.pixels.size();
    shape.background_sigma_e = background_sigma_e(shape.pixels.front());
    out.push_back(std::move(shape));
  }
  return out;
}

/// The field of a frame, before anything is measured.
PsfField field_of(const Scene& scene) {
  PsfField field;
  field.centre = {(scene.counts.columns - 1) / 2.0, (scene.counts.rows - 1) / 2.0};
  field.half = {scene.counts.columns / 2.0, scene.counts.rows / 2.0};
  return field;
}

/// Usable pixels around one of the subtracted stars, with its light.
std::vector<FitPixel> pixels_with(ResidualFrame& starless, const Trail& star, const Trail& around,
                                  double reach_px) {
  starless.restore(star);
  auto pixels = starless.pixels_around(around, reach_px);
  starless.subtract(star);
  return pixels;
}

/// The brightest trails whose widths can be fitted, with their fits.
struct FittedTrails {
  std::vector<Trail> trails;
  std::vector<Star> stars;
};

FittedTrails fit_trails_of_stars(const Scene& scene, ResidualFrame& starless,
                                 std::span<const Trail> trails) {
  constexpr std::size_t max_trails = 60, max_pixels = 60000;
  std::vector<Trail> brightest(trails.begin(), trails.end());
  std::ranges::stable_sort(brightest, std::greater(), &Trail::flux_e);
  FittedTrails out;
  std::size_t used = 0;
  for (const Trail& trail : brightest) {
    if (out.stars.size() == max_trails || used > max_pixels) break;
    const double width_px = scene.psf.width_px;
    const auto pixels = pixels_with(starless, trail, trail, core_reach_px(width_px));
    if (pixels.empty() || pixels.size() < std::size_t(0.9 * trail.length_px * width_px)) continue;
    used += pixels.size();
    const auto fit = fit_star_width(pixels, trail, width_px, background_sigma_e(pixels.front()));
    if (!fit || fit->reduced_chi2 > max_reduced_chi2) continue;
    out.trails.push_back(trail);
    out.stars.push_back({nullptr, *fit});
  }
  return out;
}

/// Whether a fit was kept.
bool has(const std::vector<Star>& stars, const Trail& fitted) {
  return std::ranges::any_of(stars, [&](const Star& star) {
    return star.fit.trail.x_px == fitted.x_px && star.fit.trail.y_px == fitted.y_px;
  });
}

}  // namespace

PsfField measure_psf_of_trails(const Scene& scene, std::span<const Trail> trails) {
  if (trails.size() < min_stars) return scene.psf;
  ResidualFrame starless(scene);
  for (const Trail& trail : trails) starless.subtract(trail);
  const FittedTrails fitted = fit_trails_of_stars(scene, starless, trails);
  std::vector<Star> stars = fitted.stars;
  drop_bad_fits(stars);
  if (stars.size() < min_stars) return scene.psf;
  PsfField field = field_of(scene);
  fit_field(stars, field);
  if (stars.size() < min_stars) return scene.psf;
  field.stars = int(stars.size());
  std::vector<ShapeStar> shapes;
  std::size_t used = 0;
  for (std::size_t i = 0; i < fitted.stars.size() && used < max_shape_pixels; ++i) {
    const StarWidth& fit = fitted.stars[i].fit;
    if (!has(stars, fit.trail)) continue;
    ShapeStar shape{.trail = fit.trail, .background_e = fit.background_e};
    shape.pixels = pixels_with(starless, fitted.trails[i], fit.trail,
                               std::max(trail_shape_widths * field.width_px, 4.0));
    if (shape.pixels.size() < min_shape_pixels) continue;
    used += shape.pixels.size();
    shape.background_sigma_e = background_sigma_e(shape.pixels.front());
    shapes.push_back(std::move(shape));
  }
  fit_psf_ellipse(shapes, field);
  fit_psf_shape(shapes, field);
  return field;
}

PsfField measure_psf(const Scene& scene, const std::vector<Component>& components) {
  const auto candidates = psf_candidates(scene, components);
  if (candidates.size() < min_stars) return scene.psf;
  const ComponentMap map(components, scene.counts.columns, scene.counts.rows);
  PsfField field = field_of(scene);
  double width_px = scene.psf.width_px;
  std::vector<Star> stars;
  for (int round = 0; round < 3; ++round) {  // again where the header's width was far off
    stars = fit_candidates(scene, map, candidates, width_px);
    drop_bad_fits(stars);
    if (stars.size() < min_stars) return scene.psf;
    const double before = width_px;
    width_px = std::exp(median_log_width(stars));
    if (std::abs(width_px / before - 1) < 0.3) break;
  }
  fit_field(stars, field);
  if (stars.size() < min_stars) return scene.psf;
  field.stars = int(stars.size());
  const auto shapes = shape_stars(scene, map, stars, field);
  fit_psf_ellipse(shapes, field);
  fit_psf_shape(shapes, field);
  return field;
}

}  // namespace dmise
