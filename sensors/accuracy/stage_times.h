#pragma once
#include <map>
#include <string>

#include "core/plan/cost_factors.h"

namespace dmise {

/// Predicted and measured seconds of one stage of a frame.
struct StageTime {
  double predicted_s = 0.0, measured_s = 0.0;
};

/// The effect by whose name a frame's time shows the cost of `effect`: parts of the sky in `sky`,
/// places of stars in `stars`, wavelengths in `psf`.
std::string_view timed_as(std::string_view effect, const EffectTimes& measured);

/// Adds up what a plan predicts for this machine and what was measured, by the names of `measured`.
std::map<std::string, StageTime> stage_times(const EffectPlan& plan, const EffectTimes& measured,
                                             const CostFactors& factors);

}  // namespace dmise
