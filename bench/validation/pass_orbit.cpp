#include "bench/validation/pass_orbit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "core/base/algebra/least_squares.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "core/orbit/two_body.h"

namespace dmise {
namespace {

constexpr double mean_radius_m = 6371e3;
constexpr double range_sigma_m = 1e3, phase_sigma_rad = 0.05 * deg;
constexpr std::array<double, 3> probe_step{1e-5, 1e-5, 100.0};  // rad, rad, m

using Numbers = std::array<double, 3>;  // RAAN, argument of latitude, radius

CircularPass with(CircularPass pass, const Numbers& step) {
  pass.raan_rad += step[0];
  pass.argument_rad += step[1];
  pass.radius_m += step[2];
  return pass;
}

/// Observed less predicted, in sigmas: all ranges, then all phases.
std::vector<double> misfit(const CircularPass& pass, std::span<const RangePhase> seen,
                           const Vec<Cirs>& to_sun) {
  std::vector<double> all(2 * seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Vec<Cirs> line = seen[i].observer_m - pass.at(seen[i].time_s).position_m;
    all[i] = (seen[i].range_m - norm(line)) / range_sigma_m;
    all[seen.size() + i] = (seen[i].phase_rad - angle_rad(line, to_sun)) / phase_sigma_rad;
  }
  return all;
}

double sum_of_squares(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double x : values) sum += x * x;
  return sum;
}

/// One damped step of least squares.
Numbers damped_step(const CircularPass& pass, std::span<const RangePhase> seen,
                    const Vec<Cirs>& to_sun, const std::vector<double>& misfits, double damping) {
  const std::size_t rows = misfits.size();
  std::vector<double> a(3 * (rows + 3), 0.0), b = misfits;
  b.resize(rows + 3, 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    Numbers step{};
    step[k] = probe_step[k];
    const auto ahead = misfit(with(pass, step), seen, to_sun);
    step[k] = -probe_step[k];
    const auto behind = misfit(with(pass, step), seen, to_sun);
    double square = 0.0;
    for (std::size_t i = 0; i < rows; ++i) {
      a[3 * i + k] = (behind[i] - ahead[i]) / (2 * probe_step[k]);
      square += a[3 * i + k] * a[3 * i + k];
    }
    a[3 * (rows + k) + k] = std::sqrt(damping * square) + 1e-12;
  }
  const auto x = least_squares(std::move(a), 3, std::move(b), 1);
  return {x[0], x[1], x[2]};
}

CircularPass improved(CircularPass pass, std::span<const RangePhase> seen,
                      const Vec<Cirs>& to_sun) {
  auto misfits = misfit(pass, seen, to_sun);
  double damping = 1e-3;
  for (int i = 0; i < 40 && damping < 1e8; ++i) {
    const Numbers step = damped_step(pass, seen, to_sun, misfits, damping);
    const CircularPass next = with(pass, step);
    auto left = misfit(next, seen, to_sun);
    if (sum_of_squares(left) < sum_of_squares(misfits)) {
      pass = next;
      misfits = std::move(left);
      damping /= 10;
      if (std::abs(step[0]) + std::abs(step[1]) < 1e-10) break;
    } else {
      damping *= 10;
    }
  }
  double square = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) square += misfits[i] * misfits[i];
  pass.rms_m = range_sigma_m * std::sqrt(square / double(seen.size()));
  return pass;
}

/// The two places at a stated radius that one range and phase leave, by a spherical Earth.
std::vector<Vec<Cirs>> places(const RangePhase& seen, const Vec<Cirs>& to_sun, double radius_m) {
  const double observer_m = norm(seen.observer_m);
  const Vec<Cirs> up = unit(seen.observer_m);
  const Vec<Cirs> across = to_sun - up * dot(to_sun, up);
  if (!(norm(across) > 1e-6)) return {};
  const double sine =
      std::clamp((radius_m * radius_m - observer_m * observer_m - seen.range_m * seen.range_m) /
                     (2 * observer_m * seen.range_m),
                 -1.0, 1.0);
  const double cosine = std::max(1e-6, std::sqrt(1 - sine * sine));
  const Vec<Cirs> sunwards = unit(across), aside = cross(up, sunwards);
  const double along = std::clamp(
      (-std::cos(seen.phase_rad) - sine * dot(to_sun, up)) / (cosine * norm(across)), -1.0, 1.0);
  std::vector<Vec<Cirs>> found;
  for (const double side : {1.0, -1.0}) {
    const Vec<Cirs> horizontal = sunwards * along + aside * (side * std::sqrt(1 - along * along));
    found.push_back(unit(seen.observer_m + (up * sine + horizontal * cosine) * seen.range_m) *
                    radius_m);
  }
  return found;
}

}  // namespace

MotionState<Cirs> CircularPass::at(double time_s) const {
  const double rate = std::sqrt(earth_gm_m3_per_s2 / (radius_m * radius_m * radius_m));
  const double u = argument_rad + rate * time_s;
  const double ci = std::cos(inclination_rad), si = std::sin(inclination_rad);
  const double co = std::cos(raan_rad), so = std::sin(raan_rad);
  const Vec<Cirs> node{co, so, 0.0}, ahead{-so * ci, co * ci, si};
  return {(node * std::cos(u) + ahead * std::sin(u)) * radius_m,
          (ahead * std::cos(u) - node * std::sin(u)) * (radius_m * rate)};
}

CircularPass fit_circular_pass(std::span<const RangePhase> seen, const Vec<Cirs>& to_sun,
                               double inclination_rad, double height_m, double worst_rms_m) {
  const RangePhase& middle = seen[seen.size() / 2];
  const double radius_m = mean_radius_m + height_m;
  std::optional<CircularPass> best;
  for (const auto& place : places(middle, to_sun, radius_m)) {
    const double sine = place.z / radius_m / std::sin(inclination_rad);
    if (std::abs(sine) > 1.0) continue;
    const double longitude = std::atan2(place.y, place.x);
    for (const double u : {std::asin(sine), pi - std::asin(sine)}) {  // northwards, southwards
      const double raan =
          longitude - std::atan2(std::sin(u) * std::cos(inclination_rad), std::cos(u));
      const double rate = std::sqrt(earth_gm_m3_per_s2 / (radius_m * radius_m * radius_m));
      const CircularPass pass = improved({.inclination_rad = inclination_rad,
                                          .raan_rad = raan,
                                          .argument_rad = u - rate * middle.time_s,
                                          .radius_m = radius_m},
                                         seen, to_sun);
      if (!best || pass.rms_m < best->rms_m) best = pass;
    }
  }
  if (!best || !(best->rms_m <= worst_rms_m))
    throw Error("no circular orbit fits" +
                (best ? ": the best by " + std::to_string(best->rms_m) + " m" : std::string()));
  return *best;
}

}  // namespace dmise
