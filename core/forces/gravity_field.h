#pragma once
#include <vector>

#include "core/frames/vec.h"

namespace dmise {

/// Gravity of the Earth: the spherical harmonics of EGM2008 (Pavlis et al. 2012, JGR 117, B04406),
/// tide-free, to a degree and the same order. Immutable; may be shared between threads.
class GravityField {
 public:
  static constexpr int highest_degree = 70;

  /// `degree`: 0 (a point mass) or 2 to 70. Throws `Error` otherwise.
  explicit GravityField(int degree);

  int degree() const { return degree_; }

  /// Acceleration [m/s^2] at a place other than the Earth's centre. The series is of use outside
  /// the Earth. Rounding: 1e-15 of it.
  Vec<Itrs> acceleration_m_per_s2(const Vec<Itrs>& position_m) const;

 private:
  // For all orders m of a degree n, one after another: factors of the recursion, coefficients, and
  // the factor of the derivative.
  struct Row {
    std::size_t first = 0;  // place of order 0
    double diagonal = 0.0;  // factor of order n
  };
  int degree_;
  std::vector<Row> rows_;
  std::vector<double> ahead_, behind_, c_, s_, derivative_;
};

}  // namespace dmise
