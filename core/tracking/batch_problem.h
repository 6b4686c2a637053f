#pragma once
#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "core/tracking/batch.h"

namespace dmise {

/// Residuals of the observations for one starting state, and derivatives of the computed angles by
/// the unknowns over the observations' errors; unused columns are 0.
struct LinearisedArc {
  std::vector<Eigen::Vector2d> residuals_rad;
  std::vector<Eigen::Vector2d> white;  // residuals over the observations' errors
  std::vector<double> sigmas;          // lengths of the whitened residuals
  std::vector<Eigen::Matrix<double, 2, orbit_size>> derivatives;
};

/// [R z] with R x = z in the sense of least squares: the triangle of all weighted rows.
using BatchTriangle = Eigen::Matrix<double, orbit_size, orbit_size + 1>;

/// Adds a row to the triangle.
void fold(BatchTriangle& triangle, const Eigen::Matrix<double, 1, orbit_size>& row, double white);

/// What stays the same while an orbit is fitted: observations in order, their weights and the
/// unknowns. Forces, observations and settings must outlive it.
class BatchProblem {
 public:
  BatchProblem(const ForceModel& forces, std::span<const AngleObservation> observations,
               const OrbitState& start, const BatchSettings& settings);

  int unknowns() const { return int(unknowns_.size()); }
  const std::vector<int>& rows() const { return unknowns_; }

  /// Returns the reason if there is no path from `start` through all times, else an empty text.
  std::string_view linearise(const OrbitState& start, bool with_derivatives,
                             LinearisedArc& out) const;

  OrbitState moved(const OrbitState& start, const OrbitVector& change) const;

 private:
  void observe(std::size_t i, const StateTransition& at, bool with_derivatives,
               LinearisedArc& out) const;

  const ForceModel& forces_;
  std::span<const AngleObservation> observations_;
  const BatchSettings& settings_;
  SimTime epoch_;
  std::vector<int> unknowns_;
  std::vector<std::size_t> later_, earlier_;  // indices, by growing distance from the epoch
  std::vector<Eigen::Matrix2d> whitening_;
};

}  // namespace dmise
