#pragma once
#include <optional>
#include <vector>

#include "core/tracking/maintenance/manoeuvre_scan.h"

namespace dmise {

/// Times at which a manoeuvre may have been, around a peak of the evidence: means and deviations
/// over them.
struct ManoeuvreMode {
  VelocityChange change;
  double time_sigma_s = 0.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // errors of the change [m^2/s^2]
  double chance = 0.0;                                   // that the manoeuvre was then, [0, 1]
};

/// What is known of one manoeuvre.
struct ManoeuvreModes {
  std::vector<ManoeuvreMode> modes = {};  // the likeliest first; their chances add up to 1
  double gain = 0.0;                      // by which the likeliest lowers the sum of squares
  std::size_t times = 0;                  // that were tried

  /// Standard deviation of the time about that of the first mode, over all.
  double time_sigma_s() const;
  /// Covariance of the change about that of the first mode, over all.
  Eigen::Matrix3d covariance() const;
};

/// How far a fit may move a manoeuvre's time from where it begins [s].
inline constexpr double manoeuvre_shift_s = 900.0;

/// Manoeuvres of a fit as guesses of another.
std::vector<ManoeuvreGuess> guesses_of(const ArcFit& fit);

/// Finds all times at which the k-th manoeuvre of a fit may have been, each peak of the evidence by
/// a fit of its own. Leaves `fit` at the likeliest. Nothing if no time has evidence.
std::optional<ManoeuvreModes> modes_of(const MaintenanceForces& forces, ArcFit& fit, std::size_t k);

}  // namespace dmise
