#pragma once
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/forces/forces.h"
#include "core/tracking/angle_observation.h"
#include "core/tracking/orbit_state.h"
#include "core/tracking/outcome.h"
#include "core/tracking/propagate.h"

namespace dmise {

struct BatchSettings {
  bool estimate_drag = false, estimate_srp = false;
  // Huber's threshold in sigmas: observations beyond count with less weight; 0: plain squares.
  double huber_sigma = 0.0;
  // Observations beyond are left out after a fit, and the rest is fitted again; 0: none are.
  double reject_sigma = 0.0;
  int max_iterations = 50;
  PropagationSettings propagation;
};

struct BatchFit {
  OrbitEstimate estimate;                      // at the starting state's time
  std::vector<Eigen::Vector2d> residuals_rad;  // observed - computed, east, north, in input order
  std::vector<bool> taken;                     // false: left out as an outlier
  double chi2 = 0.0;                           // by those taken
  int degrees_of_freedom = 0;
  int iterations = 0;
};

/// Levenberg-Marquardt over all observations with light time, derivatives by integration. Refuses
/// fewer observations than unknowns, a start that leads into the Earth, what does not converge and
/// what the observations do not determine (condition of the scaled triangle above 1e10).
Outcome<BatchFit> fit_orbit(const ForceModel& forces,
                            std::span<const AngleObservation> observations, const OrbitState& start,
                            const BatchSettings& settings = {});

}  // namespace dmise
