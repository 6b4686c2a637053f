#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/fusion.h"
#include "core/fusion/observation_plan.h"
#include "core/sim/message.h"

namespace dmise {

/// A frame of a sensor that was searched, and what was found in it.
struct SearchedFrame {
  const FrameReport* report = nullptr;
  const DetectionSet* found = nullptr;
};

/// What makes tracks of the frames of all sensors: our filters or a program of the user's.
class Tracker {
 public:
  virtual ~Tracker() = default;

  struct Tracked {
    FusionTick tracks;
    /// What sensors that are cued are to observe. None: a scheduler chooses among the targets.
    std::optional<std::vector<CueWish>> wishes = {};
    std::optional<std::vector<Task>> tasks = {};  // that were given in a recorded run, instead
  };
  /// Performs the work of a tick; nothing after the stop. `frames`: by sensor and number.
  virtual std::optional<Tracked> step(Tick tick, std::span<const SearchedFrame> frames) = 0;

  /// The tracks that have not ended, by id, with their states at `time`.
  virtual std::vector<CueTarget> targets(SimTime time) const = 0;
};

}  // namespace dmise
