#include "core/detection/light/psf_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "core/base/algebra/small_matrix.h"
#include "core/detection/light/psf_growth.h"

namespace dmise {
namespace {

// Widths of the parts in units of that of the nearest Gaussian: with free weights they follow
// Gaussians and Kolmogorov's and Moffat's profiles to 0.1 % of the peak, diffraction's to 0.9 %.
constexpr std::array<double, Psf::most> ratios = {0.55, 0.75, 1.0, 1.35, 1.8, 2.5, 3.5, 8.0};
constexpr std::size_t nearest = 2;  // the Gaussian itself
constexpr std::size_t parts = ratios.size();
constexpr std::size_t own = 4;            // parameters of a star: flux, x, y, background
constexpr std::size_t all = own + parts;  // with the weights
constexpr double weight_prior = 1.0;      // standard deviation of a weight around a Gaussian's
constexpr double mixture_error = 0.01;    // relative, of the mixture
constexpr double neighbour_error = 0.15;  // relative, that does not make a pixel an outlier
constexpr double mixture_outlier_sigmas = 4.0;  // light of a neighbour that was not found
constexpr double significant_chi2 = 60.0;       // gain of a mixture over a Gaussian
constexpr double negligible_chi2 = 25.0;        // loss by dropping a part
constexpr int rounds = 3;                       // solutions by linear least squares
static_assert(all <= max_parameters);

using Weights = std::array<double, parts>;
constexpr Weights gaussian = {0.0, 0.0, 1.0};
static_assert(ratios[nearest] == 1.0);

/// Normal equations of one star: its own parameters, then the weights.
NormalEquations equations_of(const ShapeStar& star, const PsfField& field, const Weights& weights,
                             bool rejects) {
  Psf psf = field.at({star.trail.x_px, star.trail.y_px});
  std::vector<TrailLight> lights;
  lights.reserve(parts);
  for (std::size_t k = 0; k < parts; ++k) {
    Psf part = psf.parts[k].sigma_px;
    part.along_x = psf.along_x;
    part.along_diagonal = psf.along_diagonal;
    lights.emplace_back(star.trail, part);
  }
  NormalEquations out;
  std::array<double, all> gradient{};
  std::array<std::vector<PlacedLight>, parts> of_part;
  for (std::size_t k = 0; k < parts; ++k) of_part[k] = placed_light_in(star.pixels, lights[k]);
  for (std::size_t n = 0; n < star.pixels.size(); ++n) {
    const FitPixel& p = star.pixels[n];
    double model = 0.0, by_x = 0.0, by_y = 0.0;
    for (std::size_t k = 0; k < parts; ++k) {
      const PlacedLight& light = of_part[k][n];
      gradient[own + k] = light.value;
      model += weights[k] * light.value;
      by_x += weights[k] * light.by_x;
      by_y += weights[k] * light.by_y;
    }
    gradient[0] = model / star.trail.flux_e;
    gradient[1] = by_x;
    gradient[2] = by_y;
    gradient[3] = 1.0;
    const double residual = p.signal_e - model - star.background_e;
    const double noise2 = p.variance_e2 + std::max(model, 0.0);
    const double tolerated = neighbour_error * model;
    if (rejects && residual * residual > mixture_outlier_sigmas * mixture_outlier_sigmas *
                                             (noise2 + tolerated * tolerated))
      continue;
    const double weight = 1 / (noise2 + mixture_error * model * mixture_error * model);
    out.add(weight, gradient, residual);
  }
  const double prior = 1 / (star.background_sigma_e * star.background_sigma_e);
  out.matrix[3][3] += prior;
  out.right[3] -= prior * star.background_e;
  return out;
}

/// How a star's own parameters follow from a step of the weights: `at_rest` less `by_weight` times
/// the step.
struct OwnStep {
  SmallVector at_rest{};
  std::array<SmallVector, parts> by_weight{};
};

/// Takes a star's own parameters out of its equations and adds the rest to `shared`.
OwnStep eliminate(NormalEquations star, NormalEquations& shared) {
  OwnStep step;
  if (!cholesky(star.matrix, own)) return step;  // only the first `own` rows change
  step.at_rest = solve(star.matrix, star.right, own);
  for (std::size_t k = 0; k < parts; ++k) {
    SmallVector column{};
    for (std::size_t i = 0; i < own; ++i) column[i] = star.matrix[own + k][i];
    step.by_weight[k] = solve(star.matrix, column, own);
  }
  for (std::size_t k = 0; k < parts; ++k) {
    const SmallVector& row = star.matrix[own + k];
    shared.right[k] += star.right[own + k];
    for (std::size_t i = 0; i < own; ++i) shared.right[k] -= row[i] * step.at_rest[i];
    for (std::size_t l = 0; l <= k; ++l) {
      shared.matrix[k][l] += row[own + l];
      for (std::size_t i = 0; i < own; ++i) shared.matrix[k][l] -= row[i] * step.by_weight[l][i];
    }
  }
  return step;
}

void move(ShapeStar& star, const OwnStep& own_step, const SmallVector& weights_step) {
  SmallVector step = own_step.at_rest;
  for (std::size_t k = 0; k < parts; ++k)
    for (std::size_t i = 0; i < own; ++i) step[i] -= own_step.by_weight[k][i] * weights_step[k];
  star.trail.flux_e = std::max(star.trail.flux_e + step[0], 0.1 * star.trail.flux_e);
  star.trail.x_px += std::clamp(step[1], -0.5, 0.5);
  star.trail.y_px += std::clamp(step[2], -0.5, 0.5);
  star.background_e += step[3];
}

/// Adds what is known of the weights: near a Gaussian's, and with the sum 1, so that a star's flux
/// is all its light.
void add_priors(NormalEquations& shared, const Weights& weights) {
  constexpr double by_prior = 1 / (weight_prior * weight_prior);
  double by_sum = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < parts; ++k) {
    by_sum += shared.matrix[k][k];
    sum += weights[k];
  }
  for (std::size_t k = 0; k < parts; ++k) {
    shared.matrix[k][k] += by_prior;
    shared.right[k] += by_sum * (1 - sum) - by_prior * (weights[k] - gaussian[k]);
    for (std::size_t l = 0; l <= k; ++l) shared.matrix[k][l] += by_sum;
  }
}

/// Weights of the parts in `used` that fit best, and the chi2 that they gain over no light.
struct Solution {
  Weights weights{};
  double gain = 0.0;
};

/// `total`: right side of the equations for the weights, not for a step of them.
std::optional<Solution> solved(const NormalEquations& total, const std::vector<std::size_t>& used) {
  SmallMatrix matrix{};
  SmallVector right{};
  for (std::size_t i = 0; i < used.size(); ++i) {
    right[i] = total.right[used[i]];
    for (std::size_t j = 0; j <= i; ++j) matrix[i][j] = total.matrix[used[i]][used[j]];
  }
  if (!cholesky(matrix, used.size())) return std::nullopt;
  const SmallVector weights = solve(matrix, right, used.size());
  Solution out;
  for (std::size_t i = 0; i < used.size(); ++i) {
    out.weights[used[i]] = weights[i];
    out.gain += weights[i] * right[i];
  }
  return out;
}

/// Drops one part after the other without which the stars fit as well.
void simplify(const NormalEquations& total, std::vector<std::size_t>& used, Solution& solution) {
  const double full = solution.gain;
  while (used.size() > 1) {
    std::optional<Solution> best;
    std::vector<std::size_t> best_used;
    for (const std::size_t part : used) {
      std::vector<std::size_t> fewer;
      std::copy_if(used.begin(), used.end(), std::back_inserter(fewer),
                   [&](std::size_t other) { return other != part; });
      auto without = solved(total, fewer);
      if (!without || (best && without->gain <= best->gain)) continue;
      best = without;
      best_used = fewer;
    }
    if (!best || best->gain < full - negligible_chi2) return;
    used = best_used;
    solution = *best;
  }
}

}  // namespace

void fit_psf_shape(std::vector<ShapeStar> stars, PsfField& field) {
  PsfField mixture = field;
  mixture.count = parts;
  mixture.ratios = ratios;
  Solution now{.weights = gaussian};
  std::vector<std::size_t> used(parts);
  std::iota(used.begin(), used.end(), std::size_t(0));
  for (int round = 0; round < rounds; ++round) {
    NormalEquations total;
    std::vector<OwnStep> steps;
    for (const ShapeStar& star : stars)
      steps.push_back(eliminate(equations_of(star, mixture, now.weights, round > 0), total));
    add_priors(total, now.weights);
    for (std::size_t k = 0; k < parts; ++k)  // from equations for a step
      for (std::size_t l = 0; l < parts; ++l)
        total.right[k] += total.matrix[std::max(k, l)][std::min(k, l)] * now.weights[l];
    auto next = solved(total, used);
    if (!next) return;
    if (round == 0) {
      const auto single = solved(total, {nearest});
      if (!single || next->gain < single->gain + significant_chi2) return;
    }
    if (round == rounds - 1) simplify(total, used, *next);
    const double sum = std::accumulate(next->weights.begin(), next->weights.end(), 0.0);
    if (!(sum > 0.5 && sum < 2.0)) return;
    SmallVector step{};
    for (std::size_t k = 0; k < parts; ++k) step[k] = next->weights[k] - now.weights[k];
    for (std::size_t i = 0; i < stars.size(); ++i) move(stars[i], steps[i], step);
    now = *next;
  }
  mixture.count = used.size();
  const double sum = std::accumulate(now.weights.begin(), now.weights.end(), 0.0);
  for (std::size_t i = 0; i < used.size(); ++i) {
    mixture.weights[i] = now.weights[used[i]] / sum;
    mixture.ratios[i] = ratios[used[i]];
  }
  const double light = light_by_growth(stars, mixture);
  for (std::size_t i = 0; i < used.size(); ++i) mixture.weights[i] /= light;
  field = mixture;
}

}  // namespace dmise
