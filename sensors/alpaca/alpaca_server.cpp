#include "sensors/alpaca/alpaca_server.h"

#include "nodes/web/listener.h"
#include "sensors/alpaca/alpaca_connection.h"
#include "sensors/alpaca/discovery.h"

namespace dmise {

struct AlpacaServer::Work {
  explicit Work(AlpacaServerOptions asked)
      : options(std::move(asked)),
        listener({.host = options.host,
                  .port = options.port,
                  .has_tokens = options.tokens.any(),
                  .max_connections = options.max_connections},
                 connections) {
    if (options.discovery_port > 0) discover();
  }
  ~Work() { listener.stop(); }

  void discover() {
    try {
      discovery.emplace(listener.io(), options.host, options.discovery_port, listener.port());
    } catch (const Error& error) {
      not_discovered = error.what();
    }
  }

  const AlpacaServerOptions options;
  Connections connections;       // they end with `listener`,
  std::optional<AlpacaHub> hub;  // which these outlive
  Listener listener;
  std::optional<Discovery> discovery;
  std::string not_discovered;
};

AlpacaServer::AlpacaServer(AlpacaServerOptions options)
    : work_(std::make_unique<Work>(std::move(options))) {}

AlpacaServer::~AlpacaServer() = default;

void AlpacaServer::serve(Observatory& observatory) {
  Work& work = *work_;
  work.hub.emplace(AlpacaHub{work.options, work.connections, observatory,
                             AlpacaDevices(observatory, work.options.connected)});
  work.listener.start(
      [&hub = *work.hub](tcp::socket socket) { serve_alpaca(hub, std::move(socket)); });
}

int AlpacaServer::port() const { return work_->listener.port(); }

const std::string& AlpacaServer::not_discovered() const { return work_->not_discovered; }

}  // namespace dmise
