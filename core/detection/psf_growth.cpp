#include "core/detection/psf_growth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/detection/small_matrix.h"

namespace dmise {
namespace {

constexpr std::array edges = {0.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0};  // of zones, in widths
constexpr std::size_t zones = edges.size() - 1;
constexpr double least_coverage = 0.3;  // of a star's zone by pixels that may be used
constexpr double outlier_sigmas = 4.0;
constexpr double model_error = 0.15;      // relative, that does not make a pixel an outlier
constexpr double sky_error = 0.3;         // around a star, in units of its background's prior
constexpr double most_difference = 0.25;  // from the mixture's light
// Light beyond a distance falls with its first power where there is diffraction, which leaves dark
// rings, a little faster so near; with the power 5/3 (Kolmogorov) to 3 (Moffat, beta 2.5) in
// seeing.
constexpr double dark_ring = -1.0;  // least weight of a part
constexpr double power_of_rings = 1.1, power_of_seeing = 2.2;
static_assert(zones < most_parameters);

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

/// Of one star: what is in its zones over the model.
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
    const double noise2 = p.variance_e2 + std::max(model, 0.0), tolerated = model_error * model;
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

}  // namespace

double light_by_growth(const std::vector<ShapeStar>& stars, const PsfField& mixture) {
  // Of each star excess = flux * (excess of a point) + area * (error of the sky): the sky between
  // stars has of their wings, and a star's own background takes of them.
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
      covered = covered && excess.pixels[k] > least_coverage * area[k] * density;
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
  if (!cholesky(matrix, zones + 1)) return 1.0;
  const SmallVector over = solve(matrix, right, zones + 1);
  // Light within a distance is all of it less a share that falls with a power of the distance.
  const double least_weight = *std::min_element(
      mixture.weights.begin(), mixture.weights.begin() + std::ptrdiff_t(mixture.count));
  const double power = least_weight < dark_ring ? power_of_rings : power_of_seeing;
  double within = 0.0, n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < zones; ++k) {
    within += of_model[k] / all + over[k];
    const double fall = std::pow(edges[k + 1], -power);
    n += 1;
    x += fall;
    y += within;
    xx += fall * fall;
    xy += fall * within;
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  const double total = slope < 0 ? (y - slope * x) / n : within;
  return std::abs(total - 1) < most_difference ? total : 1.0;
}

}  // namespace dmise
