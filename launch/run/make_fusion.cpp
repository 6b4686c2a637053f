#include "launch/run/make_fusion.h"

#include <utility>

#include "nodes/fusion/fusion_evaluator.h"
#include "nodes/fusion/recorded_tracker.h"

namespace dmise {

std::unique_ptr<Participant> make_fusion(const Scenario& scenario, const Clock& clock,
                                         const std::string& directory,
                                         const OwnNodeSettings& settings,
                                         const std::shared_ptr<Tracker>& recorded) {
  auto fusion = std::make_unique<FusionEvaluator>(scenario, clock, directory, settings);
  if (recorded) fusion->replay(recorded);
  return fusion;
}

std::shared_ptr<Tracker> make_recorded_tracker(const Scenario& scenario, const std::string& digest,
                                               const std::string& path) {
  return std::make_shared<RecordedTracker>(scenario, digest, path);
}

}  // namespace dmise
