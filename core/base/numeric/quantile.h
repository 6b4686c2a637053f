#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace dmise {

/// Returns the value of a rank from 0, below `values.size()`; brings the values into another order.
template <class T>
T value_of_rank(std::vector<T>& values, std::size_t rank) {
  const auto at = values.begin() + std::ptrdiff_t(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}
/// The one in the middle of values (not empty); of an even number of them the upper one.
template <class T>
T middle_of(std::vector<T> values) {
  return value_of_rank(values, values.size() / 2);
}

/// The value at a share `q` of values (not empty), 0 the least, 1 the greatest.
template <class T>
T quantile_of(std::vector<T> values, double q) {
  return value_of_rank(values, std::size_t(q * double(values.size() - 1)));
}
template <class T>
T median_of(std::vector<T> values) {
  return quantile_of(std::move(values), 0.5);
}

/// Standard deviation of a normal distribution over the median of its absolute values.
inline constexpr double sigma_of_median = 1.4826;

}  // namespace dmise
