#pragma once
#include <array>
#include <cmath>

// Symmetric matrices of two rows, as the covariances of places are.
namespace dmise {

using Symmetric2 = std::array<double, 3>;  // xx, xy, yy

inline double determinant(const Symmetric2& m) { return m[0] * m[2] - m[1] * m[1]; }

inline Symmetric2 inverse_of(const Symmetric2& m) {
  const double det = determinant(m);
  return {m[2] / det, -m[1] / det, m[0] / det};
}

/// v' M v.
inline double quadratic_form(const Symmetric2& m, double x, double y) {
  return m[0] * x * x + 2 * m[1] * x * y + m[2] * y * y;
}

/// v' C^-1 v, the square of the Mahalanobis distance.
inline double mahalanobis2(const Symmetric2& covariance, double x, double y) {
  const auto& [xx, xy, yy] = covariance;
  return quadratic_form({yy, -xy, xx}, x, y) / determinant(covariance);
}

/// The axes of an ellipse x' C^-1 x = 1: squares of their halves are mean + half and mean - half.
inline double mean_of_axes(const Symmetric2& m) { return 0.5 * (m[0] + m[2]); }
inline double half_of_axes(const Symmetric2& m) { return std::hypot(0.5 * (m[0] - m[2]), m[1]); }
/// Direction of the longer axis, from the first coordinate towards the second.
inline double axis_angle_rad(const Symmetric2& m) {
  return 0.5 * std::atan2(2 * m[1], m[0] - m[2]);
}

}  // namespace dmise
