#include "nodes/gateway/web_server.h"

#include <boost/asio/steady_timer.hpp>
#include <thread>

#include "core/base/error.h"
#include "nodes/gateway/connection.h"
#include "nodes/runtime/process/host_port.h"

namespace dmise {
namespace {

constexpr int send_buffer_bytes = 256 << 10;  // of a connection, in the kernel

}  // namespace

struct WebServer::Work {
  Work(WebServerOptions options, WebContent content)
      : hub{std::move(options), std::move(content), std::make_shared<ServerThread>(io)},
        acceptor(io) {
    error_code error;
    const auto address = boost::asio::ip::make_address(hub.options.host, error);
    const std::string where = text_of(HostPort{hub.options.host, hub.options.port});
    if (error) throw ConfigError(where + ": must be an IP address and a port");
    if (!address.is_loopback() && !hub.options.tokens.any())
      throw ConfigError(where + ": not loopback: needs a file of tokens");
    const tcp::endpoint endpoint(address, hub.options.port);
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(128, error);
    if (error) throw Error(where + ": " + error.message());
    port = acceptor.local_endpoint().port();
    accept();
    thread = std::thread([this] { io.run(); });
  }

  ~Work() {
    hub.thread->close();
    io.stop();
    thread.join();
    hub.waiting.clear();
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error == boost::asio::error::operation_aborted) return;
      if (error) {  // no file descriptor is free, say
        retry.expires_after(std::chrono::milliseconds(100));
        return retry.async_wait([this](error_code) { accept(); });
      }
      if (hub.connections.size() < hub.options.most_connections) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        socket.set_option(boost::asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
        serve_http(hub, std::move(socket));
      }  // else it is closed
      accept();
    });
  }

  Hub hub;  // outlives the connections, which end with `io`
  boost::asio::io_context io{1};
  tcp::acceptor acceptor;
  boost::asio::steady_timer retry{io};
  int port = 0;
  std::thread thread;
};

WebServer::WebServer(WebServerOptions options, WebContent content)
    : work_(std::make_unique<Work>(std::move(options), std::move(content))) {}

WebServer::~WebServer() = default;

int WebServer::port() const { return work_->port; }

void WebServer::changed() {
  work_->hub.thread->post([this] {
    for (Connection* connection : work_->hub.connections) connection->pump();
  });
}

}  // namespace dmise
