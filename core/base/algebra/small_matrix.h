#pragma once
#include <array>
#include <cmath>
#include <cstddef>

// Symmetric matrices of a few parameters, of which the first `n` rows and columns are used.
namespace dmise {

inline constexpr std::size_t max_parameters = 16;
using SmallVector = std::array<double, max_parameters>;
using SmallMatrix = std::array<SmallVector, max_parameters>;

/// Replaces the lower triangle by its Cholesky factor; false if not positive definite.
inline bool cholesky(SmallMatrix& m, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) m[j][j] -= m[j][k] * m[j][k];
    if (!(m[j][j] > 0) || !std::isfinite(m[j][j])) return false;
    m[j][j] = std::sqrt(m[j][j]);
    for (std::size_t i = j + 1; i < n; ++i) {
      for (std::size_t k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k];
      m[i][j] /= m[j][j];
    }
  }
  return true;
}

/// Normal equations of a fit by linear least squares.
struct NormalEquations {
  SmallMatrix matrix{};  // lower triangle
  SmallVector right{};

  /// Adds a value with its weight and its derivatives by the first parameters.
  template <class Gradient>
  void add(double weight, const Gradient& gradient, double value) {
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      const double weighted = weight * gradient[i];
      right[i] += weighted * value;
      for (std::size_t j = 0; j <= i; ++j) matrix[i][j] += weighted * gradient[j];
    }
  }
};

/// Solution of the system whose matrix has this Cholesky factor.
inline SmallVector solve(const SmallMatrix& factor, SmallVector v, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) v[i] -= factor[i][k] * v[k];
    v[i] /= factor[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) v[i] -= factor[k][i] * v[k];
    v[i] /= factor[i][i];
  }
  return v;
}

/// Column `i` of the inverse of the matrix that has this Cholesky factor.
inline SmallVector inverse_column(const SmallMatrix& factor, std::size_t i, std::size_t n) {
  SmallVector one{};
  one[i] = 1.0;
  return solve(factor, one, n);
}

}  // namespace dmise
