#pragma once
#include <vector>

#include "core/visibility/time_grid.h"

namespace dmise {

/// An object is visible from `in_first` to `in_last` and invisible at `out_before` and `out_after`,
/// except at ends of the span. It may be as short as a crossing between two examined instants.
struct VisibilityInterval {
  std::uint32_t object = 0;
  SimTime out_before, in_first, in_last, out_after;
  bool open_start = false;  // visible at the span's beginning
  bool open_end = false;    // and at its end

  bool operator==(const VisibilityInterval&) const = default;
};

/// An object that is visible at all instants from `first` to `last` of a grid.
struct SeenRun {
  std::uint32_t object = 0;
  std::size_t first = 0, last = 0;
};

/// Intervals by object, then time: consecutive runs are merged, and each crossing [between two
/// instants that are in no run] is an interval. Input in any order.
std::vector<VisibilityInterval> intervals_of(std::vector<SeenRun> runs,
                                             std::vector<VisibilityInterval> crossings,
                                             const FineGrid& grid);

}  // namespace dmise
