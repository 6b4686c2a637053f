#pragma once
#include <memory>
#include <string>

#include "nodes/runtime/observability/figures.h"
#include "nodes/runtime/observability/status.h"

namespace dmise {

class MetricsServer;

struct MetricsAddress {
  std::string host = "127.0.0.1";
  int port = 0;  // 0: any free one
};

/// Reads "auto", "PORT" or "HOST:PORT". Throws `ConfigError`.
MetricsAddress metrics_address(const std::string& text);

/// The figures of this process, served at /metrics over HTTP in Prometheus's text format from a
/// thread of their own. The process tells its figures as they change; a scrape takes the last.
class Metrics {
 public:
  /// `where`: see metrics_address. Throws `ConfigError`, or `Error` when the port is taken.
  Metrics(const std::string& where, const std::string& program, const std::string& node);
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// Those of this process; null when it serves none: the usual case, which costs this look.
  static Metrics* of_process();

  const std::string& url() const { return url_; }

  void tell(const NodeFigures& figures);
  void tell(const BrokerFigures& figures);
  /// What the time-master knows.
  void tell(const RunStatus& status);

 private:
  struct Board;
  std::shared_ptr<Board> board_;
  std::unique_ptr<MetricsServer> server_;
  std::string url_;
};

}  // namespace dmise
