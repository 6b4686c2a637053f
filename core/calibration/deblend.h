#pragma once
#include <functional>
#include <vector>

#include "core/detection/components.h"

namespace dmise {

/// Splits a component into those parts that stay apart when the threshold rises by steps of
/// `factor`, each of at least 3 pixels: `value(x, y)` of its pixels are above 0. What does not
/// split is returned as it is.
std::vector<Component> deblend(const Component& component, double factor,
                               const std::function<double(int, int)>& value);

}  // namespace dmise
