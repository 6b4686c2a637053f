#include "core/orbit/universal_kepler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dmise {

namespace {

constexpr long double pi_l = std::numbers::pi_v<long double>;

/// Real root of  q s + e s^3 / 6 = t  for t >= 0, the limit of the equation near the periapsis.
long double cubic_root(long double q, long double e, long double t) {
  const long double a = e / 6;
  if (a == 0) return t / q;
  if (q == 0) return std::cbrt(t / a);
  const long double w = std::sqrt(3 * a / q);
  const long double x = 1.5L * t / q * w;
  if (!std::isfinite(x)) return std::cbrt(t / a);
  return 2 / w * std::sinh(std::asinh(x) / 3);
}

/// Initial guess near the root, on the side from which Newton's method converges monotonically.
long double starting_anomaly(const Conic& conic, long double t) {
  const long double cubic = cubic_root(conic.q, conic.e, t);
  if (conic.alpha >= 0)
    return cubic;  // at or below the root: the first step goes over it, then down
  const long double root = std::sqrt(-conic.alpha);
  const long double mean_anomaly = t * root * root * root;
  if (mean_anomaly < 6 * conic.e) return cubic;  // above the root
  long double f = std::asinh(mean_anomaly / conic.e);
  f = std::asinh((mean_anomaly + f) / conic.e);
  return f / root;  // just below the root
}

}  // namespace

UniversalFunctions universal_functions(long double s, long double alpha) {
  const long double z = alpha * s * s;
  if (std::fabs(z) < 1) {
    // c2 = 1/2! - z/4! + ..., c3 = 1/3! - z/5! + ..., to below the last bit for |z| < 1.
    long double c2 = 0, c3 = 0;
    for (int k = 10; k >= 1; --k) {
      c2 = (1 - z * c2) / ((2 * k - 1) * (2 * k));
      c3 = (1 - z * c3) / ((2 * k) * (2 * k + 1));
    }
    return {1 - z * c2, s * (1 - z * c3), s * s * c2, s * s * s * c3};
  }
  const long double root = std::sqrt(std::fabs(alpha));
  const long double x = root * s;
  if (alpha > 0) {
    const long double half = std::sin(x / 2), sine = std::sin(x);
    return {std::cos(x), sine / root, 2 * half * half / alpha, (x - sine) / (alpha * root)};
  }
  const long double half = std::sinh(x / 2), sine = std::sinh(x);
  return {std::cosh(x), sine / root, -2 * half * half / alpha, (x - sine) / (alpha * root)};
}

long double universal_anomaly(const Conic& conic, long double time) {
  if (time == 0) return 0;
  const long double t = std::fabs(time);
  const long double longest = conic.alpha > 0 ? pi_l / std::sqrt(conic.alpha)
                                              : std::numeric_limits<long double>::infinity();
  long double s = std::min(starting_anomaly(conic, t), longest);
  // The function is convex and increasing: after one step the iterates decrease towards the root.
  // Stops when rounding prevents further decrease.
  for (int k = 0; k < 200; ++k) {
    const UniversalFunctions u = universal_functions(s, conic.alpha);
    const long double excess = conic.q * s + conic.e * u.u3 - t;
    const long double radius = conic.q + conic.e * u.u2;
    const long double next = std::clamp(s - excess / radius, 0.0L, longest);
    if (!(std::fabs(next - s) > 2 * std::numeric_limits<long double>::epsilon() * s)) break;
    if (k > 0 && next > s) break;
    s = next;
  }
  return std::copysign(s, time);
}

}  // namespace dmise
