#pragma once
#include <optional>
#include <vector>

#include "core/tracking/maintenance/arc_fit.h"

namespace dmise {

/// A change of velocity that may have been, and by how much it would lower the sum of squares of a
/// fit.
struct ManoeuvreCandidate {
  VelocityChange change;
  double gain = 0.0;
};

/// Candidates at every `step_s` from `first` to `last`, to first order: each is the best change at
/// its time with all other unknowns fitted beside it. All come from the derivatives of one fit,
/// without a further path. `instead_of`: a manoeuvre of the fit whose place they take.
std::vector<ManoeuvreCandidate> scan_for_manoeuvre(const MaintenanceForces& forces,
                                                   const ArcFit& fit, SimTime first, SimTime last,
                                                   double step_s,
                                                   std::optional<std::size_t> instead_of = {});

/// The candidate of the largest gain; null of none.
const ManoeuvreCandidate* best_of(const std::vector<ManoeuvreCandidate>& candidates);

/// Standard deviation of the time of a manoeuvre that is one of these candidates [s], each as
/// likely as its gain tells.
double time_sigma_s(const std::vector<ManoeuvreCandidate>& candidates);

/// Probability that noise alone gives no candidate of `times` such a gain.
double confidence_of(double gain, std::size_t times);

}  // namespace dmise
