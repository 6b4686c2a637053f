#pragma once
#include <cstddef>
#include <memory>
#include <string>

#include "sensors/observatory/observatory.h"

namespace dmise {

/// The port of INDI's servers.
inline constexpr int indi_port = 7624;

struct IndiServerOptions {
  std::string host = "127.0.0.1";
  unsigned short port = 0;  // 0: any free port

  // Limits.
  std::size_t max_connections = 32;
  double request_within_s = 10.0;              // the first of a connection
  double progress_within_s = 30.0;             // while a client is sent something
  std::size_t max_waiting_bytes = 64 << 20;    // for one client, before more is added
  std::size_t max_unanswered_bytes = 1 << 20;  // then its requests wait
  double between_looks_s = 0.1;                // at what has changed
};

/// Serves the devices of an observatory by the INDI protocol, version 1.7, from one thread. INDI
/// knows no passwords: it is there for this machine alone.
class IndiServer {
 public:
  /// Binds. Throws `ConfigError` for an address that is not loopback, `Error` if it cannot be
  /// bound.
  explicit IndiServer(const IndiServerOptions& options);
  ~IndiServer();
  IndiServer(const IndiServer&) = delete;
  IndiServer& operator=(const IndiServer&) = delete;

  /// Begins to answer. `observatory` must outlive the server.
  void serve(Observatory& observatory);
  int port() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace dmise
