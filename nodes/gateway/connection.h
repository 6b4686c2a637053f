#pragma once
#include <functional>
#include <map>
#include <memory>

#include "nodes/gateway/web_server.h"
#include "nodes/web/connection.h"

namespace dmise {

/// State of the server, used on its thread only.
struct Hub {
  WebServerOptions options;
  WebContent content;
  std::shared_ptr<ServerThread> thread = nullptr;
  Connections connections = {};
  // Callbacks of connections that wait for a preview, by ticket. The thread that draws previews has
  // the ticket only, so that connections stay on this thread.
  std::map<std::uint64_t, std::function<void(SharedPreview)>> waiting = {};
  std::uint64_t last_ticket = 0;
};

/// Starts to answer HTTP requests that arrive over a socket.
void serve_http(Hub& hub, tcp::socket socket);

/// Accepts the WebSocket that `request` asks for, and sends messages to the viewer.
void serve_viewer(Hub& hub, beast::tcp_stream stream,
                  const http::request<http::empty_body>& request, Access access);

}  // namespace dmise
