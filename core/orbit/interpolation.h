#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/base/sim_time.h"
#include "core/frames/vec.h"

namespace dmise {

/// Hermite interpolation of positions between equidistant ticks from positions and slopes. A slope
/// is the derivative of the position, not SGP4's velocity, which differs from it by centimetres to
/// metres per second.
enum class HermiteOrder {
  cubic = 3,    // the two ticks around the time; error ~ h^4
  quintic = 5,  // and the tick before them; error ~ h^6
  septic = 7,   // and one tick on either side; error ~ h^8
};

/// Number of ticks before the interval that an order needs.
constexpr int ticks_before(HermiteOrder order) { return order == HermiteOrder::cubic ? 0 : 1; }
constexpr int ticks_behind(HermiteOrder order) { return order == HermiteOrder::septic ? 2 : 1; }
constexpr int knots(HermiteOrder order) { return (static_cast<int>(order) + 1) / 2; }

/// First and last tick that an order uses.
struct KnotTicks {
  Tick first = 0, last = 0;
};

/// Ticks for the interval that begins at tick `interval`, in a run of ticks 0 to `last_tick` >= 1:
/// shifted inwards at the ends of the run; all ticks if there are too few.
constexpr KnotTicks knot_ticks(HermiteOrder order, Tick interval, Tick last_tick) {
  const Tick count = std::min<Tick>(knots(order), last_tick + 1);
  const Tick first =
      std::clamp<Tick>(interval - ticks_before(order), 0, std::max<Tick>(0, last_tick + 1 - count));
  return {first, first + count - 1};
}

/// Last tick that must be known to interpolate at `t` within the run.
constexpr Tick tick_needed(HermiteOrder order, SimTime t, SimTime tick_length, Tick last_tick) {
  const Tick after = std::max<Tick>(1, (t.ns + tick_length.ns - 1) / tick_length.ns);
  return knot_ticks(order, after - 1, last_tick).last;
}

/// `order`, or the highest order that the ticks 0 to `last_tick` >= 1 allow.
constexpr HermiteOrder order_within(HermiteOrder order, Tick last_tick) {
  return static_cast<HermiteOrder>(std::min<Tick>(static_cast<Tick>(order), 2 * last_tick + 1));
}

/// Half the step of the symmetric difference that gives a slope [s]. 3 mm/s^3 of jerk over a low
/// orbit make 2e-5 m/s of error; the rounding of a time a year from its epoch makes as much.
inline constexpr double slope_half_step_s = 0.125;
inline constexpr std::int64_t slope_half_step_ns = 125'000'000;

/// Weights of one time within an interval, common to all objects.
struct HermiteWeights {
  int first = 0;  // tick of the first knot, relative to the tick that begins the interval
  int count = 0;
  std::array<double, 4> position{};  // factors of the positions
  std::array<double, 4> slope_s{};   // factors of the slopes
  // Time derivatives of both.
  std::array<double, 4> position_per_s{}, slope{};
};

/// Weights of the position at the fraction `u` of the interval, [0, 1], of `tick_s` length.
HermiteWeights hermite_weights(HermiteOrder order, double u, double tick_s);
/// Weights on `count` knots, [2, 4], from tick `first` on.
HermiteWeights hermite_weights(int first, int count, double u, double tick_s);

/// Sum of `positions_m` and `slopes_m_per_s`, those of ticks first, first + 1, ...
template <class F>
Vec<F> interpolate(const HermiteWeights& w, std::span<const Vec<F>> positions_m,
                   std::span<const Vec<F>> slopes_m_per_s) {
  Vec<F> sum;
  for (std::size_t k = 0; k < static_cast<std::size_t>(w.count); ++k)
    sum += positions_m[k] * w.position[k] + slopes_m_per_s[k] * w.slope_s[k];
  return sum;
}

/// Cubic between two ticks, for one object.
template <class F>
Vec<F> interpolate_cubic(double u, double tick_s, const Vec<F>& position0_m,
                         const Vec<F>& slope0_m_per_s, const Vec<F>& position1_m,
                         const Vec<F>& slope1_m_per_s) {
  const HermiteWeights w = hermite_weights(HermiteOrder::cubic, u, tick_s);
  return position0_m * w.position[0] + slope0_m_per_s * w.slope_s[0] + position1_m * w.position[1] +
         slope1_m_per_s * w.slope_s[1];
}

}  // namespace dmise
