#pragma once
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/tracking/angle_observation.h"
#include "core/tracking/maintenance/arc_path.h"

namespace dmise {

/// A manoeuvre as an unknown of a fit.
struct ManoeuvreGuess {
  VelocityChange change;
  double time_sigma_s = 0.0;  // within which the fit may shift it; 0: its time is held
};

/// What the observations after a time say of the state at the start of an arc: the sums of G'G and
/// G'r over them, with r the whitened residuals and G their derivatives by that state.
struct ArcInformation {
  OrbitMatrix squares = OrbitMatrix::Zero();
  OrbitVector right = OrbitVector::Zero();
};

/// An unknown of a fit in units of its prior's standard deviation: by it the state at the start of
/// the arc would have to change to have its effect on all that is observed after `since`.
struct ArcUnknown {
  SimTime since;
  OrbitVector effect;
};

/// Prior, observations, noise and manoeuvres of one object, and the orbit that fits them best:
/// least squares over state, scales of drag and sunlight, changes of velocity that stand for what
/// the forces leave out, and manoeuvres. Every unknown has a prior, so that any number of
/// observations has a solution.
class ArcFit {
 public:
  /// `observations` in order of time, none before the prior. Refuses what has no path, and a prior
  /// whose covariance is not positive definite in position and velocity.
  static Outcome<ArcFit> make(const MaintenanceForces& forces, const OrbitEstimate& prior,
                              std::vector<AngleObservation> observations,
                              std::vector<ManoeuvreGuess> manoeuvres,
                              const ArcFit* start = nullptr);

  /// Iterates until a step would lower the sum of squares by less than 0.01. Returns the reason if
  /// a path ends.
  std::string_view iterate(int max_iterations = 12);

  /// Sum of squares of whitened residuals and of unknowns over their priors' errors.
  double cost() const { return cost_; }
  /// By which one more step would lower the cost, to first order.
  double left() const { return left_; }
  const std::vector<AngleObservation>& observations() const { return observations_; }
  const std::vector<ManoeuvreGuess>& manoeuvres() const { return manoeuvres_; }
  const OrbitEstimate& prior() const { return prior_; }
  const ArcPath& path() const { return *path_; }
  SimTime end() const { return path_->end(); }
  /// Squared length of the whitened residual of an observation.
  double d2(std::size_t i) const { return residuals_[i].squaredNorm(); }

  /// State with its covariance at a time after the start; what the observations do not reach has
  /// the noise of the forces.
  Outcome<OrbitEstimate> estimate_at(SimTime time) const;
  /// Covariance of a manoeuvre's change along radius, motion and normal, and of its time [m/s, s].
  Eigen::Matrix4d covariance_of(std::size_t manoeuvre) const;

  // What a search for manoeuvres needs.
  const ArcInformation& information_after(SimTime time) const;
  const std::vector<ArcUnknown>& unknowns() const { return unknowns_; }
  double value(long i) const { return values_[i]; }  // fitted value of an unknown

 private:
  ArcFit(const MaintenanceForces& forces, const OrbitEstimate& prior)
      : forces_(&forces), prior_(prior) {}
  std::string_view linearise();
  void observe(std::size_t i);
  void list_unknowns();
  void list_noise();
  void solve();
  void move(const Eigen::VectorXd& by);
  OrbitVector shift_at(SimTime time) const;
  Eigen::MatrixXd effects_at(SimTime time) const;
  Eigen::Vector3d noise_sigma(std::size_t k) const;
  std::size_t first_noise() const { return orbit_size; }
  std::size_t first_manoeuvre() const { return orbit_size + 3 * noise_times_.size(); }
  SimTime end_of_observations() const;

  const MaintenanceForces* forces_;
  OrbitEstimate prior_;
  std::vector<AngleObservation> observations_;
  std::vector<ManoeuvreGuess> manoeuvres_;
  std::vector<SimTime> guessed_times_;          // times in the manoeuvres' priors
  OrbitMatrix root_ = OrbitMatrix::Identity();  // root of the prior's covariance
  OrbitState start_;
  std::vector<SimTime> noise_times_;
  Eigen::VectorXd noise_;   // changes of velocity over their priors' errors
  Eigen::VectorXd values_;  // all unknowns
  std::optional<ArcPath> path_;
  std::vector<ArcUnknown> unknowns_;
  std::vector<Eigen::Vector2d> residuals_;
  std::vector<ArcInformation> after_;  // by the observations from each on; the last is empty
  Eigen::VectorXd step_;
  Eigen::LLT<Eigen::MatrixXd> information_root_;
  double cost_ = 0.0, left_ = 0.0;
};

/// The estimate at a time on a path, of which the covariance at the start is given, with the noise
/// of the forces.
OrbitEstimate moved_along(const MaintenanceForces& forces, const ArcPath& path,
                          const OrbitMatrix& covariance, SimTime to);
/// An estimate of an object that may manoeuvre at once, by `sigma_m_per_s` along each axis.
OrbitEstimate perhaps_manoeuvred(OrbitEstimate estimate, double sigma_m_per_s);
/// An estimate moved on to a later time, with the noise of the forces.
Outcome<OrbitEstimate> move_on(const MaintenanceForces& forces, const OrbitEstimate& estimate,
                               SimTime to);

}  // namespace dmise
