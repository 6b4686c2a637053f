#pragma once
#include <algorithm>
#include <vector>

namespace dmise {

/// The value at a share `q` of values (not empty), 0 the least, 1 the greatest.
inline double quantile_of(std::vector<double> values, double q) {
  const auto at = values.begin() + std::ptrdiff_t(q * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}
inline double median_of(std::vector<double> values) { return quantile_of(std::move(values), 0.5); }

}  // namespace dmise
