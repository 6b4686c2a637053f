#pragma once
#include <cmath>

namespace dmise {

// The cube root of chi-square over its degrees of freedom is nearly normal (Wilson & Hilferty 1931,
// PNAS 17, 684): chi-square is right to 3 % at 3 sigma with 2 degrees, to 1 % with 6 or more.

/// Returns the normal deviate with the same probability of being exceeded as `chi2` >= 0 of
/// `degrees` > 0.
inline double normal_of_chi_square(double chi2, double degrees) {
  const double k = 2.0 / (9.0 * degrees);
  return (std::cbrt(chi2 / degrees) - (1.0 - k)) / std::sqrt(k);
}

/// The inverse.
inline double chi_square_of_normal(double z, double degrees) {
  const double k = 2.0 / (9.0 * degrees);
  return degrees * std::pow(1.0 - k + z * std::sqrt(k), 3);
}

}  // namespace dmise
