#pragma once
#include <Eigen/Core>

#include "core/forces/manoeuvre.h"
#include "core/tracking/orbit_state.h"

namespace dmise {

/// Two objects at one time, near their closest approach.
struct Encounter {
  OrbitEstimate first, second;
  double radius_m = 0.0;  // sum of the radii of spheres around both
};

/// The second object relative to the first, in the axes of the first's orbit.
struct RelativeMotion {
  Vec<Rtn> position_m, velocity_m_per_s;
};
RelativeMotion relative_motion(const Encounter& encounter);

/// Time until the closest approach if both keep their velocities [s]; 0 if they have the same.
double to_closest_s(const Encounter& encounter);

/// Probability that the distance of the closest approach is below `radius_m`: both pass on straight
/// lines, positions have independent normal errors, velocities none. The integral of the errors'
/// density over a disc across the relative velocity (Foster & Estes 1992; Akella & Alfriend 2000,
/// JGCD 23, 769), to 1e-6 of itself. `position_m` and `velocity_m_per_s` are relative, `covariance`
/// the sum of both positions'. 0 if the velocity or the radius is. A covariance that is not
/// positive in the plane has the errors of 1 mm.
double collision_probability(const Eigen::Vector3d& position_m,
                             const Eigen::Vector3d& velocity_m_per_s,
                             const Eigen::Matrix3d& covariance_m2, double radius_m);
double collision_probability(const Encounter& encounter);

}  // namespace dmise
