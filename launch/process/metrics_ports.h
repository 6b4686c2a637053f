#pragma once
#include <string>
#include <utility>
#include <vector>

#include "nodes/runtime/observability/metrics.h"

namespace dmise {

/// Assigns consecutive metrics ports to the processes of a run.
class MetricsPorts {
 public:
  /// `where`: value of --metrics for the first process; empty: none. Throws `ConfigError`.
  explicit MetricsPorts(const std::string& where);

  /// Value of --metrics for the next process; empty: none. Throws `ConfigError` if no port is left.
  std::string next(const std::string& name);

  /// Writes the assigned addresses for Prometheus's `file_sd_configs`; nothing for "auto", where
  /// the processes choose.
  void write_targets(const std::string& path) const;

 private:
  bool on_ = false;
  HostPort address_;
  std::vector<std::pair<std::string, std::string>> targets_;  // name, HOST:PORT
};

}  // namespace dmise
