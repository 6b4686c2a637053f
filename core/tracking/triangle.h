#pragma once
#include <Eigen/Core>
#include <cmath>

namespace dmise {

/// Turns the rows of `stack` by Householder's reflections until its first `Turned` columns have
/// nothing below the diagonal: stack' stack stays the same. Sizes are fixed: no heap.
template <int Turned, int Rows, int Columns>
void triangularise(Eigen::Matrix<double, Rows, Columns>& stack) {
  for (int j = 0; j < Turned; ++j) {
    const double below = stack.col(j).tail(Rows - j - 1).squaredNorm();
    if (below == 0) continue;
    const double head = stack(j, j);
    const double length = std::sqrt(head * head + below);
    const double first = head >= 0 ? head + length : head - length;
    const double scale = 2 / (first * first + below);
    for (int k = j + 1; k < Columns; ++k) {
      const double share =
          scale * (first * stack(j, k) +
                   stack.col(j).tail(Rows - j - 1).dot(stack.col(k).tail(Rows - j - 1)));
      stack(j, k) -= share * first;
      stack.col(k).tail(Rows - j - 1) -= share * stack.col(j).tail(Rows - j - 1);
    }
    stack(j, j) = head >= 0 ? -length : length;
    stack.col(j).tail(Rows - j - 1).setZero();
  }
}

}  // namespace dmise
