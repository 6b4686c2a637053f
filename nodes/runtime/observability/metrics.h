#pragma once
#include <memory>
#include <string>
#include <variant>

#include "nodes/runtime/observability/figures.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/process/host_port.h"

namespace dmise {

class MetricsServer;

/// Values of a process. `RunStatus`, the state of the run, is set by the time-master.
using Figures = std::variant<NodeFigures, FrameFigures, BrokerFigures, RunStatus>;

/// Parses "auto", "PORT", "HOST:PORT" or "[IPv6]:PORT"; the host is 127.0.0.1 where none is given.
/// Throws `ConfigError`.
HostPort metrics_address(const std::string& text);

/// Serves metrics of this process at /metrics over HTTP in Prometheus's text format from a thread
/// of its own. The process sets values as they change; a scrape returns the latest.
class Metrics {
 public:
  /// `where`: see metrics_address. Throws `ConfigError`, or `Error` when the port is taken.
  Metrics(const std::string& where, const std::string& program, const std::string& node);
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// The instance of this process; null if it serves none, the usual case.
  static Metrics* of_process();

  const std::string& url() const { return url_; }

  void set(Figures figures);

 private:
  struct Board;
  std::shared_ptr<Board> board_;
  std::unique_ptr<MetricsServer> server_;
  std::string url_;
};

}  // namespace dmise
