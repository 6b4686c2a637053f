#include "sensors/indi/indi_server.h"

#include <boost/asio/steady_timer.hpp>
#include <optional>
#include <utility>

#include "nodes/web/listener.h"
#include "sensors/indi/indi_connection.h"

namespace dmise {

struct IndiServer::Work {
  explicit Work(const IndiServerOptions& asked)
      : options(asked),
        listener({.host = options.host,
                  .port = options.port,
                  .strangers_need = "INDI knows no passwords and is for this machine alone; "
                                    "others come by ssh -L",
                  .max_connections = options.max_connections},
                 connections) {}
  ~Work() { listener.stop(); }

  /// Tells clients what has changed, now and again and again.
  void look_again() {
    timer.expires_after(milliseconds_of(options.between_looks_s));
    timer.async_wait([this](error_code error) {
      if (error) return;
      hub->tell_changes();
      look_again();
    });
  }

  const IndiServerOptions options;
  Connections connections;     // they end with `listener`,
  std::optional<IndiHub> hub;  // which these outlive
  Listener listener;
  boost::asio::steady_timer timer{listener.io()};
};

IndiServer::IndiServer(const IndiServerOptions& options) : work_(std::make_unique<Work>(options)) {}

IndiServer::~IndiServer() = default;

void IndiServer::serve(Observatory& observatory) {
  Work& work = *work_;
  work.hub.emplace(IndiHub{work.options, work.connections, observatory, IndiDevices(observatory)});
  work.look_again();
  work.listener.start(
      [&hub = *work.hub](tcp::socket socket) { serve_indi(hub, std::move(socket)); });
}

int IndiServer::port() const { return work_->listener.port(); }

}  // namespace dmise
