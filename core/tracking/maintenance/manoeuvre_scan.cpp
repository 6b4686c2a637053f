#include "core/tracking/maintenance/manoeuvre_scan.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/numeric/chi_square.h"

namespace dmise {
namespace {

/// The fit without the manoeuvres at whose times candidates are tried.
class Scan {
 public:
  Scan(const MaintenanceForces& forces, const ArcFit& fit, std::optional<std::size_t> instead_of)
      : forces_(forces), fit_(fit) {
    const long all = long(fit.unknowns().size());
    const long first = all - 4 * long(fit.manoeuvres().size() - instead_of.value_or(0));
    for (long i = 0; i < all; ++i) {
      const bool replaced = instead_of && i >= first && i < first + 4;
      if (!replaced) kept_.push_back(i);
      // Its change goes to the residuals; the time is no part of it.
      if (replaced && i < first + 3)
        undone_ += fit.value(i) * fit.unknowns()[std::size_t(i)].effect;
    }
    if (instead_of) undone_since_ = fit.unknowns()[std::size_t(first)].since;
    solve();
  }

  ManoeuvreCandidate at(SimTime time) const {
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
    const Eigen::Vector3d right =
        effect.transpose() * right_after(time) - shared.transpose() * step_;
    const Eigen::Vector3d best = squares.ldlt().solve(right);
    return {{time, {sigma * best[0], sigma * best[1], sigma * best[2]}}, best.dot(right)};
  }

 private:
  const ArcUnknown& unknown(std::size_t k) const { return fit_.unknowns()[std::size_t(kept_[k])]; }

  OrbitVector right_after(SimTime time) const {
    OrbitVector out = fit_.information_after(time).right;
    if (undone_since_)
      out += fit_.information_after(std::max(time, *undone_since_)).squares * undone_;
    return out;
  }

  void solve() {
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
    covariance_ = normal.llt().solve(Eigen::MatrixXd::Identity(long(n), long(n)));
    step_ = covariance_ * right;
  }

  const MaintenanceForces& forces_;
  const ArcFit& fit_;
  std::vector<long> kept_;
  OrbitVector undone_ = OrbitVector::Zero();
  std::optional<SimTime> undone_since_;
  Eigen::MatrixXd covariance_;
  Eigen::VectorXd step_;
};

}  // namespace

std::vector<ManoeuvreCandidate> scan_for_manoeuvre(const MaintenanceForces& forces,
                                                   const ArcFit& fit, SimTime first, SimTime last,
                                                   double step_s,
                                                   std::optional<std::size_t> instead_of) {
  std::vector<ManoeuvreCandidate> out;
  const Scan scan(forces, fit, instead_of);
  for (SimTime t = first; t < last; t = t + sim_seconds(step_s)) out.push_back(scan.at(t));
  return out;
}

const ManoeuvreCandidate* best_of(const std::vector<ManoeuvreCandidate>& candidates) {
  const auto best = std::ranges::max_element(candidates, {}, &ManoeuvreCandidate::gain);
  return best == candidates.end() ? nullptr : &*best;
}

double time_sigma_s(const std::vector<ManoeuvreCandidate>& candidates) {
  const ManoeuvreCandidate* best = best_of(candidates);
  if (!best) return 0.0;
  double sum = 0, squares = 0;
  for (const ManoeuvreCandidate& c : candidates) {
    const double weight = std::exp(0.5 * (c.gain - best->gain));
    const double off_s = (c.change.time - best->change.time).seconds();
    sum += weight;
    squares += weight * off_s * off_s;
  }
  return std::sqrt(squares / sum);
}

double confidence_of(double gain, std::size_t times) {
  const double tail =
      0.5 * std::erfc(normal_of_chi_square(std::max(gain, 0.0), 3) / std::sqrt(2.0));
  return std::pow(1 - tail, double(times));
}

}  // namespace dmise
