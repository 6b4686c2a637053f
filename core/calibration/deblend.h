#pragma once
#include <functional>
#include <vector>

#include "core/detection/components.h"

namespace dmise {

/// What makes a peak within a component a source of its own.
struct DeblendSettings {
  double factor = 1.5;      // of the saddle's value that both peaks must reach
  double least_rise = 0.0;  // over the saddle
};

/// Splits a component at the saddles between its peaks, by the values (x, y) of its pixels. Each
/// part holds what is above the highest saddle around it, at least 3 pixels. What does not split is
/// returned as it is.
std::vector<Component> deblend(const Component& component, const DeblendSettings& settings,
                               const std::function<double(int, int)>& value);

}  // namespace dmise
