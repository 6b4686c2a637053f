#pragma once
#include "core/base/json.h"
#include "core/plan/cost_factors.h"

namespace dmise {

/// Appends a plan as an object: budget and error by kind, cost [s] predicted and the bound below
/// which no plan within the budget can be, and each effect with its level, and why, error and cost
/// where it has one. `factors`: of the machine for which seconds are predicted; none: the shipped
/// costs.
void write_plan(JsonWriter& json, const EffectPlan& plan, const CostFactors& factors = {});

}  // namespace dmise
