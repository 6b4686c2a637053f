#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace dmise {

/// A symmetric matrix of which row i has elements in columns i - band to i + band; with a band of
/// size - 1 it is full.
class BandedMatrix {
 public:
  BandedMatrix(std::size_t size, std::size_t band)
      : size_(size), band_(std::min(band, size > 0 ? size - 1 : 0)), rows_(size * (band_ + 1)) {}

  std::size_t size() const { return size_; }
  std::size_t band() const { return band_; }
  /// An element of the lower triangle: j from i - band to i.
  double& at(std::size_t i, std::size_t j) { return rows_[i * (band_ + 1) + (i - j)]; }
  double at(std::size_t i, std::size_t j) const { return rows_[i * (band_ + 1) + (i - j)]; }
  std::size_t first_of(std::size_t i) const { return i > band_ ? i - band_ : 0; }

  std::vector<double> times(const std::vector<double>& v) const {
    std::vector<double> out(size_, 0.0);
    for (std::size_t i = 0; i < size_; ++i) {
      out[i] += at(i, i) * v[i];
      for (std::size_t j = first_of(i); j < i; ++j) {
        out[i] += at(i, j) * v[j];
        out[j] += at(i, j) * v[i];
      }
    }
    return out;
  }

  /// Replaces the matrix by its Cholesky factor; false if it is not positive definite.
  bool factorise() {
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t j = first_of(i); j <= i; ++j) {
        double sum = at(i, j);
        for (std::size_t k = std::max(first_of(i), first_of(j)); k < j; ++k)
          sum -= at(i, k) * at(j, k);
        if (i == j && !(sum > 0 && std::isfinite(sum))) return false;
        at(i, j) = i == j ? std::sqrt(sum) : sum / at(j, j);
      }
    return true;
  }

  /// Solution of the system whose matrix has this factor.
  std::vector<double> solve(std::vector<double> v) const {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = first_of(i); j < i; ++j) v[i] -= at(i, j) * v[j];
      v[i] /= at(i, i);
    }
    for (std::size_t i = size_; i-- > 0;) {
      v[i] /= at(i, i);
      for (std::size_t j = first_of(i); j < i; ++j) v[j] -= at(i, j) * v[i];
    }
    return v;
  }

 private:
  std::size_t size_, band_;
  std::vector<double> rows_;
};

}  // namespace dmise
