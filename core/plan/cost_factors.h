#pragma once
#include <map>
#include <string>

#include "core/plan/planner.h"

namespace dmise {

/// By how much effects cost more on this machine than by the shipped table, by name. They change
/// predicted seconds, never a plan.
using CostFactors = std::map<std::string, double, std::less<>>;

/// Where `dmise bench calibrate` keeps them, in the user's cache; empty if there is none.
std::string cost_factors_path();

/// Reads a file of lines `NAME FACTOR`; nothing where there is none. Throws `ConfigError`
/// "PATH:LINE: reason" for another line.
CostFactors load_cost_factors(const std::string& path);
std::string cost_factors_text(const CostFactors& factors);

/// Returns the seconds that an effect of a plan is predicted to take here.
double predicted_s(const PlannedEffect& effect, const CostFactors& factors);
/// The same of a frame.
double predicted_s(const EffectPlan& plan, const CostFactors& factors);

}  // namespace dmise
