#pragma once
#include <map>
#include <string>

#include "core/plan/planner.h"

namespace dmise {

/// Costs of effects on this machine over those of the shipped table, by name. They change predicted
/// seconds, never a plan.
using CostFactors = std::map<std::string, double, std::less<>>;

/// Returns the path at which `dmise bench calibrate` keeps them, in the user's cache; empty if the
/// user has none.
std::string cost_factors_path();

/// Reads a file of lines `NAME FACTOR`; returns nothing if it does not exist. Throws `ConfigError`
/// "PATH:LINE: reason" for any other line.
CostFactors load_cost_factors(const std::string& path);
std::string cost_factors_text(const CostFactors& factors);

/// Returns the seconds that an effect of a plan is predicted to take here.
double predicted_s(const PlannedEffect& effect, const CostFactors& factors);
/// Predicted seconds of a frame.
double predicted_s(const EffectPlan& plan, const CostFactors& factors);

}  // namespace dmise
