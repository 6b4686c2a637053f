#pragma once
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <string>
#include <thread>

#include "nodes/web/connection.h"

namespace dmise {

struct ListenOptions {
  std::string host = "127.0.0.1";
  unsigned short port = 0;  // 0: any free port
  bool has_tokens = false;
  const char* strangers_need = "needs a file of tokens";  // at addresses other than loopback
  std::size_t max_connections = 64;
};

/// Accepts the connections of a server, and runs them in one thread.
class Listener {
 public:
  /// Binds. Throws `ConfigError` for an address that is not loopback without tokens, `Error` if it
  /// cannot be bound. `connections` must outlive it.
  Listener(const ListenOptions& options, Connections& connections);
  ~Listener() { stop(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Starts the thread; in it `serve` gets each new connection.
  void start(std::function<void(tcp::socket)> serve);
  /// Ends the thread: nothing runs any more.
  void stop();
  int port() const { return port_; }
  boost::asio::io_context& io() { return io_; }

 private:
  void accept();

  ListenOptions options_;
  Connections& connections_;
  boost::asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  boost::asio::steady_timer retry_{io_};
  std::function<void(tcp::socket)> serve_;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace dmise
