#pragma once
#include <functional>
#include <memory>
#include <string>

#include "nodes/gateway/latest_messages.h"
#include "nodes/gateway/preview_source.h"
#include "nodes/gateway/request_rules.h"
#include "nodes/gateway/static_files.h"
#include "nodes/gateway/view_history.h"
#include "nodes/gateway/viewer_command.h"

namespace dmise {

struct WebServerOptions {
  std::string host = "127.0.0.1";
  unsigned short port = 0;  // 0: any free port
  AccessTokens tokens;
  bool may_control = false;  // the clock, with the operator's token if there are tokens
  bool shows_truth = false;  // to viewers who may see it

  // Limits.
  std::size_t max_connections = 64;
  std::size_t max_commands_per_s = 20;  // from one viewer
  double request_within_s = 10.0;       // the head of a request, and reading its answer
  double idle_s = 30.0;                 // silence of a viewer that does not answer pings
};

/// What the server shows.
struct WebContent {
  const StaticFiles& files;
  const LatestMessages& latest;
  const ViewHistory& history;
  PreviewSource& previews;
  std::function<bool(const ClockCommand&)> control;  // false: busy
};

/// Serves the dashboard over HTTP/1.1 and its data over a WebSocket, from one thread. Each viewer
/// is sent one message at a time, the newest of each kind in turn, so that a slow viewer gets fewer
/// and nothing is queued.
class WebServer {
 public:
  /// Binds. Throws `ConfigError` for an address that is not loopback without tokens, `Error` if it
  /// cannot be bound.
  WebServer(WebServerOptions options, WebContent content);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  /// Tells viewers that there are new messages; from any thread.
  void changed();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace dmise
