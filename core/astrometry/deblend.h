#pragma once
#include <functional>
#include <vector>

#include "core/detection/pixels/components.h"

namespace dmise {

/// Splits a component at the saddles between its peaks, by the values (x, y) of its pixels. Both
/// peaks must reach 1.5 times the saddle's value and rise by `min_rise` over it. Each part holds
/// what is above the highest saddle around it, at least 3 pixels. What does not split is returned
/// as it is.
std::vector<Component> deblend(const Component& component, double min_rise,
                               const std::function<double(int, int)>& value);

}  // namespace dmise
