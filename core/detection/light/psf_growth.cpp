#include "core/detection/light/psf_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/base/algebra/small_matrix.h"
#include "core/base/units.h"
#include "core/detection/light/aperture_light.h"

namespace dmise {
namespace {

constexpr std::array edges = {0.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0};  // zones' ends, in widths
constexpr std::size_t zones = edges.size() - 1;
constexpr double min_coverage = 0.3;  // share of a star's zone that usable pixels cover
constexpr double outlier_sigmas = 4.0;
constexpr double tolerated_error = 0.15;  // relative, that does not make a pixel an outlier
constexpr double sky_error = 0.3;         // around a star, in units of its background's prior
constexpr double max_difference = 0.25;   // from the mixture's light
// A part of less weight is a dark ring of diffraction, whose curve of growth is no power.
constexpr double dark_ring = -1.0;
// In seeing, light beyond a distance falls with the power 5/3 (Kolmogorov) to 3 (Moffat, beta 2.5)
// far out, and 1.9 to 2.8 at the zones' distances.
constexpr double power_of_seeing = 2.4;
constexpr std::array obscurations = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
constexpr double growth_error = 1e-3;    // in light within a distance, relative to all
constexpr double min_growth_gain = 4.0;  // gain in chi2 by which a shape is likelier
static_assert(zones < max_parameters);

double distance_px(const Trail& t, const FitPixel& p) {
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double dx = p.x - t.x_px, dy = p.y - t.y_px;
  const double beyond = std::max(std::abs(dx * c + dy * s) - t.length_px / 2, 0.0);
  return std::hypot(beyond, dy * c - dx * s);
}

/// Area within a distance of a trail.
double area_px2(const Trail& t, double reach_px) {
  return pi * reach_px * reach_px + 2 * t.length_px * reach_px;
}

/// What one star has in its zones over the model.
struct Excess {
  std::array<double, zones> light_e{}, variance_e2{}, pixels{};
};

Excess excess_of(const ShapeStar& star, const Psf& psf, double width_px) {
  Excess out;
  const TrailLight light(star.trail, psf);
  TrailDerivatives unused{};
  for (const FitPixel& p : star.pixels) {
    const double off = distance_px(star.trail, p) / width_px;
    const auto zone =
        std::size_t(std::upper_bound(edges.begin(), edges.end(), off) - edges.begin() - 1);
    if (zone >= zones) continue;
    const double model = light(p.x, p.y, unused);
    const double residual = p.signal_e - model;
    const double noise2 = p.variance_e2 + std::max(model, 0.0), tolerated = tolerated_error * model;
    out.pixels[zone] += 1;
    if (residual * residual > outlier_sigmas * outlier_sigmas * (noise2 + tolerated * tolerated))
      continue;
    out.light_e[zone] += residual;
    out.variance_e2[zone] += noise2;
  }
  return out;
}

/// Light of a point of the mixture between two distances, in widths.
double light_between(const Psf& psf, double width_px, double from, double to) {
  double light = 0.0;
  for (std::size_t k = 0; k < psf.count; ++k) {
    const double unit = width_px / psf.parts[k].sigma_px;
    const auto within = [&](double r) { return 1 - std::exp(-0.5 * r * r * unit * unit); };
    light += psf.parts[k].weight * (within(to) - within(from));
  }
  return light;
}

using Growth = std::array<double, zones>;  // within the outer edges of zones

/// Light as it grows with the distance, and what an error of the sky by its prior adds to it.
struct MeasuredGrowth {
  Growth light{}, by_sky{};
};

/// All light of a shape of growth, and the chi2 of that shape with an error of the sky.
struct Extrapolation {
  double total = 0.0, chi2 = HUGE_VAL;
};

/// `fall`: the shape of light that is missing, of which an amount is fitted too; null: none is.
Extrapolation extrapolated(const MeasuredGrowth& measured, const Growth& shape,
                           const Growth* fall) {
  const std::size_t n = fall ? 3 : 2;
  constexpr double weight = 1 / (growth_error * growth_error);
  NormalEquations equations;
  auto& [matrix, right] = equations;
  double squares = 0.0;
  for (std::size_t k = 0; k < zones; ++k) {
    const std::array<double, 3> by{shape[k], measured.by_sky[k], fall ? -(*fall)[k] : 0.0};
    equations.add(weight, std::span(by).first(n), measured.light[k]);
    squares += weight * measured.light[k] * measured.light[k];
  }
  matrix[1][1] += 1.0;
  if (!cholesky(matrix, n)) return {};
  const SmallVector found = solve(matrix, right, n);
  if (fall && found[2] < 0) return extrapolated(measured, shape, nullptr);
  Extrapolation out{found[0], squares};
  for (std::size_t i = 0; i < n; ++i) out.chi2 -= found[i] * right[i];
  return out;
}

/// By a power of the distance; as of the mixture, which has no light far out, if that is likelier.
Extrapolation by_seeing(const MeasuredGrowth& measured, const Growth& mixture) {
  Growth all, fall;
  for (std::size_t k = 0; k < zones; ++k) {
    all[k] = 1.0;
    fall[k] = std::pow(edges[k + 1], -power_of_seeing);
  }
  const Extrapolation by_power = extrapolated(measured, all, &fall);
  const Extrapolation by_mixture = extrapolated(measured, mixture, nullptr);
  return by_power.chi2 > by_mixture.chi2 + min_growth_gain ? by_mixture : by_power;
}

/// By the aperture's obscuration and the scale of diffraction that fit best.
Extrapolation by_aperture(const MeasuredGrowth& measured, double width_px) {
  constexpr double min_scale = 1.6, max_scale = 3.2, step = 1.01;  // in widths
  const double pixel = pixel_variance_px2 / (width_px * width_px);
  Extrapolation best;
  for (const double obscuration : obscurations) {
    const ApertureLight light(obscuration);
    for (double scale = min_scale; scale < max_scale; scale *= step) {
      Growth shape;
      for (std::size_t k = 0; k < zones; ++k)
        shape[k] = light.within(edges[k + 1] / scale, pixel / (scale * scale));
      const Extrapolation found = extrapolated(measured, shape, nullptr);
      if (found.chi2 < best.chi2) best = found;
    }
  }
  return best;
}

}  // namespace

double light_by_growth(const std::vector<ShapeStar>& stars, const PsfField& mixture) {
  // Each star's excess = flux * (excess of a point) + area * (error of the sky): the sky between
  // stars contains light of their wings, as a star's fitted background does.
  constexpr std::size_t sky = zones;
  SmallMatrix matrix{};
  SmallVector right{};
  std::array<double, zones> of_model{};
  double all = 0.0;
  for (const ShapeStar& star : stars) {
    const PixelPosition at{star.trail.x_px, star.trail.y_px};
    const Psf psf = mixture.at(at);
    const double width_px = mixture.sigma_at(at), flux = star.trail.flux_e;
    const Excess excess = excess_of(star, psf, width_px);
    double used = 0.0;
    for (const double n : excess.pixels) used += n;
    // Pixels are of a grid that may be coarse.
    const double density = used / area_px2(star.trail, edges.back() * width_px);
    std::array<double, zones> area{};
    bool covered = used > 0;
    for (std::size_t k = 0; k < zones; ++k) {
      area[k] =
          area_px2(star.trail, edges[k + 1] * width_px) - area_px2(star.trail, edges[k] * width_px);
      covered = covered && excess.pixels[k] > min_coverage * area[k] * density;
    }
    if (!covered) continue;
    all += flux * flux;
    for (std::size_t k = 0; k < zones; ++k) {
      of_model[k] += flux * flux * light_between(psf, width_px, edges[k], edges[k + 1]);
      const double scale = area[k] / excess.pixels[k];
      const double sky_e = sky_error * area[k] * star.background_sigma_e;
      const double weight = 1 / (scale * scale * excess.variance_e2[k] + sky_e * sky_e);
      const double light_e = scale * excess.light_e[k];
      matrix[k][k] += weight * flux * flux;
      matrix[sky][k] += weight * flux * area[k];
      matrix[sky][sky] += weight * area[k] * area[k];
      right[k] += weight * flux * light_e;
      right[sky] += weight * area[k] * light_e;
    }
  }
  if (!(all > 0)) return 1.0;
  matrix[sky][sky] += 1 / std::pow(sky_error * stars.front().background_sigma_e, 2);
  Growth of_sky;  // light of a zone by an error of the sky by its prior
  for (std::size_t k = 0; k < zones; ++k)
    of_sky[k] = stars.front().background_sigma_e * matrix[sky][k] / matrix[k][k];
  if (!cholesky(matrix, zones + 1)) return 1.0;
  const SmallVector over = solve(matrix, right, zones + 1);
  MeasuredGrowth measured;
  Growth model;
  double light = 0.0, by_model = 0.0, by_sky = 0.0;
  for (std::size_t k = 0; k < zones; ++k) {
    measured.light[k] = light += of_model[k] / all + over[k];
    model[k] = by_model += of_model[k] / all;
    measured.by_sky[k] = by_sky += of_sky[k];
  }
  const double min_weight = *std::min_element(
      mixture.weights.begin(), mixture.weights.begin() + std::ptrdiff_t(mixture.count));
  const double total = min_weight < dark_ring
                           ? by_aperture(measured, mixture.sigma_at(mixture.centre)).total
                           : by_seeing(measured, model).total;
  return std::abs(total - 1) < max_difference ? total : 1.0;
}

}  // namespace dmise
