#pragma once
#include "bench/validation/brightness.h"
#include "core/image/charts/chart.h"

namespace dmise {

/// Differences of a family by phase: all held-out points, their median and the range that holds
/// 68 % of them.
Chart difference_chart(const FamilyBrightness& family);

/// The page in Markdown. `pictures`: folder of the charts, relative to the page.
std::string validation_page(const std::vector<FamilyBrightness>& families,
                            const std::string& pictures);

}  // namespace dmise
