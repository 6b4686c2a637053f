#include "core/detection/trail_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/detection/small_matrix.h"

namespace dmise {
namespace {

using Vector = SmallVector;
using Matrix = SmallMatrix;

struct State {
  std::vector<Trail> trails;
  double background_e = 0.0;
};

class Problem {
 public:
  Problem(const std::vector<FitPixel>& pixels, const std::vector<unsigned>& free,
          const FitSettings& settings)
      : pixels_(pixels),
        free_(free),
        settings_(settings),
        fits_background_(settings.background_sigma_e > 0) {
    for (const unsigned mask : free)
      for (unsigned bit = 0; bit < trail_parameters; ++bit) size_ += mask >> bit & 1u;
    size_ += fits_background_ ? 1u : 0u;
    if (size_ > most_parameters) throw Error("trail fit: more than 16 free parameters");
  }

  std::size_t size() const { return size_; }

  /// One state of the fit. Weights depend on the model, so each state has its own; `merit` is its
  /// chi2 with the weights of the previous state, which a step must reduce.
  struct Linear {
    State state;
    Matrix matrix{};
    Vector right{};
    std::vector<double> variance;
    double chi2 = 0.0, deviance = 0.0, merit = 0.0;
  };

  Linear linearise(State state, const std::vector<double>* before) const {
    Linear out;
    out.variance.resize(pixels_.size());
    double logs = 0.0, product = 1.0;
    std::vector<TrailLight> evaluators;
    evaluators.reserve(state.trails.size());
    for (const Trail& trail : state.trails) evaluators.emplace_back(trail, settings_.psf);
    TrailDerivatives d{};
    Vector gradient{};
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      const FitPixel& pixel = pixels_[p];
      double model = 0.0;
      std::size_t k = 0;
      for (std::size_t t = 0; t < evaluators.size(); ++t) {
        model += evaluators[t](pixel.x, pixel.y, d);
        for (unsigned bit = 0; bit < trail_parameters; ++bit)
          if (free_[t] >> bit & 1u) gradient[k++] = d[bit];
      }
      if (fits_background_) gradient[k++] = 1.0;
      const double error = settings_.model_error * model;
      const double variance = pixel.variance_e2 + std::max(model, 0.0) + error * error;
      const double residual = pixel.signal_e - model - state.background_e;
      const double weight = 1 / variance;
      out.chi2 += residual * residual * weight;
      out.merit += residual * residual / (before ? (*before)[p] : variance);
      out.variance[p] = variance;
      product *= variance;
      if (product > 1e200 || product < 1e-200) {  // one logarithm for many pixels
        logs += std::log(product);
        product = 1.0;
      }
      for (std::size_t i = 0; i < size_; ++i) {
        const double wg = weight * gradient[i];
        out.right[i] += wg * residual;
        for (std::size_t j = 0; j <= i; ++j) out.matrix[i][j] += wg * gradient[j];
      }
    }
    logs += std::log(product);
    if (fits_background_) {
      const double weight = 1 / (settings_.background_sigma_e * settings_.background_sigma_e);
      const double penalty = weight * state.background_e * state.background_e;
      out.matrix[size_ - 1][size_ - 1] += weight;
      out.right[size_ - 1] -= weight * state.background_e;
      out.chi2 += penalty;
      out.merit += penalty;
    }
    out.deviance = out.chi2 + logs;
    out.state = std::move(state);
    return out;
  }

  State moved(const State& from, const Vector& step) const {
    State to = from;
    std::size_t k = 0;
    for (std::size_t t = 0; t < to.trails.size(); ++t) {
      Trail& trail = to.trails[t];
      double* const values[trail_parameters] = {&trail.x_px,      &trail.y_px,      &trail.flux_e,
                                                &trail.length_px, &trail.angle_rad, &trail.slope,
                                                &trail.sagitta_px};
      for (unsigned bit = 0; bit < trail_parameters; ++bit)
        if (free_[t] >> bit & 1u) *values[bit] += step[k++];
      trail.length_px = std::max(trail.length_px, 0.0);
      trail.slope = std::clamp(trail.slope, -1.0, 1.0);
    }
    if (fits_background_) to.background_e += step[k];
    return to;
  }

 private:
  const std::vector<FitPixel>& pixels_;
  const std::vector<unsigned>& free_;
  const FitSettings& settings_;
  bool fits_background_;
  std::size_t size_ = 0;
};

}  // namespace

bool TrailFit::good(double sigmas) const {
  return degrees > 0 && chi2 <= degrees + sigmas * std::sqrt(2.0 * degrees);
}

TrailFit fit_trails(const std::vector<FitPixel>& pixels, std::vector<Trail> start,
                    const std::vector<unsigned>& free, const FitSettings& settings) {
  const Problem problem(pixels, free, settings);
  const std::size_t n = problem.size();
  TrailFit fit;
  double damping = 1e-3;
  Problem::Linear now = problem.linearise({std::move(start), 0.0}, nullptr);
  fit.degrees = int(pixels.size()) - int(n) + (settings.background_sigma_e > 0 ? 1 : 0);
  for (int step = 0; step < settings.most_steps && !fit.converged; ++step) {
    fit.chi2 = now.chi2;
    if (settings.good_enough_sigmas && fit.good(*settings.good_enough_sigmas)) break;
    Matrix damped = now.matrix;
    for (std::size_t i = 0; i < n; ++i) damped[i][i] *= 1 + damping;
    if (!cholesky(damped, n)) break;
    Problem::Linear trial =
        problem.linearise(problem.moved(now.state, solve(damped, now.right, n)), &now.variance);
    const double gain = now.chi2 - trial.merit;
    fit.converged = std::abs(gain) < settings.settled_chi2;
    if (gain < 0 || !std::isfinite(trial.merit)) {
      damping *= 10;
      continue;
    }
    now = std::move(trial);
    damping *= 0.1;
  }
  State& state = now.state;
  Matrix& matrix = now.matrix;
  fit.chi2 = now.chi2;
  fit.deviance = now.deviance;
  fit.trails = std::move(state.trails);
  fit.background_e = state.background_e;
  fit.parameters = int(n);
  fit.covariance.assign(n * n, 0.0);
  if (cholesky(matrix, n)) {
    for (std::size_t i = 0; i < n; ++i) {
      Vector one{};
      one[i] = 1.0;
      const Vector column = solve(matrix, one, n);
      for (std::size_t j = 0; j < n; ++j) fit.covariance[j * n + i] = column[j];
    }
  } else {
    fit.converged = false;
  }
  return fit;
}

}  // namespace dmise
