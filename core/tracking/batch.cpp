#include "core/tracking/batch.h"

#include <algorithm>
#include <cmath>

#include "core/tracking/batch_problem.h"
#include "core/tracking/triangle.h"

namespace dmise {

namespace {

using Result = Outcome<BatchFit>;

/// Root of each observation's weight.
std::vector<double> weights_of(const LinearisedArc& linear, const std::vector<bool>& taken,
                               double huber_sigma) {
  std::vector<double> out(taken.size());
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const double r = linear.sigmas[i];
    out[i] = !taken[i] ? 0 : huber_sigma > 0 && r > huber_sigma ? std::sqrt(huber_sigma / r) : 1;
  }
  return out;
}

/// The cost that is minimised: squares of residuals, linear beyond Huber's threshold.
double cost_of(const LinearisedArc& linear, const std::vector<bool>& taken, double huber_sigma) {
  double sum = 0;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const double r = linear.sigmas[i];
    if (!taken[i]) continue;
    sum += huber_sigma > 0 && r > huber_sigma ? huber_sigma * (2 * r - huber_sigma) : r * r;
  }
  return sum;
}

/// The triangle of the weighted rows with columns scaled to length 1, and its inverse.
struct Normal {
  OrbitMatrix upper = OrbitMatrix::Zero(), inverse = OrbitMatrix::Zero();
  OrbitVector right = OrbitVector::Zero(), scale = OrbitVector::Ones();
  bool usable = false;      // every unknown has an effect on the residuals
  bool determined = false;  // and the effects are independent
};

Normal normal_of(int n, const LinearisedArc& linear, const std::vector<double>& weights) {
  BatchTriangle triangle = BatchTriangle::Zero();
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (int k = 0; k < 2; ++k)
      fold(triangle, weights[i] * linear.derivatives[i].row(k), weights[i] * linear.white[i][k]);
  Normal out;
  for (int k = 0; k < n; ++k) out.scale[k] = triangle.col(k).norm();
  if (!triangle.allFinite() || !(out.scale.minCoeff() > 0)) return out;
  out.usable = true;
  for (int k = 0; k < n; ++k) out.upper.col(k) = triangle.col(k) / out.scale[k];
  for (int k = n; k < orbit_size; ++k) out.upper(k, k) = 1;
  out.right.head(n) = triangle.col(orbit_size).head(n);
  out.inverse = out.upper.triangularView<Eigen::Upper>().solve(OrbitMatrix::Identity());
  out.determined = out.inverse.allFinite() && out.inverse.norm() < 1e10;
  return out;
}

/// Solves the triangle with the damping `lambda` on its scaled unknowns.
OrbitVector damped_change(const Normal& normal, double lambda) {
  Eigen::Matrix<double, 2 * orbit_size, orbit_size + 1> stack;
  stack << normal.upper, normal.right, std::sqrt(lambda) * OrbitMatrix::Identity(),
      OrbitVector::Zero();
  triangularise<orbit_size>(stack);
  const OrbitMatrix upper = stack.topLeftCorner<orbit_size, orbit_size>();
  const OrbitVector right = stack.col(orbit_size).head<orbit_size>();
  return upper.triangularView<Eigen::Upper>().solve(right).cwiseQuotient(normal.scale);
}

/// Levenberg-Marquardt until the change is below a thousandth of its error. Returns a reason, or
/// an empty text.
std::string_view descend(const BatchProblem& problem, const BatchSettings& settings,
                         const std::vector<bool>& taken, OrbitState& state, LinearisedArc& linear,
                         Normal& normal, int& iterations) {
  if (const auto reason = problem.linearise(state, true, linear); !reason.empty()) return reason;
  double lambda = 1e-6;
  double cost = cost_of(linear, taken, settings.huber_sigma);
  while (iterations < settings.max_iterations) {
    ++iterations;
    normal = normal_of(problem.unknowns(), linear, weights_of(linear, taken, settings.huber_sigma));
    if (!normal.usable) return "the observations do not determine the orbit";
    bool better = false, small = false;
    OrbitState trial;
    for (int tries = 0; tries < 40 && !better; ++tries) {
      const OrbitVector change = damped_change(normal, lambda);
      // The length of the step in units of the errors.
      small = (normal.upper * normal.scale.cwiseProduct(change)).norm() < 1e-3;
      trial = problem.moved(state, change);
      LinearisedArc there;
      double now = INFINITY;
      if (change.allFinite() && is_sane(trial) && problem.linearise(trial, false, there).empty())
        now = cost_of(there, taken, settings.huber_sigma);
      better = now <= cost * (1 + 1e-12);
      if (better) {
        cost = now;
        lambda = std::max(lambda / 10, 1e-15);
      } else {
        if (small) break;
        lambda = std::max(lambda * 10, 1e-12);
      }
    }
    if (better) {
      state = trial;
      if (const auto reason = problem.linearise(state, true, linear); !reason.empty())
        return reason;
    }
    if (small) {
      normal =
          normal_of(problem.unknowns(), linear, weights_of(linear, taken, settings.huber_sigma));
      return normal.determined ? "" : "the observations do not determine the orbit";
    }
    if (!better) return "the fit does not converge";
  }
  return "the fit does not converge";
}

}  // namespace

Outcome<BatchFit> fit_orbit(const ForceModel& forces,
                            std::span<const AngleObservation> observations, const OrbitState& start,
                            const BatchSettings& settings) {
  if (!is_sane(start)) return Result::refused("the start is not finite or out of range");
  for (const AngleObservation& o : observations)
    if (const auto fault = fault_of(o); !fault.empty()) return Result::refused(fault);
  const BatchProblem problem(forces, observations, start, settings);
  const auto enough = [&](const std::vector<bool>& taken) {
    return 2 * std::count(taken.begin(), taken.end(), true) >= problem.unknowns();
  };
  BatchFit fit;
  fit.taken.assign(observations.size(), true);
  if (!enough(fit.taken)) return Result::refused("fewer observations than unknowns");

  OrbitState state = start;
  LinearisedArc linear;
  Normal normal;
  std::vector<std::vector<bool>> fitted;  // sets, so that fits do not go round
  for (;;) {
    const auto reason =
        descend(problem, settings, fit.taken, state, linear, normal, fit.iterations);
    if (!reason.empty()) return Result::refused(reason);
    if (!(settings.reject_sigma > 0)) break;
    fitted.push_back(fit.taken);
    std::vector<bool> kept(observations.size());
    for (std::size_t i = 0; i < kept.size(); ++i)
      kept[i] = linear.sigmas[i] <= settings.reject_sigma;
    if (std::find(fitted.begin(), fitted.end(), kept) != fitted.end() || !enough(kept)) break;
    fit.taken = kept;
  }
  const int n = problem.unknowns();
  const OrbitMatrix root = normal.scale.cwiseInverse().asDiagonal() * normal.inverse;
  const OrbitMatrix covariance = root * root.transpose();
  fit.estimate.state = state;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      fit.estimate.covariance(problem.rows()[std::size_t(i)], problem.rows()[std::size_t(j)]) =
          covariance(i, j);
  fit.residuals_rad = linear.residuals_rad;
  fit.chi2 = cost_of(linear, fit.taken, 0);
  fit.degrees_of_freedom = 2 * int(std::count(fit.taken.begin(), fit.taken.end(), true)) - n;
  if (!is_sane(fit.estimate)) return Result::refused("the observations do not determine the orbit");
  return fit;
}

}  // namespace dmise
