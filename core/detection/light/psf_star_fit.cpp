#include "core/detection/light/psf_star_fit.h"

#include <algorithm>
#include <cmath>

#include "core/base/algebra/small_matrix.h"

namespace dmise {
namespace {

constexpr std::size_t parameters = 5;    // flux, x, y, background, log of the width
constexpr double gaussian_error = 0.05;  // relative, where stars are not Gaussian
constexpr double min_width_px = 0.25, max_width_px = 25.0;
constexpr int max_steps = 12;
constexpr double settled = 1e-3;   // convergence: step of the log of the width
constexpr double log_step = 0.01;  // step of the derivative by the log of the width
constexpr double max_step = 0.35;  // longest step of the log of the width

struct Linearised : NormalEquations {
  double chi2 = 0.0;
};

Linearised linearise(const std::vector<FitPixel>& pixels, const StarWidth& at,
                     double background_sigma_e) {
  Linearised out;
  const TrailLight light(at.trail, with_pixel(std::exp(at.log_width)));
  const TrailLight wider(at.trail, with_pixel(std::exp(at.log_width + log_step)));
  TrailDerivatives by{}, unused{};
  for (const FitPixel& p : pixels) {
    const double model = light(p.x, p.y, by);
    const double by_width = (wider(p.x, p.y, unused) - model) / log_step;
    const std::array<double, parameters> gradient = {by[2], by[0], by[1], 1.0, by_width};
    const double error = gaussian_error * model;
    const double weight = 1 / (p.variance_e2 + std::max(model, 0.0) + error * error);
    const double residual = p.signal_e - model - at.background_e;
    out.chi2 += weight * residual * residual;
    out.add(weight, gradient, residual);
  }
  const double prior = 1 / (background_sigma_e * background_sigma_e);
  out.matrix[3][3] += prior;
  out.right[3] -= prior * at.background_e;
  return out;
}

}  // namespace

std::optional<StarWidth> fit_star_width(const std::vector<FitPixel>& pixels, const Trail& start,
                                        double width_px, double background_sigma_e) {
  if (pixels.size() < 2 * parameters) return std::nullopt;
  StarWidth fit{.trail = start, .log_width = std::log(width_px)};
  for (int step = 0; step < max_steps; ++step) {
    Linearised normal = linearise(pixels, fit, background_sigma_e);
    if (!cholesky(normal.matrix, parameters)) return std::nullopt;
    const SmallVector move = solve(normal.matrix, normal.right, parameters);
    const double by_width = std::clamp(move[4], -max_step, max_step);
    fit.trail.flux_e += move[0];
    fit.trail.x_px += std::clamp(move[1], -1.0, 1.0);
    fit.trail.y_px += std::clamp(move[2], -1.0, 1.0);
    fit.background_e += move[3];
    fit.log_width += by_width;
    const double width = std::exp(fit.log_width);
    if (!(fit.trail.flux_e > 0) || !(width > min_width_px && width < max_width_px) ||
        !(std::hypot(fit.trail.x_px - start.x_px, fit.trail.y_px - start.y_px) <
          2 + 2 * width + start.length_px / 2))
      return std::nullopt;
    if (std::abs(by_width) > settled || std::hypot(move[1], move[2]) > settled * width) continue;
    fit.error = std::sqrt(inverse_column(normal.matrix, 4, parameters)[4]);
    fit.chi2 = normal.chi2;
    fit.reduced_chi2 = normal.chi2 / double(pixels.size() - parameters + 1);
    return fit;
  }
  return std::nullopt;
}

}  // namespace dmise
