#include "core/orbit/torque_free.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "core/base/error.h"
#include "core/base/numeric/elliptic.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double nothing = 1e-100;  // a rate, relative to the greatest
constexpr double slowest_rad_per_s = 1e-30;
constexpr double crest_end = 40.0;  // argument at which sech is below the rounding of 1

// Gauss-Legendre on [-1, 1], ten nodes. Source: Abramowitz & Stegun, table 25.4.
constexpr std::array<double, 5> node{0.1488743389816312, 0.4333953941292472, 0.6794095682990244,
                                     0.8650633666889845, 0.9739065285171717};
constexpr std::array<double, 5> weight{0.2955242247147529, 0.2692667193099963, 0.2190863625159820,
                                       0.1494513491505806, 0.0666713443086881};

std::array<double, 3> components(const Vec<Body>& v) { return {v.x, v.y, v.z}; }

double greatest(const Vec<Body>& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

Vec<Body> without_traces(const Vec<Body>& rate) {
  const double least = std::max(slowest_rad_per_s, nothing * greatest(rate));
  const auto kept = [&](double w) { return std::abs(w) < least ? 0.0 : w; };
  return {kept(rate.x), kept(rate.y), kept(rate.z)};
}

/// Whether the momentum is along the rate: (Ib - Ic) wb wc and its like vanish.
bool stays(const Vec<Body>& i, const Vec<Body>& w) {
  return (i.y - i.z) * w.y * w.z == 0 && (i.z - i.x) * w.z * w.x == 0 &&
         (i.x - i.y) * w.x * w.y == 0;
}

Quaternion about(const Vec<Body>& axis, double angle_rad) {
  const double half_rad = std::remainder(angle_rad, 4 * pi) / 2, s = std::sin(half_rad);
  return {std::cos(half_rad), axis.x * s, axis.y * s, axis.z * s};
}

}  // namespace

bool is_inertia(const Vec<Body>& inertia_kg_m2) {
  auto i = components(inertia_kg_m2);
  std::ranges::sort(i);
  constexpr double rounding = 1e-9;
  return i[0] > 0 && i[2] <= (i[0] + i[1]) * (1 + rounding) && std::isfinite(i[2]);
}

TorqueFreeRotation::TorqueFreeRotation(const Vec<Body>& inertia_kg_m2,
                                       const Vec<Body>& rate_rad_per_s)
    : inertia_kg_m2_(inertia_kg_m2), steady_rad_per_s_(without_traces(rate_rad_per_s)) {
  if (!is_inertia(inertia_kg_m2))
    throw Error(
        "attitude: no body has these moments of inertia: one exceeds the sum of the others");
  const Vec<Body> inertia = inertia_kg_m2 / greatest(inertia_kg_m2);
  is_steady_ = stays(inertia, steady_rad_per_s_);
  if (is_steady_) return;
  choose_axes(inertia, steady_rad_per_s_);
  turn_of_half_period_rad_ = std::isfinite(quarter_) ? 2 * turn_from_crest(quarter_) : 0.0;
  first_from_momentum_ = conjugate(momentum_from_now(0.0));
}

void TorqueFreeRotation::choose_axes(const Vec<Body>& inertia, const Vec<Body>& rate) {
  const auto i = components(inertia), w = components(rate);
  std::ranges::stable_sort(axis_, [&](std::size_t j, std::size_t k) { return i[j] > i[k]; });
  // L^2 - 2 T Ib, by differences of moments, so that nothing cancels but the two terms.
  const auto excess = [&](std::size_t j, std::size_t middle) {
    return i[j] * (i[j] - i[middle]) * w[j] * w[j];
  };
  const double over = excess(axis_[0], axis_[1]) + excess(axis_[2], axis_[1]);
  if (over < 0) std::swap(axis_[0], axis_[2]);
  const auto [a, b, c] = axis_;
  for (std::size_t k = 0; k < 3; ++k) moment_[k] = i[axis_[k]];
  const double of_a = std::abs(excess(a, c) + excess(b, c));  // |L^2 - 2 T Ic|
  const double of_c = std::abs(excess(b, a) + excess(c, a));  // |2 T Ia - L^2|
  const double ab = std::abs(i[a] - i[b]), ac = std::abs(i[a] - i[c]);
  const bool right_handed = b == (a + 1) % 3;
  const double parity = (right_handed ? 1 : -1) * (i[c] > i[a] ? 1 : -1);
  amplitude_[0] = std::copysign(std::sqrt(of_a / (i[a] * ac)), w[a]);
  amplitude_[2] = std::copysign(std::sqrt(of_c / (i[c] * ac)), w[c]);
  amplitude_[1] = std::sqrt(of_c / (i[b] * ab)) * std::copysign(1.0, parity * amplitude_[0]) *
                  std::copysign(1.0, amplitude_[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    twice_energy_ += i[k] * w[k] * w[k];
    momentum_ += i[k] * i[k] * w[k] * w[k];
  }
  momentum_ = std::sqrt(momentum_);
  m1_ = std::min(1.0, ac * std::abs(over) / (ab * of_a));
  quarter_ = m1_ > 0 ? carlson_rf(0.0, m1_, 1.0) : std::numeric_limits<double>::infinity();
  argument_per_s_ = std::sqrt(ab * of_a / (i[a] * i[b] * i[c]));
  const double length = std::hypot(w[b] / amplitude_[1], w[c] / amplitude_[2]);
  const double sine = w[b] / amplitude_[1] / length, cosine = w[c] / amplitude_[2] / length;
  argument_0_ = sine * carlson_rf(cosine * cosine, cosine * cosine + m1_ * sine * sine, 1.0);
}

Vec<Body> TorqueFreeRotation::rate_rad_per_s(double time_s) const {
  if (is_steady_) return steady_rad_per_s_;
  const double u = argument_at(time_s);
  const double turns = std::isfinite(quarter_) ? std::nearbyint(u / (2 * quarter_)) : 0.0;
  const double rest = turns == 0 ? u : u - turns * 2 * quarter_;
  const double sign = std::fmod(turns, 2.0) == 0 ? 1.0 : -1.0;
  const auto [sn, cn, dn] = jacobi_functions(rest, m1_);
  std::array<double, 3> w{};
  w[axis_[0]] = amplitude_[0] * dn;
  w[axis_[1]] = amplitude_[1] * sign * sn;
  w[axis_[2]] = amplitude_[2] * sign * cn;
  return {w[0], w[1], w[2]};
}

double TorqueFreeRotation::rate_period_s() const {
  return is_steady_ ? std::numeric_limits<double>::infinity() : 4 * quarter_ / argument_per_s_;
}

/// Rate of the turn about the momentum for the argument: (L wa + 2 T) / (L + Ia wa), which nothing
/// makes singular, over that of the argument.
double TorqueFreeRotation::turn_slope(double argument) const {
  const double wa = std::abs(amplitude_[0]) * jacobi_functions(argument, m1_).dn;
  return (momentum_ * wa + twice_energy_) / (momentum_ + moment_[0] * wa) / argument_per_s_;
}

/// The turn from argument 0 to `argument`, at most K; in panels of at most 1.
double TorqueFreeRotation::turn_from_crest(double argument) const {
  const double size = std::abs(argument), curved = std::min(size, crest_end);
  const double half = curved / std::max(1.0, std::ceil(curved)) / 2;
  double sum = 0.0;
  for (double middle = half; middle < curved; middle += 2 * half)
    for (std::size_t k = 0; k < node.size(); ++k)
      sum += half * weight[k] *
             (turn_slope(middle - half * node[k]) + turn_slope(middle + half * node[k]));
  sum += (size - curved) * twice_energy_ / momentum_ / argument_per_s_;
  return std::copysign(sum, argument);
}

double TorqueFreeRotation::turn_rad(double argument) const {
  if (!std::isfinite(quarter_)) return turn_from_crest(argument);
  const double halves = std::nearbyint(argument / (2 * quarter_));
  return halves * turn_of_half_period_rad_ + turn_from_crest(argument - halves * 2 * quarter_);
}

/// Axes of the body in those in which the momentum is along axis a and stays.
Quaternion TorqueFreeRotation::momentum_from_now(double time_s) const {
  const Vec<Body> w = rate_rad_per_s(time_s);
  const Vec<Body> momentum =
      unit(Vec<Body>{inertia_kg_m2_.x * w.x, inertia_kg_m2_.y * w.y, inertia_kg_m2_.z * w.z});
  std::array<double, 3> a{};
  a[axis_[0]] = std::copysign(1.0, amplitude_[0]);
  const Vec<Body> axis{a[0], a[1], a[2]};
  const Vec<Body> across = cross(momentum, axis);  // the shortest rotation to the axis is about it
  const double length = std::sqrt(2 * (1 + dot(momentum, axis)));
  return about(axis, turn_rad(argument_at(time_s))) *
         Quaternion{length / 2, across.x / length, across.y / length, across.z / length};
}

Quaternion TorqueFreeRotation::first_from_now(double time_s) const {
  if (!is_steady_) return first_from_momentum_ * momentum_from_now(time_s);
  const double speed = norm(steady_rad_per_s_);
  return speed > 0 ? about(steady_rad_per_s_ / speed, speed * time_s) : Quaternion{};
}

}  // namespace dmise
