#pragma once
#include <cmath>
#include <compare>
#include <cstdint>

namespace dmise {

/// Time since the scenario's UTC start, uniform at the TAI rate. Exact over +-292 years.
struct SimTime {
  std::int64_t ns = 0;

  auto operator<=>(const SimTime&) const = default;
  SimTime operator+(SimTime other) const { return {ns + other.ns}; }
  SimTime operator-(SimTime other) const { return {ns - other.ns}; }

  /// [s]; rounds once, so use it for differences, never to accumulate.
  double seconds() const { return static_cast<double>(ns) * 1e-9; }
};

/// Nearest nanosecond to `s` [s].
inline SimTime sim_seconds(double s) { return {static_cast<std::int64_t>(std::llround(s * 1e9))}; }

/// Number of a clock tick; tick k is at start + k * tick length.
using Tick = std::int64_t;

/// Greatest pace of the clock [simulated seconds per second].
inline constexpr double max_pace_factor = 1e6;

}  // namespace dmise
