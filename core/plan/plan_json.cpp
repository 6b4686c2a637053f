#include "core/plan/plan_json.h"

#include <cmath>

namespace dmise {
namespace {

/// Leaves out errors that have no bound.
void write_error(JsonWriter& json, const ErrorBound& error) {
  json.begin_object();
  for (const auto& kind : error_kinds)
    if (std::isfinite(error.*kind.value)) json.field(kind.key, error.*kind.value);
  json.end_object();
}

}  // namespace

void write_plan(JsonWriter& json, const EffectPlan& plan, const CostFactors& factors) {
  json.begin_object();
  write_error(json.key("budget"), plan.budget);
  write_error(json.key("error"), plan.error);
  json.field("predicted_s", predicted_s(plan, factors)).field("least_s", plan.min_cost_s);
  if (!plan.in_time) json.field("in_time", false);
  json.key("effects").begin_object();
  for (const auto& p : plan.planned) {
    json.key(p.facts->name).begin_object().field("level", p.level_name());
    if (p.cost_s > 0.0) json.field("predicted_s", predicted_s(p, factors));
    if (p.decided || p.forced || plan.replayed) json.field("why", why(p, plan));
    if (p.error != ErrorBound{}) write_error(json.key("error"), p.error);
    if (p.decided && p.level > 0) write_error(json.key("error_of_next_lower"), p.cheaper);
    json.end_object();
  }
  json.end_object().end_object();
}

}  // namespace dmise
