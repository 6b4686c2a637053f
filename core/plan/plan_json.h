#pragma once
#include "core/base/json.h"
#include "core/plan/planner.h"

namespace dmise {

/// Appends a plan as an object: budget and error by kind, cost [s] predicted and the bound below
/// which no plan within the budget can be, and each effect with its level, error and cost.
void write_plan(JsonWriter& json, const EffectPlan& plan);

}  // namespace dmise
