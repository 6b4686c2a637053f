#pragma once
#include <prometheus/metric_family.h>

#include <string>
#include <vector>

#include "nodes/runtime/observability/figures.h"
#include "nodes/runtime/observability/status.h"

// Values as families of metrics. Names follow Prometheus's conventions: base units at the end of
// the name, and _total for counters. docs/operations.md lists them.
namespace dmise {

using MetricFamilies = std::vector<prometheus::MetricFamily>;

MetricFamilies families_of_build(const std::string& program, const std::string& node);
/// Resource usage of this process. `started_s`: when it started, seconds since 1970.
MetricFamilies families_of_process(double started_s);
/// `node`: name of the process in the run, a label where there may be several of its kind.
MetricFamilies families_of(const NodeFigures& figures, const std::string& node);
MetricFamilies families_of(const FrameFigures& figures, const std::string& node);
MetricFamilies families_of(const BrokerFigures& figures, const std::string& node);
MetricFamilies families_of(const RunStatus& status, const std::string& node);

}  // namespace dmise
