#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace dmise {

/// A value and its standard deviation.
struct MeasuredValue {
  double value = 0.0, sigma = 0.0;

  bool is_significant(double sigmas) const { return value > sigmas * sigma; }
};

/// Sums over a strip of the frame.
template <std::size_t N>
using StripSums = std::array<double, N>;

/// What a function makes of the sums of all strips, with the deviation that leaving out one strip
/// at a time shows (the jackknife of Tukey): it includes whatever differs from strip to strip.
template <std::size_t N, class Function>
MeasuredValue jackknifed(std::span<const StripSums<N>> strips, Function&& value_of) {
  StripSums<N> all{};
  for (const auto& strip : strips)
    for (std::size_t k = 0; k < N; ++k) all[k] += strip[k];
  double sum = 0.0, squares = 0.0;
  const double count = double(strips.size());
  const double whole = value_of(all);
  for (const auto& strip : strips) {
    StripSums<N> others = all;
    for (std::size_t k = 0; k < N; ++k) others[k] -= strip[k];
    const double off = value_of(others) - whole;
    sum += off;
    squares += off * off;
  }
  const double variance = (count - 1) / count * (squares - sum * sum / count);
  return {whole, std::sqrt(variance > 0 ? variance : 0.0)};
}

template <std::size_t N, class Function>
MeasuredValue jackknifed(const std::vector<StripSums<N>>& strips, Function&& value_of) {
  return jackknifed(std::span<const StripSums<N>>(strips), value_of);
}

/// The mean of values by their counts: sums of {count, values}.
inline double mean_of_sums(const StripSums<2>& sums) { return sums[1] / sums[0]; }

}  // namespace dmise
