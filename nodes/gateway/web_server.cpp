#include "nodes/gateway/web_server.h"

#include "nodes/gateway/connection.h"
#include "nodes/web/listener.h"

namespace dmise {

struct WebServer::Work {
  Work(WebServerOptions options, WebContent content)
      : hub{std::move(options), std::move(content)},
        listener({.host = hub.options.host,
                  .port = hub.options.port,
                  .has_tokens = hub.options.tokens.any(),
                  .max_connections = hub.options.max_connections},
                 hub.connections) {
    hub.thread = std::make_shared<ServerThread>(listener.io());
    listener.start([this](tcp::socket socket) { serve_http(hub, std::move(socket)); });
  }

  ~Work() {
    hub.thread->close();
    listener.stop();
    hub.waiting.clear();
  }

  Hub hub;  // outlives the connections, which end with `listener`
  Listener listener;
};

WebServer::WebServer(WebServerOptions options, WebContent content)
    : work_(std::make_unique<Work>(std::move(options), std::move(content))) {}

WebServer::~WebServer() = default;

int WebServer::port() const { return work_->listener.port(); }

void WebServer::changed() {
  work_->hub.thread->post([this] {
    for (Connection* connection : work_->hub.connections.all()) connection->pump();
  });
}

}  // namespace dmise
