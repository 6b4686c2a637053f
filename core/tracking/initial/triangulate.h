#pragma once
#include <span>

#include <Eigen/Core>

#include "core/tracking/angle_observation.h"
#include "core/tracking/outcome.h"

namespace dmise {

struct TriangulationSettings {
  double longest_s = 0.5;       // between the first and the last exposure; the object moves
  double min_angle_rad = 1e-3;  // between two lines of sight, at their widest
  double min_distance_m = 6.4e6, largest_distance_m = 1e9;  // from the Earth's centre
  double min_probability = 1e-6;                            // for lines to miss each other so far
};

/// A position where lines of sight of two or more sites meet.
struct TriangulatedPosition {
  SimTime time;  // when the light left
  Vec<Gcrs> position_m;
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  double chi2 = 0.0;           // sum over the residuals
  int degrees_of_freedom = 0;  // 2 n - 3
  double angle_rad = 0.0;      // widest between two lines
};

/// Weighted least squares over lines of sight at about one time. `velocity_m_per_s`: the object's,
/// if known; it carries each line's place to the common time, also by light time. Unknown (0), it
/// is fitted with the prior of a circular orbit: 0 +- sqrt(gm / 2 r) along both axes across the
/// radius,
/// +- 0.2 sqrt(gm / r) along it. Refuses fewer than two lines, lines that are nearly parallel, meet
/// behind a sensor or miss each other, and a position out of range.
Outcome<TriangulatedPosition> triangulate(std::span<const AngleObservation> observations,
                                          const Vec<Gcrs>& velocity_m_per_s = {},
                                          const TriangulationSettings& settings = {});

}  // namespace dmise
