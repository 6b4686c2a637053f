#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/base/sim_time.h"

namespace dmise {

/// Instants `from + k step`, k = 0 .. steps, the last of them `end` where that is earlier.
struct TimeGrid {
  SimTime from, step;
  std::size_t steps = 0;
  SimTime end{std::numeric_limits<std::int64_t>::max()};

  SimTime at(std::size_t k) const {
    return std::min(end, SimTime{from.ns + std::int64_t(k) * step.ns});
  }
  SimTime last() const { return at(steps); }
};

/// The instants that cover a span [> 0] by steps of `step` [> 0], the last one shorter where they
/// don't fit.
inline TimeGrid covering_grid(SimTime from, SimTime span, SimTime step) {
  return {from, step, std::size_t((span.ns + step.ns - 1) / step.ns), from + span};
}

/// The instants of a grid, and others between them in equal parts, so that neighbours are not
/// farther apart than a given time. Counted through; the grid's own where its step is no longer.
class FineGrid {
 public:
  FineGrid(const TimeGrid& grid, SimTime longest)
      : grid_(grid),
        parts_(std::max<std::int64_t>(1, (grid.step.ns + longest.ns - 1) / longest.ns)) {
    if (grid.steps == 0) return;
    const std::int64_t whole = std::int64_t(grid.steps - 1);
    const std::int64_t rest_ns = (grid.last() - grid.at(grid.steps - 1)).ns;
    // Parts whose beginning lies before the end; the last of them may be shorter.
    steps_ = std::size_t(whole * parts_ + (rest_ns * parts_ + grid.step.ns - 1) / grid.step.ns);
  }

  std::size_t steps() const { return steps_; }
  /// No two neighbours are farther apart.
  double step_s() const { return grid_.step.seconds() / double(parts_); }
  SimTime at(std::size_t k) const {
    const std::int64_t whole = std::int64_t(k) / parts_, part = std::int64_t(k) % parts_;
    return std::min(grid_.last(),
                    SimTime{grid_.at(std::size_t(whole)).ns + part * grid_.step.ns / parts_});
  }
  /// The instant of the grid that this is, if it is one.
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
