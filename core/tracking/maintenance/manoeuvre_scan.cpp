#include "core/tracking/maintenance/manoeuvre_scan.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/numeric/chi_square.h"

namespace dmise {
namespace {

template <class Matrix>
double half_log_determinant(const Eigen::LLT<Matrix>& root) {
  return root.matrixLLT().diagonal().array().log().sum();
}

}  // namespace

ManoeuvreScan::ManoeuvreScan(const MaintenanceForces& forces, const ArcFit& fit,
                             std::optional<std::size_t> instead_of)
    : forces_(forces), fit_(fit) {
  const long all = long(fit.unknowns().size());
  const long first = all - 4 * long(fit.manoeuvres().size() - instead_of.value_or(0));
  for (long i = 0; i < all; ++i) {
    const bool replaced = instead_of && i >= first && i < first + 4;
    if (!replaced) kept_.push_back(i);
    // Its change goes to the residuals; the time is no part of it.
    if (replaced && i < first + 3) undone_ += fit.value(i) * fit.unknowns()[std::size_t(i)].effect;
  }
  if (instead_of) undone_since_ = fit.unknowns()[std::size_t(first)].since;
  solve();
}

const ArcUnknown& ManoeuvreScan::unknown(std::size_t k) const {
  return fit_.unknowns()[std::size_t(kept_[k])];
}

ManoeuvreCandidate ManoeuvreScan::at(SimTime time) const {
  const OrbitState there = fit_.path().at(time);
  const double sigma = forces_.settings().manoeuvre_sigma_m_per_s;
  Eigen::Matrix<double, orbit_size, 3> effect = Eigen::Matrix<double, orbit_size, 3>::Zero();
  effect.block<3, 3>(3, 0) = sigma * orbit_axes(there);
  effect = fit_.path().transition(time).inverse() * effect;
  Eigen::MatrixXd shared(long(kept_.size()), 3);
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    const ArcUnknown& a = unknown(k);
    shared.row(long(k)) =
        a.effect.transpose() * fit_.information_after(std::max(a.since, time)).squares * effect;
  }
  const Eigen::Matrix3d squares =
      Eigen::Matrix3d::Identity() +
      effect.transpose() * fit_.information_after(time).squares * effect -
      shared.transpose() * covariance_ * shared;
  const Eigen::Vector3d right = effect.transpose() * right_after(time) - shared.transpose() * step_;
  const Eigen::LLT<Eigen::Matrix3d> root(squares);
  const Eigen::Vector3d best = root.solve(right);
  const double gain = best.dot(right);
  if (root.info() != Eigen::Success || !std::isfinite(gain))
    return {.change = {time, {}}, .log_evidence = std::numeric_limits<double>::lowest()};
  return {.change = {time, {sigma * best[0], sigma * best[1], sigma * best[2]}},
          .covariance = sigma * sigma * root.solve(Eigen::Matrix3d::Identity()),
          .gain = gain,
          .log_evidence = log_evidence_ + 0.5 * gain - half_log_determinant(root)};
}

std::vector<ManoeuvreCandidate> ManoeuvreScan::every(double step_s) const {
  std::vector<ManoeuvreCandidate> out;
  const SimTime step = sim_seconds(step_s), last = fit_.end() - sim_seconds(1.0);
  for (SimTime t = fit_.prior().state.time + step; t < last; t = t + step) out.push_back(at(t));
  return out;
}

OrbitVector ManoeuvreScan::right_after(SimTime time) const {
  OrbitVector out = fit_.information_after(time).right;
  if (undone_since_)
    out += fit_.information_after(std::max(time, *undone_since_)).squares * undone_;
  return out;
}

void ManoeuvreScan::solve() {
  const std::size_t n = kept_.size();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(long(n), long(n));
  Eigen::VectorXd right = Eigen::VectorXd::Zero(long(n));
  for (std::size_t i = 0; i < n; ++i) {
    const ArcUnknown& a = unknown(i);
    right[long(i)] = a.effect.dot(right_after(a.since)) - fit_.value(kept_[i]);
    for (std::size_t j = 0; j < n; ++j) {
      const ArcUnknown& b = unknown(j);
      normal(long(i), long(j)) +=
          a.effect.dot(fit_.information_after(std::max(a.since, b.since)).squares * b.effect);
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> root(normal);
  covariance_ = root.solve(Eigen::MatrixXd::Identity(long(n), long(n)));
  step_ = covariance_ * right;
  // The sum of squares without a manoeuvre, after this step.
  double cost = fit_.cost() - right.dot(step_);
  for (long i = 0; i < long(fit_.unknowns().size()); ++i)
    if (!std::ranges::binary_search(kept_, i)) cost -= fit_.value(i) * fit_.value(i);
  if (undone_since_) {
    const ArcInformation& known = fit_.information_after(*undone_since_);
    cost += undone_.dot(2 * known.right + known.squares * undone_);
  }
  log_evidence_ = -0.5 * cost - half_log_determinant(root);
}

const ManoeuvreCandidate* best_of(const std::vector<ManoeuvreCandidate>& candidates) {
  const auto best = std::ranges::max_element(candidates, {}, &ManoeuvreCandidate::gain);
  return best == candidates.end() ? nullptr : &*best;
}

double confidence_of(double gain, std::size_t times) {
  const double tail =
      0.5 * std::erfc(normal_of_chi_square(std::max(gain, 0.0), 3) / std::sqrt(2.0));
  return std::pow(1 - tail, double(times));
}

}  // namespace dmise
