#pragma once
#include <vector>

#include "core/visibility/time_grid.h"

namespace dmise {

/// An object is visible from `in_first` to `in_last`, not so at the ends unless
/// they are those of the span. It may last as short as between two instants looked at.
struct VisibilityInterval {
  std::uint32_t object = 0;
  SimTime out_before, in_first, in_last, out_after;
  bool open_start = false;  // visible at the span's beginning
  bool open_end = false;    // and at its end

  bool operator==(const VisibilityInterval&) const = default;
};

/// An object that is visible at all instants from `first` to `last` of a grid, and maybe beyond.
struct SeenRun {
  std::uint32_t object = 0;
  std::size_t first = 0, last = 0;
};

/// Intervals by object, then time: runs that follow each other are one, and each crossing [between
/// two instants that are in no run] is one more. In any order.
std::vector<VisibilityInterval> intervals_of(std::vector<SeenRun> runs,
                                             std::vector<VisibilityInterval> crossings,
                                             const FineGrid& grid);

}  // namespace dmise
