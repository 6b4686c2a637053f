#include <Eigen/LU>

#include "core/tracking/initial/initial_orbit.h"
#include "core/tracking/initial/lambert.h"
#include "core/tracking/initial/three_lines.h"
#include "core/tracking/line_of_light.h"

namespace dmise {

namespace {

using Orbits = Outcome<std::vector<OrbitState>>;

/// By how much Lambert's path between the outer lines misses the middle line.
class Problem {
 public:
  Problem(std::span<const AngleObservation> three, bool short_way, int turns, bool other_branch)
      : three_(three), short_way_(short_way), turns_(turns), other_branch_(other_branch) {}

  /// Angles from the path to the middle line [rad]; `state` is that of the first light. False if
  /// there is no path.
  bool miss(const Eigen::Vector2d& log_ranges, Eigen::Vector2d& miss_rad, OrbitState& state) const {
    const double first_m = std::exp(log_ranges[0]), last_m = std::exp(log_ranges[1]);
    if (!(first_m < 1e12) || !(last_m < 1e12)) return false;
    const Vec<Gcrs> start = three_[0].sensor_m + first_m * three_[0].direction;
    const Vec<Gcrs> end = three_[2].sensor_m + last_m * three_[2].direction;
    LambertSettings settings;
    settings.max_turns = turns_;
    settings.normal = short_way_ ? cross(start, end) : cross(end, start);
    const double first_light = first_m / speed_of_light_m_per_s;
    const double between_s =
        (three_[2].time - three_[0].time).seconds() - last_m / speed_of_light_m_per_s + first_light;
    const auto paths = lambert(start, end, between_s, settings);
    if (!paths) return false;
    const LambertPath* path = nullptr;
    for (const LambertPath& p : *paths)
      if (p.turns == turns_ && (turns_ == 0 || p.long_period == other_branch_)) path = &p;
    if (!path) return false;
    state = {three_[0].time - sim_seconds(first_light), start, path->start_velocity_m_per_s};
    OrbitState middle = state;
    if (!move_two_body(middle, (three_[1].time - three_[0].time).seconds() + first_light))
      return false;
    const LineOfLight line =
        line_of_light(eigen_of(middle.position_m), eigen_of(middle.velocity_m_per_s),
                      eigen_of(three_[1].sensor_m));
    if (!(line.range_m > 0)) return false;
    miss_rad = angles_between(three_[1].direction, gcrs_of(line.line_m / line.range_m));
    return miss_rad.allFinite();
  }

  /// Damped Newton's steps on the logarithms of both ranges. False if they do
  /// not converge.
  bool solve(Eigen::Vector2d& at, OrbitState& state) const {
    Eigen::Vector2d miss_rad;
    if (!miss(at, miss_rad, state)) return false;
    double lambda = 1e-3;
    for (int i = 0; i < 60; ++i) {
      if (miss_rad.norm() < 1e-12) return true;
      Eigen::Matrix2d slope;
      if (!derivatives(at, slope)) return false;
      const Eigen::Matrix2d normal = slope.transpose() * slope;
      bool better = false;
      for (int tries = 0; tries < 25 && !better; ++tries) {
        Eigen::Matrix2d damped = normal;
        damped.diagonal() *= 1 + lambda;
        Eigen::Vector2d change = -damped.inverse() * slope.transpose() * miss_rad;
        if (!change.allFinite()) return false;
        if (const double size = change.norm(); size > 0.5) change *= 0.5 / size;
        Eigen::Vector2d there;
        OrbitState trial;
        better = miss(at + change, there, trial) && there.norm() < miss_rad.norm();
        if (better) {
          at += change;
          miss_rad = there;
          state = trial;
          lambda = std::max(lambda / 10, 1e-12);
        } else {
          lambda *= 10;
        }
      }
      if (!better) break;
    }
    return miss_rad.norm() < 1e-9;
  }

  /// Whether errors of `sigma_rad` leave both ranges known to a factor of e.
  bool determined(const Eigen::Vector2d& at, double sigma_rad) const {
    Eigen::Matrix2d slope;
    if (!derivatives(at, slope)) return false;
    // Both singular values: the sum of their squares, and their product.
    const double squares = slope.squaredNorm(), product = std::fabs(slope.determinant());
    const double larger = std::sqrt(
        (squares + std::sqrt(std::max(0.0, squares * squares - 4 * product * product))) / 2);
    return product > larger * std::max(sigma_rad, 1e-7 * larger);
  }

 private:
  /// Derivatives of the miss by the logarithms of both ranges.
  bool derivatives(const Eigen::Vector2d& at, Eigen::Matrix2d& slope) const {
    for (int k = 0; k < 2; ++k) {
      constexpr double h = 1e-6;
      Eigen::Vector2d up = at, down = at, over, under;
      OrbitState unused;
      up[k] += h;
      down[k] -= h;
      if (!miss(up, over, unused) || !miss(down, under, unused)) return false;
      slope.col(k) = (over - under) / (2 * h);
    }
    return slope.allFinite();
  }

  std::span<const AngleObservation> three_;
  bool short_way_;
  int turns_;
  bool other_branch_;
};

constexpr std::array default_ranges_m{3e5, 6e5, 1e6, 1.6e6, 2.5e6, 4e6, 8e6, 1.6e7, 2.4e7, 3.8e7};

}  // namespace

Outcome<std::vector<OrbitState>> gooding_orbit(std::span<const AngleObservation> three,
                                               const GoodingSettings& settings) {
  if (const auto fault = fault_of_three(three); !fault.empty()) return Orbits::refused(fault);
  std::vector<double> ranges = settings.ranges_m;
  if (ranges.empty()) ranges.assign(default_ranges_m.begin(), default_ranges_m.end());
  for (const double range : ranges)
    if (!(range > 0 && range < 1e12)) return Orbits::refused("a guessed range is not above 0");
  const double sigma_rad = largest_sigma_rad(three);
  bool undetermined = false;
  std::vector<OrbitState> out;
  for (int half_turns = 0; half_turns <= settings.max_half_turns; ++half_turns) {
    const int turns = half_turns / 2;
    const bool short_way = half_turns % 2 == 0;
    for (const bool other_branch : {false, true}) {
      if (other_branch && turns == 0) continue;
      const Problem problem(three, short_way, turns, other_branch);
      for (const double first : ranges)
        for (const double last : {first, 0.7 * first, 1.4 * first}) {
          OrbitState state;
          Eigen::Vector2d at{std::log(first), std::log(last)};
          if (!problem.solve(at, state) || !within(settings.limits, state)) continue;
          if (!problem.determined(at, sigma_rad)) {
            undetermined = true;
            continue;
          }
          // At one time, so that equal orbits are recognised.
          OrbitState common = state;
          if (!move_two_body(common, (three[0].time - state.time).seconds())) continue;
          common.time = three[0].time;
          add_distinct(out, common);
        }
    }
  }
  if (out.empty() && undetermined)
    return Orbits::refused("the three lines of sight do not determine ranges");
  if (out.empty()) return Orbits::refused("no orbit near the Earth passes through the three lines");
  return out;
}

}  // namespace dmise
