#include "nodes/web/listener.h"

#include <netinet/tcp.h>

#include <algorithm>
#include <map>

#include "core/base/error.h"
#include "nodes/runtime/process/host_port.h"

namespace dmise {
namespace {

constexpr int send_buffer_bytes = 256 << 10;  // queue of a connection in the kernel
// Bytes that wait in it to be sent: a slow line is seen to make progress each time these are gone.
using UnsentBytes = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>;
constexpr int unsent_bytes = 16 << 10;

}  // namespace

bool Connections::make_room(std::size_t most_allowed) {
  if (all_.size() < most_allowed) return true;
  std::map<std::string, std::size_t> strangers;
  for (const Connection* connection : all_)
    if (const std::string address = connection->stranger(); !address.empty()) ++strangers[address];
  if (strangers.empty()) return false;
  const std::string most = std::ranges::max_element(strangers, {}, [](const auto& entry) {
                             return entry.second;
                           })->first;
  Connection* oldest = *std::ranges::find_if(
      all_, [&](const Connection* connection) { return connection->stranger() == most; });
  remove(oldest);
  oldest->close();
  return true;
}

Listener::Listener(const ListenOptions& options, Connections& connections)
    : options_(options), connections_(connections) {
  error_code error;
  const auto address = boost::asio::ip::make_address(options_.host, error);
  const std::string where = text_of(HostPort{options_.host, options_.port});
  if (error) throw ConfigError(where + ": must be an IP address and a port");
  if (!address.is_loopback() && !options_.has_tokens)
    throw ConfigError(where + ": not loopback: " + options_.strangers_need);
  const tcp::endpoint endpoint(address, options_.port);
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(128, error);
  if (error) throw Error(where + ": " + error.message());
  port_ = acceptor_.local_endpoint().port();
}

void Listener::start(std::function<void(tcp::socket)> serve) {
  serve_ = std::move(serve);
  accept();
  thread_ = std::thread([this] { io_.run(); });
}

void Listener::stop() {
  io_.stop();
  if (thread_.joinable()) thread_.join();
}

void Listener::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error == boost::asio::error::operation_aborted) return;
    if (error) {  // no file descriptor is free, say
      retry_.expires_after(std::chrono::milliseconds(100));
      return retry_.async_wait([this](error_code) { accept(); });
    }
    if (connections_.make_room(options_.max_connections)) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      socket.set_option(boost::asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
      socket.set_option(UnsentBytes(unsent_bytes), ignored);
      serve_(std::move(socket));
    }  // else it is closed
    accept();
  });
}

}  // namespace dmise
