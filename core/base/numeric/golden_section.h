#pragma once
#include <algorithm>

namespace dmise {

/// Place of a function's minimum, and the smallest value found.
struct Least {
  double at, value;
};

/// Finds the minimum of a function that has one minimum in [low, high], to `within`, by golden
/// section. Source: Kiefer 1953, Proc. Amer. Math. Soc. 4, 502.
template <class Function>
Least golden_section(const Function& of, double low, double high, double within) {
  constexpr double golden = 0.6180339887498949;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double of_a = of(a), of_b = of(b), least = std::min(of_a, of_b);
  while (high - low > within) {
    if (of_a < of_b) {
      high = b;
      b = a;
      of_b = of_a;
      a = high - golden * (high - low);
      least = std::min(least, of_a = of(a));
    } else {
      low = a;
      a = b;
      of_a = of_b;
      b = low + golden * (high - low);
      least = std::min(least, of_b = of(b));
    }
  }
  return {0.5 * (low + high), least};
}

}  // namespace dmise
