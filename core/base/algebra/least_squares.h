#pragma once
#include <cstddef>
#include <vector>

namespace dmise {

/// Solves min |A x - b| for several right-hand sides by Householder reflections. `a` is rows x
/// columns row-major, `b` is rows x sides row-major; rows >= columns >= 1. Returns x, columns x
/// sides row-major. Throws `Error` when the columns of A are linearly dependent.
std::vector<double> least_squares(std::vector<double> a, std::size_t columns, std::vector<double> b,
                                  std::size_t sides);

}  // namespace dmise
