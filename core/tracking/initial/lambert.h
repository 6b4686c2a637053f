#pragma once
#include <vector>

#include "core/frames/vec.h"
#include "core/tracking/outcome.h"

namespace dmise {

/// A conic from one place to another.
struct LambertPath {
  Vec<Gcrs> start_velocity_m_per_s;
  int turns = 0;             // whole turns on the way
  bool long_period = false;  // which of the two paths with the same number of turns, turns >= 1
};

struct LambertSettings {
  int max_turns = 0;          // >= 0
  Vec<Gcrs> normal{0, 0, 1};  // paths turn about it in the right-hand sense
};

/// All conics from `start_m` to `end_m` in `duration_s` > 0, with universal variables (Izzo 2015),
/// fewest turns first. Refuses places that are equal or at the centre, and those that are opposite
/// to within 1e-9 rad, whose plane is not determined.
Outcome<std::vector<LambertPath>> lambert(const Vec<Gcrs>& start_m, const Vec<Gcrs>& end_m,
                                          double duration_s, const LambertSettings& settings = {});

}  // namespace dmise
