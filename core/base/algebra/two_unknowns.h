#pragma once
#include <array>

#include "core/base/algebra/symmetric2.h"

// Weighted least squares of y = first a + second b, such as a straight line.
namespace dmise {

using TwoSums = std::array<double, 5>;  // sums of aa, ab, bb, ay, by

inline TwoSums row_of(double a, double b, double y, double weight) {
  return {weight * a * a, weight * a * b, weight * b * b, weight * a * y, weight * b * y};
}

inline void add_row(double a, double b, double y, double weight, TwoSums& sums) {
  const TwoSums row = row_of(a, b, y, weight);
  for (std::size_t k = 0; k < row.size(); ++k) sums[k] += row[k];
}

inline Symmetric2 matrix_of(const TwoSums& s) { return {s[0], s[1], s[2]}; }

/// First and second unknown; the second is 0 if it is not free.
inline std::array<double, 2> solution_of(const TwoSums& s, bool second_free = true) {
  if (!second_free) return {s[3] / s[0], 0.0};
  const double det = determinant(matrix_of(s));
  return {(s[2] * s[3] - s[1] * s[4]) / det, (s[0] * s[4] - s[1] * s[3]) / det};
}

}  // namespace dmise
