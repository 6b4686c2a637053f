#pragma once
#include <vector>

namespace dmise {

/// Inverts a symmetric positive n x n matrix by Cholesky's method; false if it is not well
/// conditioned (the matrix is then undefined).
bool invert_positive(std::vector<double>& matrix, int n);

}  // namespace dmise
