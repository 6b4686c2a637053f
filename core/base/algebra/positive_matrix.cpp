#include "core/base/algebra/positive_matrix.h"

#include <algorithm>
#include <cmath>

namespace dmise {

bool invert_positive(std::vector<double>& a, int n) {
  const auto at = [&](int i, int j) -> double& { return a[std::size_t(i * n + j)]; };
  std::vector<double> scale(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    if (!(at(i, i) > 0)) return false;
    scale[std::size_t(i)] = 1 / std::sqrt(at(i, i));
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) at(i, j) *= scale[std::size_t(i)] * scale[std::size_t(j)];
  for (int j = 0; j < n; ++j)
    for (int i = j; i < n; ++i) {
      double sum = at(i, j);
      for (int k = 0; k < j; ++k) sum -= at(i, k) * at(j, k);
      if (i == j && !(sum > 1e-11)) return false;
      at(i, j) = i == j ? std::sqrt(sum) : sum / at(j, j);
    }
  for (int j = 0; j < n; ++j)  // the inverse of the factor
    for (int i = j; i < n; ++i) {
      double sum = i == j ? 1.0 : 0.0;
      for (int k = j; k < i; ++k) sum -= at(i, k) * at(k, j);
      at(i, j) = sum / at(i, i);
    }
  std::vector<double> out(a.size());
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      double sum = 0.0;
      for (int k = std::max(i, j); k < n; ++k) sum += at(k, i) * at(k, j);
      out[std::size_t(i * n + j)] = sum * scale[std::size_t(i)] * scale[std::size_t(j)];
    }
  a = std::move(out);
  return true;
}

}  // namespace dmise
