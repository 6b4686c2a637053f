#include "core/base/numeric/elliptic.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dmise {
namespace {

constexpr double linear_below = 1e-9;  // |u|, at which sn is u

/// Means of the arithmetic-geometric mean of 1 and sqrt(m1).
struct Means {
  std::array<double, 32> a{}, b{};
  std::size_t count = 0;
};

Means means_of(double m1) {
  Means means;
  double a = 1.0, b = std::sqrt(m1);
  while (means.count + 1 < means.a.size()) {
    means.a[means.count] = a;
    means.b[means.count++] = b;
    if (a - b <= 1e-8 * a) break;
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return means;
}

}  // namespace

double carlson_rf(double x, double y, double z) {
  constexpr double near = 2e-3;  // the series below is off by near^6 / 50
  double mean = (x + y + z) / 3;
  while (std::max({std::abs(x - mean), std::abs(y - mean), std::abs(z - mean)}) > near * mean) {
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z);
    const double lambda = rx * ry + ry * rz + rz * rx;
    x = (x + lambda) / 4;
    y = (y + lambda) / 4;
    z = (z + lambda) / 4;
    mean = (x + y + z) / 3;
  }
  const double dx = 1 - x / mean, dy = 1 - y / mean, dz = -dx - dy;
  const double e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
  return (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44) / std::sqrt(mean);
}

JacobiFunctions jacobi_functions(double u, double m1) {
  if (std::abs(u) < linear_below) return {.sn = u};
  if (!(m1 > 0)) return {std::tanh(u), 1 / std::cosh(u), 1 / std::cosh(u)};
  const Means means = means_of(m1);
  double a = (means.a[means.count - 1] + means.b[means.count - 1]) / 2;
  const double sine = std::sin(a * u);
  double cs = std::cos(a * u) / sine;  // cn / sn
  double dn = 1.0;
  for (std::size_t i = means.count; i-- > 0;) {
    const double q = a * cs * cs;
    cs *= dn * a / means.a[i];
    dn = (means.b[i] + q) / (means.a[i] + q);
    a = means.a[i];
  }
  const double sn = std::copysign(1 / std::sqrt(1 + cs * cs), sine);
  return {sn, cs * sn, dn};
}

}  // namespace dmise
