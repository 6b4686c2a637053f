#include "core/orbit/interpolation.h"

namespace dmise {

// Each knot's two basis polynomials are built on its Lagrange polynomial L:
// (1 - 2 L'(x_k) (x - x_k)) L^2 for the position and (x - x_k) L^2 for the slope.
HermiteWeights hermite_weights(HermiteOrder order, double u, double tick_s) {
  HermiteWeights w;
  w.first = -ticks_before(order);
  w.count = knots(order);
  for (int k = 0; k < w.count; ++k) {
    const double knot = w.first + k;
    double lagrange = 1.0, lagrange_slope = 0.0;
    for (int j = 0; j < w.count; ++j) {
      if (j == k) continue;
      const double other = w.first + j;
      lagrange *= (u - other) / (knot - other);
      lagrange_slope += 1.0 / (knot - other);
    }
    const double square = lagrange * lagrange;
    const std::size_t i = static_cast<std::size_t>(k);
    w.position[i] = (1.0 - 2.0 * lagrange_slope * (u - knot)) * square;
    w.slope_s[i] = (u - knot) * square * tick_s;
  }
  return w;
}

}  // namespace dmise
