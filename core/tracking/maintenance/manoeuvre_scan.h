#pragma once
#include <optional>
#include <vector>

#include "core/tracking/maintenance/arc_fit.h"

namespace dmise {

/// A change of velocity that may have been, the best at its time.
struct ManoeuvreCandidate {
  VelocityChange change;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // at this time [m^2/s^2]
  double gain = 0.0;          // by which it would lower the sum of squares of the fit
  double log_evidence = 0.0;  // comparable among fits to the same observations
};

/// Candidates to first order: each is the best change at its time with all other unknowns fitted
/// beside it. All come from the derivatives of one fit, without a further path.
class ManoeuvreScan {
 public:
  /// `instead_of`: a manoeuvre of the fit whose place they take. The fit must live as long.
  ManoeuvreScan(const MaintenanceForces& forces, const ArcFit& fit,
                std::optional<std::size_t> instead_of = {});

  /// Within the fit's arc.
  ManoeuvreCandidate at(SimTime time) const;
  /// One every `step_s` of the arc.
  std::vector<ManoeuvreCandidate> every(double step_s) const;

 private:
  const ArcUnknown& unknown(std::size_t k) const;
  OrbitVector right_after(SimTime time) const;
  void solve();

  const MaintenanceForces& forces_;
  const ArcFit& fit_;
  std::vector<long> kept_;  // unknowns beside the candidates
  OrbitVector undone_ = OrbitVector::Zero();
  std::optional<SimTime> undone_since_;
  Eigen::MatrixXd covariance_;
  Eigen::VectorXd step_;
  double log_evidence_ = 0.0;  // without a candidate
};

/// The candidate of the largest gain; null of none.
const ManoeuvreCandidate* best_of(const std::vector<ManoeuvreCandidate>& candidates);

/// Probability that noise alone gives no candidate of `times` such a gain.
double confidence_of(double gain, std::size_t times);

}  // namespace dmise
