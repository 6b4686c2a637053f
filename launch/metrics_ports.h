#pragma once
#include <string>
#include <utility>
#include <vector>

#include "nodes/runtime/observability/metrics.h"

namespace dmise {

/// Where each process of a run serves its figures: one port after the other.
class MetricsPorts {
 public:
  /// `where`: of the first process, as for its --metrics; empty: nobody serves any. Throws
  /// `ConfigError`.
  explicit MetricsPorts(const std::string& where);

  /// The value of --metrics for the next process to start; empty: none. Throws `ConfigError` when
  /// there is no port left.
  std::string next(const std::string& name);

  /// Writes what has been given out for Prometheus's `file_sd_configs`; nothing for "auto", where
  /// the processes choose.
  void write_targets(const std::string& path) const;

 private:
  bool on_ = false;
  MetricsAddress address_;
  std::vector<std::pair<std::string, std::string>> targets_;  // name, HOST:PORT
};

}  // namespace dmise
