#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "nodes/fusion/tracker.h"

namespace dmise {

/// Makes the tracks and gives the tasks that a fusion node has published in a recorded run of the
/// same scenario.
class RecordedTracker : public Tracker {
 public:
  /// `digest`: of the scenario. Throws `ConfigError` "PATH: reason" for a file that is not a whole
  /// recording of the fusion node in a run of this scenario.
  RecordedTracker(const Scenario& scenario, const std::string& digest, const std::string& path);

  std::optional<Tracked> step(Tick tick, std::span<const SearchedFrame> frames) override;
  std::vector<CueTarget> targets(SimTime) const override { return {}; }

 private:
  void add(std::shared_ptr<const State> state);

  std::vector<std::shared_ptr<const State>> tracks_;     // TrackSet, by tick
  std::map<Tick, std::map<std::uint32_t, Task>> tasks_;  // by tick and id
};

}  // namespace dmise
