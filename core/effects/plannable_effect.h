#pragma once
#include <functional>

#include "core/effects/accuracy.h"
#include "core/effects/effects.h"

namespace dmise {

/// An effect of one sensor as the planner sees it.
struct PlannableEffect {
  const EffectFacts* facts = nullptr;
  std::function<ErrorBound(int level, const PlanFacts&)> error{};  // none: it runs as it is asked
  std::function<double(int level, const PlanFacts&)> cost_s{};     // none: it costs nothing
};

}  // namespace dmise
