#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/forces/acceleration.h"
#include "core/tracking/propagate.h"

// Dormand-Prince 5(4) for any type of number (Dormand & Prince 1980, J. Comp. Appl. Math. 6, 19).
namespace dmise {

/// Below it a path is within the Earth [m].
inline constexpr double ground_m = 6.356e6;

template <class T>
struct Path {
  Triple<T> r, v;
  T drag, srp;
};

template <class T>
Triple<T> along(const Triple<T>& a, double h, const Triple<T>& b) {
  return {a.x + h * b.x, a.y + h * b.y, a.z + h * b.z};
}

/// Weighted sum of the first `N` slopes, added to `a`.
template <class T, std::size_t N, std::size_t M>
Triple<T> plus(const Triple<T>& a, double h, const std::array<double, N>& weights,
               const std::array<Triple<T>, M>& slopes) {
  Triple<T> out = a;
  for (std::size_t i = 0; i < N; ++i) {
    const double w = h * weights[i];
    out.x += w * slopes[i].x;
    out.y += w * slopes[i].y;
    out.z += w * slopes[i].z;
  }
  return out;
}

/// One step of `h` [s] with the acceleration `first` at its start; `last` gets that at its end.
/// Returns the estimated error [m]: the larger of that of the position and that of the velocity
/// times sqrt(r^3 / gm).
template <class T>
double step(const ForceSettings& acting, const ForceInputs& around, const Path<T>& from, double h,
            const Triple<T>& first, Path<T>& to, Triple<T>& last) {
  std::array<Triple<T>, 7> dr, dv;
  dr[0] = from.v;
  dv[0] = first;
  const auto stage = [&](std::size_t k, const auto& weights) {
    const Triple<T> r = plus(from.r, h, weights, dr), v = plus(from.v, h, weights, dv);
    dr[k] = v;
    dv[k] = acceleration(acting, around, r, v, from.drag, from.srp);
    to.r = r;
    to.v = v;
  };
  stage(1, std::array{1.0 / 5});
  stage(2, std::array{3.0 / 40, 9.0 / 40});
  stage(3, std::array{44.0 / 45, -56.0 / 15, 32.0 / 9});
  stage(4, std::array{19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729});
  stage(5, std::array{9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656});
  stage(6, std::array{35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84});
  to.drag = from.drag;
  to.srp = from.srp;
  last = dv[6];
  constexpr std::array difference{71.0 / 57600,      0.0,        -71.0 / 16695, 71.0 / 1920,
                                  -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
  double er[3] = {0, 0, 0}, ev[3] = {0, 0, 0};
  for (std::size_t i = 0; i < 7; ++i) {
    er[0] += difference[i] * value_of(dr[i].x);
    er[1] += difference[i] * value_of(dr[i].y);
    er[2] += difference[i] * value_of(dr[i].z);
    ev[0] += difference[i] * value_of(dv[i].x);
    ev[1] += difference[i] * value_of(dv[i].y);
    ev[2] += difference[i] * value_of(dv[i].z);
  }
  const double distance = std::hypot(value_of(to.r.x), value_of(to.r.y), value_of(to.r.z));
  const double time = std::sqrt(distance * distance * distance / earth_gm_m3_per_s2);
  return std::fabs(h) *
         std::max(std::hypot(er[0], er[1], er[2]), time * std::hypot(ev[0], ev[1], ev[2]));
}

/// The forces that act on a path: drag and radiation are left out if their scale is 0 and does not
/// vary.
template <class T>
ForceSettings acting_on(const ForceSettings& settings, const Path<T>& path, bool drag_varies,
                        bool srp_varies) {
  ForceSettings acting = settings;
  acting.drag = settings.drag && (drag_varies || value_of(path.drag) != 0);
  acting.radiation = settings.radiation && (srp_varies || value_of(path.srp) != 0);
  return acting;
}

/// Moves `path` by `duration_s` from `start`. `steps`, if not null, gets the lengths of the steps
/// [s]. Returns the reason if there is no such path, else an empty text.
template <class T>
std::string_view integrate(const ForceModel& forces, const ForceSettings& acting, SimTime start,
                           double duration_s, const PropagationSettings& settings, Path<T>& path,
                           std::vector<double>* steps = nullptr) {
  const auto radius = [](const Path<T>& p) {
    return std::hypot(value_of(p.r.x), value_of(p.r.y), value_of(p.r.z));
  };
  const auto time_of = [&](double r) { return std::sqrt(r * r * r / earth_gm_m3_per_s2); };
  if (radius(path) < ground_m) return "the path is within the Earth";
  const double sense = duration_s < 0 ? -1 : 1;
  double left_s = std::fabs(duration_s), done_s = 0;
  double length_s = 0.1 * time_of(radius(path));
  Path<T> next;
  Triple<T> slope, end_slope;
  bool known = false;
  for (int count = 0; left_s > 0; ++count) {
    if (count == settings.max_steps) return "the path takes too many steps";
    const bool last = length_s >= left_s;
    const double h = sense * (last ? left_s : length_s);
    const ForceInputs around = forces.surroundings(start + sim_seconds(sense * done_s + h / 2));
    if (!known) slope = acceleration(acting, around, path.r, path.v, path.drag, path.srp);
    const double error_m = step(acting, around, path, h, slope, next, end_slope);
    if (!std::isfinite(error_m)) {
      length_s = std::fabs(h) / 10;
      known = true;
      if (length_s < 1e-9) return "the path is not finite";
      continue;
    }
    const double factor = 0.9 * std::pow(settings.position_tolerance_m / (error_m + 1e-300), 0.2);
    if (error_m > settings.position_tolerance_m && std::fabs(h) > 1e-3) {
      length_s = std::fabs(h) * std::clamp(factor, 0.1, 0.9);
      known = true;
      continue;
    }
    path = next;
    slope = end_slope;
    known = true;
    if (radius(path) < ground_m) return "the path enters the Earth";
    if (steps) steps->push_back(h);
    done_s += std::fabs(h);
    left_s = last ? 0 : left_s - std::fabs(h);
    if (!last || factor < 1) length_s = std::fabs(h) * std::clamp(factor, 0.2, 5.0);
  }
  return {};
}

}  // namespace dmise
