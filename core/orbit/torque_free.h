#pragma once
#include <array>

#include "core/frames/quaternion.h"
#include "core/frames/vec.h"

namespace dmise {

struct Body {};  // axes fixed to an object's body

/// Rotation of a rigid body on which no torque acts. Rates are Jacobi's elliptic functions of time;
/// the turn about the momentum is the integral of a smooth function of them, by Gauss and Legendre
/// to rounding. Nothing accumulates: attitude and rate are functions of the time alone, off by some
/// 1e-15 of the angle turned through. Near the separatrix they are as sensitive as the motion is.
/// Source: Landau & Lifshitz, Mechanics, section 37.
class TorqueFreeRotation {
 public:
  /// Stands still.
  TorqueFreeRotation() = default;

  /// Body axes are principal axes. `inertia` [kg m^2] about them, of which only ratios count, each
  /// > 0 and none beyond the sum of the others (see `is_inertia`); `rate_rad_per_s` at time 0.
  /// Throws `Error` for moments that no body has.
  TorqueFreeRotation(const Vec<Body>& inertia_kg_m2, const Vec<Body>& rate_rad_per_s);

  /// Axes of the body at `time_s` in its axes at time 0.
  Quaternion first_from_now(double time_s) const;

  /// Angular velocity at `time_s` in axes of the body.
  Vec<Body> rate_rad_per_s(double time_s) const;

  /// Period of the rate in body axes [s]; infinite for a steady rotation and on the separatrix.
  double rate_period_s() const;

  const Vec<Body>& inertia_kg_m2() const { return inertia_kg_m2_; }

 private:
  void choose_axes(const Vec<Body>& inertia, const Vec<Body>& rate);
  Quaternion momentum_from_now(double time_s) const;
  double turn_slope(double argument) const;
  double turn_from_crest(double argument) const;
  double turn_rad(double argument) const;
  double argument_at(double time_s) const { return argument_0_ + argument_per_s_ * time_s; }

  Vec<Body> inertia_kg_m2_{1, 1, 1};
  bool is_steady_ = true;
  Vec<Body> steady_rad_per_s_;
  // Axes a, b, c in the order of their moments. The momentum goes round a in body axes: that of
  // the greatest moment if L^2 > 2 T Ib, else that of the least.
  std::array<std::size_t, 3> axis_{0, 1, 2};
  std::array<double, 3> moment_{};     // about a, b, c, the greatest 1
  std::array<double, 3> amplitude_{};  // rates about a (dn), b (sn) and c (cn) [rad/s]
  double momentum_ = 0.0, twice_energy_ = 0.0;
  double m1_ = 1.0;       // 1 - m, the complementary parameter
  double quarter_ = 0.0;  // K; infinite on the separatrix
  double argument_0_ = 0.0, argument_per_s_ = 0.0;
  double turn_of_half_period_rad_ = 0.0;
  Quaternion first_from_momentum_;
};

/// Whether a body may have these principal moments: all > 0, none beyond the sum of the others.
bool is_inertia(const Vec<Body>& inertia_kg_m2);

}  // namespace dmise
