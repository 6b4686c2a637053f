#pragma once
#include <map>
#include <string>

#include "core/plan/cost_factors.h"

namespace dmise {

/// Predicted and measured seconds of one stage of a frame.
struct StageTime {
  double predicted_s = 0.0, measured_s = 0.0;
};

/// The effect by whose name the cost of `effect` is compared with a frame's time: parts of the sky
/// are in `sky`, places of stars in `stars`, wavelengths in `psf`, all draws for each pixel in
/// `photon_noise`.
std::string_view stage_of(std::string_view effect);

/// Adds up what a plan predicts for this machine and what was measured, by stage.
std::map<std::string, StageTime> stage_times(const EffectPlan& plan, const EffectTimes& measured,
                                             const CostFactors& factors);

}  // namespace dmise
