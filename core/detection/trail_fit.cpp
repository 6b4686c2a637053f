#include "core/detection/trail_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr std::size_t most_parameters = 12;
constexpr std::size_t trail_parameters = 7;
constexpr double point_length_px = 1e-3;  // shorter is a point: the limit is exact to 1e-7

/// Normal distribution function and density, from a table by Taylor's series to third order: 1e-10.
class NormalTable {
 public:
  NormalTable() {
    for (std::size_t i = 0; i < cdf_.size(); ++i) {
      const double x = (double(i) - half) * step;
      cdf_[i] = 0.5 * std::erfc(-x / std::sqrt(2.0));
      pdf_[i] = std::exp(-0.5 * x * x) / std::sqrt(2 * pi);
    }
  }
  struct Value {
    double cdf, pdf;
  };
  Value operator()(double x) const {
    if (!(x > -reach)) return {0.0, 0.0};
    if (x > reach) return {1.0, 0.0};
    const int i = int(x * (1 / step) + half + 0.5);
    const double x0 = (i - half) * step, h = x - x0, p = pdf_[std::size_t(i)];
    return {cdf_[std::size_t(i)] + p * h * (1 - h * (x0 / 2 - h * (x0 * x0 - 1) / 6)),
            p * (1 - h * (x0 - h * ((x0 * x0 - 1) / 2 - h * x0 * (x0 * x0 - 3) / 6)))};
  }

 private:
  static constexpr double reach = 7.0, step = 1.0 / 64;
  static constexpr int half = 448;  // reach / step
  std::array<double, 2 * half + 1> cdf_{}, pdf_{};
};
const NormalTable normal;

/// A trail prepared for evaluation.
class Evaluator {
 public:
  Evaluator(const Trail& trail, double sigma_px)
      : t_(trail),
        s_(1 / sigma_px),
        cos_(std::cos(trail.angle_rad)),
        sin_(std::sin(trail.angle_rad)) {}

  /// Value, and its derivatives by the seven parameters in the order of `TrailParameter`.
  double operator()(double px, double py, std::array<double, trail_parameters>& d) const {
    const double dx = px - t_.x_px, dy = py - t_.y_px;
    const double along = dx * cos_ + dy * sin_, across = dy * cos_ - dx * sin_;
    double a = 0.0, a_along = 0.0, a_length = 0.0;  // light along the line, per px
    double w = 1.0, w_along = 0.0, w_length = 0.0, w_slope = 0.0;
    double bend = 0.0, bend_along = 0.0, bend_length = 0.0, bend_sagitta = 0.0;
    const double length = t_.length_px;
    if (length < point_length_px) {
      a = normal(along * s_).pdf * s_;
      a_along = -along * s_ * s_ * a;
    } else {
      const auto up = normal((along + length / 2) * s_), down = normal((along - length / 2) * s_);
      a = (up.cdf - down.cdf) / length;
      a_along = (up.pdf - down.pdf) * s_ / length;
      a_length = ((up.pdf + down.pdf) * s_ / 2 - a) / length;
      const double free = 2 * along / length;  // -1 .. 1 from end to end
      const double r = std::clamp(free, -1.0, 1.0);
      const bool inside = r == free;
      w = 1 + t_.slope * r;
      w_slope = r;
      bend_sagitta = 1.0 / 3 - r * r;
      bend = t_.sagitta_px * bend_sagitta;
      if (inside) {
        w_along = t_.slope * 2 / length;
        w_length = -t_.slope * r / length;
        bend_along = -t_.sagitta_px * 4 * r / length;
        bend_length = t_.sagitta_px * 2 * r * r / length;
      }
    }
    const double off = across - bend;
    const double g = normal(off * s_).pdf * s_, g_off = -off * s_ * s_ * g;
    const double f = t_.flux_e;
    const double by_along = f * ((a_along * w + a * w_along) * g - a * w * g_off * bend_along);
    const double by_across = f * a * w * g_off;
    d[0] = -by_along * cos_ + by_across * sin_;
    d[1] = -by_along * sin_ - by_across * cos_;
    d[2] = a * w * g;
    d[3] = f * ((a_length * w + a * w_length) * g - a * w * g_off * bend_length);
    d[4] = by_along * across - by_across * along;
    d[5] = f * a * w_slope * g;
    d[6] = -by_across * bend_sagitta;
    return f * d[2];
  }

 private:
  const Trail& t_;
  double s_, cos_, sin_;
};

using Vector = std::array<double, most_parameters>;
using Matrix = std::array<Vector, most_parameters>;

/// Replaces the lower triangle by its Cholesky factor; false if not positive definite.
bool cholesky(Matrix& m, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) m[j][j] -= m[j][k] * m[j][k];
    if (!(m[j][j] > 0) || !std::isfinite(m[j][j])) return false;
    m[j][j] = std::sqrt(m[j][j]);
    for (std::size_t i = j + 1; i < n; ++i) {
      for (std::size_t k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k];
      m[i][j] /= m[j][j];
    }
  }
  return true;
}

Vector solve(const Matrix& factor, Vector v, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) v[i] -= factor[i][k] * v[k];
    v[i] /= factor[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) v[i] -= factor[k][i] * v[k];
    v[i] /= factor[i][i];
  }
  return v;
}

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
    if (size_ > most_parameters) throw Error("trail fit: more than 12 free parameters");
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
    std::vector<Evaluator> evaluators;
    evaluators.reserve(state.trails.size());
    for (const Trail& trail : state.trails) evaluators.emplace_back(trail, settings_.sigma_px);
    std::array<double, trail_parameters> d{};
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

double trail_value(const Trail& trail, double sigma_px, double x, double y) {
  std::array<double, trail_parameters> unused{};
  return Evaluator(trail, sigma_px)(x, y, unused);
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
