#pragma once
#include <string>
#include <vector>

#include "core/image/charts/chart.h"
#include "sensors/accuracy/tradeoff.h"

namespace dmise {

/// Error against time: a line for each effect, with its levels as points.
Chart effects_chart(const std::vector<TradeoffRow>& rows, const ErrorKind& kind);
/// Largest error, in standard budgets, against time of planned frames.
Chart budgets_chart(const std::vector<TradeoffRow>& rows);

/// One page without anything from elsewhere: charts and the table of all rows.
std::string tradeoff_page(const std::string& title, const std::vector<TradeoffRow>& rows);
std::string tradeoff_json(const std::string& digest, const std::vector<TradeoffRow>& rows);

}  // namespace dmise
