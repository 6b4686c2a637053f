#pragma once
#include <functional>
#include <string>
#include <thread>

#include "nodes/runtime/process/event.h"

namespace dmise {

/// Serves one page at /metrics over HTTP/1.1 from a thread of its own. Clients are served
/// concurrently without blocking: each has `client_deadline` from its connection to the last byte
/// of its answer, and with `max_clients` connections the oldest is closed for the next.
class MetricsServer {
 public:
  static constexpr std::chrono::seconds client_deadline{5};
  static constexpr std::size_t max_clients = 64;
  static constexpr std::size_t longest_request = 8192;  // bytes of its head

  /// `page`: called in the server's thread for each request. Throws `Error` with the reason if the
  /// address cannot be bound. `port` 0: any free port.
  MetricsServer(const std::string& host, int port, std::function<std::string()> page);
  ~MetricsServer();
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;

  int port() const { return port_; }

 private:
  void run();

  std::function<std::string()> page_;
  int listener_ = -1;
  int port_ = 0;
  Event quit_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace dmise
