#pragma once
#include <memory>
#include <string>

#include "nodes/web/access.h"
#include "sensors/alpaca/alpaca_devices.h"

namespace dmise {

struct AlpacaServerOptions {
  std::string host = "127.0.0.1";
  unsigned short port = 0;  // 0: any free port
  AccessTokens tokens = {};
  int discovery_port = 0;     // UDP port where clients ask for servers; 0: none hears them
  std::string location = {};  // what the management API says of it
  bool connected = false;     // devices are, before a client connects

  // Limits.
  std::size_t max_connections = 64;
  double request_within_s = 10.0;  // a request, and reading its answer
  double idle_s = 60.0;            // between requests of a connection
  double slew_within_s = 600.0;    // an answer that waits for a slew
};

/// Serves the devices of an observatory by the ASCOM Alpaca API, version 1, over HTTP/1.1, from one
/// thread. Without tokens it is there for this machine alone; with tokens a client needs the
/// operator's to change something: as a password, in the header Authorization or as ?token=.
class AlpacaServer {
 public:
  /// Binds. Throws `ConfigError` for an address that is not loopback without tokens, `Error` if it
  /// cannot be bound.
  explicit AlpacaServer(AlpacaServerOptions options);
  ~AlpacaServer();
  AlpacaServer(const AlpacaServer&) = delete;
  AlpacaServer& operator=(const AlpacaServer&) = delete;

  /// Begins to answer. `observatory` must outlive the server.
  void serve(Observatory& observatory);
  int port() const;
  /// Why clients do not find it by discovery; empty if they do, or were not to.
  const std::string& not_discovered() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace dmise
