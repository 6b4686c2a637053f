#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/base/sim_time.h"

namespace dmise {

/// Instants `from + k step`, k = 0 .. steps; the last is `end` if that is earlier.
struct TimeGrid {
  SimTime from, step;
  std::size_t steps = 0;
  SimTime end{std::numeric_limits<std::int64_t>::max()};

  SimTime at(std::size_t k) const {
    return std::min(end, SimTime{from.ns + std::int64_t(k) * step.ns});
  }
  SimTime last() const { return at(steps); }
};

/// The grid that covers a span [> 0] in steps of `step` [> 0]; the last step may be shorter.
inline TimeGrid covering_grid(SimTime from, SimTime span, SimTime step) {
  return {from, step, std::size_t((span.ns + step.ns - 1) / step.ns), from + span};
}

/// A grid with equally spaced instants inserted, so that neighbours are not farther apart than a
/// given time. Equal to the grid if its step is no longer.
class FineGrid {
 public:
  FineGrid(const TimeGrid& grid, SimTime longest)
      : grid_(grid),
        parts_(std::max<std::int64_t>(1, (grid.step.ns + longest.ns - 1) / longest.ns)) {
    if (grid.steps == 0) return;
    const std::int64_t whole = std::int64_t(grid.steps - 1);
    const std::int64_t rest_ns = (grid.last() - grid.at(grid.steps - 1)).ns;
    // Parts that begin before the end; the last of them may be shorter.
    steps_ = std::size_t(whole * parts_ + (rest_ns * parts_ + grid.step.ns - 1) / grid.step.ns);
  }

  std::size_t steps() const { return steps_; }
  /// Maximum distance of neighbours [s].
  double step_s() const { return grid_.step.seconds() / double(parts_); }
  SimTime at(std::size_t k) const {
    const std::int64_t whole = std::int64_t(k) / parts_, part = std::int64_t(k) % parts_;
    return std::min(grid_.last(),
                    SimTime{grid_.at(std::size_t(whole)).ns + part * grid_.step.ns / parts_});
  }
  /// Index in the original grid, if the instant belongs to it.
  std::optional<std::uint32_t> of_grid(std::size_t k) const {
    if (k == steps_) return std::uint32_t(grid_.steps);
    if (std::int64_t(k) % parts_ != 0) return std::nullopt;
    return std::uint32_t(std::int64_t(k) / parts_);
  }

 private:
  TimeGrid grid_;
  std::int64_t parts_;
  std::size_t steps_ = 0;
};

}  // namespace dmise
