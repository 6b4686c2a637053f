#include "core/tracking/initial/lambert.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "core/orbit/two_body.h"

namespace dmise {

namespace {

/// Time of flight and its derivatives as functions of x, for a given lambda. Source: Izzo 2015,
/// Revisiting Lambert's problem, Celestial Mechanics and Dynamical Astronomy 121, 1.
struct TimeOfFlight {
  double lambda;

  double y(double x) const { return std::sqrt(1 - lambda * lambda * (1 - x * x)); }

  /// Non-dimensional time for `turns`.
  double time(double x, int turns) const {
    const double distance = std::fabs(x - 1);
    if (turns == 0 && distance < 0.01) return near_parabola(x);
    if (distance < 0.2 && distance > 0.01) return by_lagrange(x, turns);
    return by_lancaster(x, turns);
  }

  struct Derivatives {
    double first, second, third;
  };
  Derivatives derivatives(double x, double t) const {
    const double l2 = lambda * lambda, l3 = l2 * lambda, below = 1 - x * x, z = y(x);
    Derivatives d{};
    d.first = (3 * t * x - 2 + 2 * l3 * x / z) / below;
    d.second = (3 * t + 5 * x * d.first + 2 * (1 - l2) * l3 / (z * z * z)) / below;
    d.third =
        (7 * x * d.second + 8 * d.first - 6 * (1 - l2) * l2 * l3 * x / (z * z * z * z * z)) / below;
    return d;
  }

 private:
  double by_lagrange(double x, int turns) const {
    const double a = 1 / (1 - x * x);
    if (a > 0) {
      const double alpha = 2 * std::acos(std::clamp(x, -1.0, 1.0));
      double beta = 2 * std::asin(std::min(1.0, std::sqrt(lambda * lambda / a)));
      if (lambda < 0) beta = -beta;
      return a * std::sqrt(a) *
             ((alpha - std::sin(alpha)) - (beta - std::sin(beta)) + 2 * pi * turns) / 2;
    }
    const double alpha = 2 * std::acosh(x);
    double beta = 2 * std::asinh(std::sqrt(-lambda * lambda / a));
    if (lambda < 0) beta = -beta;
    return -a * std::sqrt(-a) * ((beta - std::sinh(beta)) - (alpha - std::sinh(alpha))) / 2;
  }

  double by_lancaster(double x, int turns) const {
    const double e = x * x - 1, z = y(x), g = x * z - lambda * e;
    double d = 0;
    if (e < 0) {
      d = turns * pi + std::acos(std::clamp(g, -1.0, 1.0));
    } else {
      const double f = std::sqrt(e) * (z - lambda * x);
      d = std::log(f + g);
    }
    return (x - lambda * z - d / std::sqrt(std::fabs(e))) / e;
  }

  /// Battin's series, without cancellation near x = 1.
  double near_parabola(double x) const {
    const double z = y(x), eta = z - lambda * x;
    const double s1 = 0.5 * (1 - lambda - x * eta);
    double q = 1, term = 1;
    for (int j = 0; j < 200 && std::fabs(term) > 1e-16; ++j) {
      term *= (3.0 + j) * (1.0 + j) / (2.5 + j) / (j + 1.0) * s1;
      q += term;
    }
    return (eta * eta * eta * (4.0 / 3 * q) + 4 * lambda * eta) / 2;
  }
};

/// Root of time(x) = t from `x` by Householder's third-order steps; none if it does not settle.
std::optional<double> by_householder(const TimeOfFlight& flight, double t, int turns, double x) {
  for (int i = 0; i < 30; ++i) {
    const double now = flight.time(x, turns);
    if (!std::isfinite(now)) return {};
    const double delta = now - t;
    const auto d = flight.derivatives(x, now);
    const double d2 = d.first * d.first;
    const double change = delta * (d2 - delta * d.second / 2) /
                          (d.first * (d2 - delta * d.second) + d.third * delta * delta / 6);
    const double next = x - change;
    if (!std::isfinite(next) || next <= -1 || (turns > 0 && next >= 1)) return {};
    x = next;
    if (std::fabs(change) < 1e-13 * (1 + std::fabs(x))) break;
  }
  if (std::fabs(flight.time(x, turns) - t) <= 1e-10 * t) return x;
  return {};
}

/// Root between `low` and `high` by bisection. Both are > -1; distances from -1 are halved in their
/// logarithm, for times far from the middle.
std::optional<double> by_bisection(const TimeOfFlight& flight, double t, int turns, double low,
                                   double high) {
  const bool falling = flight.time(low, turns) > t;
  if (falling == (flight.time(high, turns) > t)) return {};
  double a = std::log1p(low), b = std::log1p(high);
  for (int i = 0; i < 200 && b - a > 1e-16; ++i) {
    const double middle = (a + b) / 2;
    ((flight.time(std::expm1(middle), turns) > t) == falling ? a : b) = middle;
  }
  return std::expm1((a + b) / 2);
}

struct LeastTime {
  double x, time;
};

/// Least time for `turns` >= 1, by Halley's steps on its derivative from that at 0.
LeastTime min_time(const TimeOfFlight& flight, int turns, double at0) {
  LeastTime least{0, at0};
  for (int i = 0; i < 40; ++i) {
    const auto d = flight.derivatives(least.x, least.time);
    const double change = d.first * d.second / (d.second * d.second - d.first * d.third / 2);
    if (!std::isfinite(change)) break;
    least.x = std::clamp(least.x - change, -0.999999, 0.999999);
    least.time = flight.time(least.x, turns);
    if (std::fabs(change) < 1e-13) break;
  }
  return least;
}

double first_guess(double lambda, double t) {
  const double at0 =
      std::acos(std::clamp(lambda, -1.0, 1.0)) + lambda * std::sqrt(1 - lambda * lambda);
  const double at1 = 2.0 / 3 * (1 - lambda * lambda * lambda);
  if (t >= at0) return std::pow(at0 / t, 2.0 / 3) - 1;
  if (t <= at1) return 2.5 * at1 * (at1 - t) / (t * (1 - std::pow(lambda, 5))) + 1;
  return std::pow(t / at0, std::log(2.0) / std::log(at1 / at0)) - 1;
}

}  // namespace

Outcome<std::vector<LambertPath>> lambert(const Vec<Gcrs>& start_m, const Vec<Gcrs>& end_m,
                                          double duration_s, const LambertSettings& settings) {
  using Result = Outcome<std::vector<LambertPath>>;
  const double r1 = norm(start_m), r2 = norm(end_m);
  if (!std::isfinite(r1) || !std::isfinite(r2) || !std::isfinite(duration_s))
    return Result::refused("a place or the duration is not finite");
  if (!(r1 > 0) || !(r2 > 0)) return Result::refused("a place is the Earth's centre");
  if (!(duration_s > 0)) return Result::refused("the duration is not above 0");
  const double chord = norm(end_m - start_m);
  if (!(chord > 1e-12 * (r1 + r2))) return Result::refused("both places are the same");
  const Vec<Gcrs> u1 = start_m / r1, u2 = end_m / r2;
  const Vec<Gcrs> across = cross(u1, u2);
  if (!(norm(across) > 1e-9))
    return Result::refused(dot(u1, u2) < 0
                               ? "the places are opposite: the plane is not determined"
                               : "the places are in one direction: the plane is not determined");
  const double s = (r1 + r2 + chord) / 2;
  // 1 - chord / s without cancellation: s (s - chord) = r1 r2 cos^2(angle / 2).
  const double half = angle_rad(start_m, end_m) / 2;
  const double size = std::sqrt(r1 * r2) * std::fabs(std::cos(half)) / s;
  const double unit_time = std::sqrt(s * s * s / (2 * earth_gm_m3_per_s2));
  const double t = duration_s / unit_time;
  // The shorter way turns from the first to the second place by less than half a turn.
  const bool shorter = dot(across, settings.normal) >= 0;
  const double lambda = shorter ? size : -size;
  const TimeOfFlight flight{lambda};

  std::vector<LambertPath> out;
  const auto add = [&](double x, int turns, bool long_period) {
    const double gamma = std::sqrt(earth_gm_m3_per_s2 * s / 2);
    const double rho = (r1 - r2) / chord, sigma = 2 * std::sqrt(r1 * r2) * std::sin(half) / chord;
    const double y = flight.y(x);
    const double radial = gamma * ((lambda * y - x) - rho * (lambda * y + x)) / r1;
    const double transverse = gamma * sigma * (y + lambda * x);
    const Vec<Gcrs> normal = unit(across) * (lambda < 0 ? -1.0 : 1.0);
    const Vec<Gcrs> velocity = radial * u1 + (transverse / r1) * cross(normal, u1);
    if (std::isfinite(norm(velocity))) out.push_back({velocity, turns, long_period});
  };
  for (int turns = 0; turns <= settings.max_turns; ++turns) {
    if (turns == 0) {
      auto x = by_householder(flight, t, 0, first_guess(lambda, t));
      if (!x) x = by_bisection(flight, t, 0, -1 + 1e-14, 1e7);
      if (x) add(*x, 0, false);
      continue;
    }
    const double t0 = std::acos(std::clamp(lambda, -1.0, 1.0)) +
                      lambda * std::sqrt(1 - lambda * lambda) + turns * pi;
    const LeastTime least = min_time(flight, turns, t0);
    if (t < least.time) continue;
    // One root on each side of the least time.
    const double left = std::pow((turns + 1) * pi / (8 * t), 2.0 / 3);
    const double right = std::pow(8 * t / (turns * pi), 2.0 / 3);
    auto low = by_householder(flight, t, turns, (left - 1) / (left + 1));
    if (!low || *low > least.x) low = by_bisection(flight, t, turns, -1 + 1e-14, least.x);
    auto high = by_householder(flight, t, turns, (right - 1) / (right + 1));
    if (!high || *high < least.x) high = by_bisection(flight, t, turns, least.x, 1 - 1e-14);
    // The semi-major axis is that of least energy over 1 - x^2.
    const bool low_longer = low && high && std::fabs(*low) > std::fabs(*high);
    if (high) add(*high, turns, !low_longer);
    if (low) add(*low, turns, low_longer);
  }
  if (out.empty()) return Result::refused("no path was found");
  return out;
}

}  // namespace dmise
