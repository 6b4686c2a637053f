#pragma once
#include "core/base/files/json.h"
#include "core/plan/cost_factors.h"

namespace dmise {

/// Appends a plan as an object: budget and error by kind, the predicted cost and a lower bound for
/// any plan within the budget [s], and each effect with its level and, where it has them, reason,
/// error and cost. `factors`: of the machine for which seconds are predicted; without them by the
/// shipped table.
void write_plan(JsonWriter& json, const EffectPlan& plan, const CostFactors& factors = {});

}  // namespace dmise
