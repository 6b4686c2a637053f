#include "nodes/gateway/web_server.h"

#include <netinet/tcp.h>

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <map>
#include <thread>

#include "core/base/error.h"
#include "nodes/gateway/connection.h"
#include "nodes/runtime/process/host_port.h"

namespace dmise {
namespace {

constexpr int send_buffer_bytes = 256 << 10;  // of a connection, in the kernel
// Bytes that wait in it to be sent: a slow line is seen to make progress each time these are gone.
using UnsentBytes = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>;
constexpr int unsent_bytes = 16 << 10;

}  // namespace

bool Hub::make_room() {
  if (connections.size() < options.most_connections) return true;
  std::map<std::string, std::size_t> strangers;
  for (const Connection* connection : connections)
    if (const std::string address = connection->stranger(); !address.empty()) ++strangers[address];
  if (strangers.empty()) return false;
  const std::string most = std::ranges::max_element(strangers, {}, [](const auto& entry) {
                             return entry.second;
                           })->first;
  Connection* oldest = *std::ranges::find_if(
      connections, [&](const Connection* connection) { return connection->stranger() == most; });
  remove(oldest);
  oldest->close();
  return true;
}

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
      if (hub.make_room()) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        socket.set_option(boost::asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
        socket.set_option(UnsentBytes(unsent_bytes), ignored);
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
