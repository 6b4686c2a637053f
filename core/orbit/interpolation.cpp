#include "core/orbit/interpolation.h"

namespace dmise {

// The two basis polynomials of each knot are built from its Lagrange polynomial L:
// (1 - 2 L'(x_k) (x - x_k)) L^2 for the position and (x - x_k) L^2 for the slope.
HermiteWeights hermite_weights(int first, int count, double u, double tick_s) {
  HermiteWeights w;
  w.first = first;
  w.count = count;
  for (int k = 0; k < w.count; ++k) {
    const double knot = w.first + k;
    double lagrange = 1.0, lagrange_slope = 0.0;  // the slope at the knot itself
    double slope_here = 0.0;                      // and at `u`
    for (int j = 0; j < w.count; ++j) {
      if (j == k) continue;
      const double other = w.first + j;
      slope_here = (slope_here * (u - other) + lagrange) / (knot - other);
      lagrange *= (u - other) / (knot - other);
      lagrange_slope += 1.0 / (knot - other);
    }
    const double square = lagrange * lagrange;
    const std::size_t i = static_cast<std::size_t>(k);
    w.position[i] = (1.0 - 2.0 * lagrange_slope * (u - knot)) * square;
    w.slope_s[i] = (u - knot) * square * tick_s;
    const double square_slope = 2.0 * lagrange * slope_here;
    w.position_per_s[i] =
        ((1.0 - 2.0 * lagrange_slope * (u - knot)) * square_slope - 2.0 * lagrange_slope * square) /
        tick_s;
    w.slope[i] = square + (u - knot) * square_slope;
  }
  return w;
}

HermiteWeights hermite_weights(HermiteOrder order, double u, double tick_s) {
  return hermite_weights(-ticks_before(order), knots(order), u, tick_s);
}

}  // namespace dmise
