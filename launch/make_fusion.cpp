#include "launch/make_fusion.h"

#include <utility>

#include "nodes/fusion/fusion_evaluator.h"

namespace dmise {

std::unique_ptr<Participant> make_fusion(const Scenario& scenario, const Clock& clock,
                                         const std::string& directory,
                                         const OwnNodeSettings& settings) {
  return std::make_unique<FusionEvaluator>(scenario, clock, directory, settings);
}

}  // namespace dmise
