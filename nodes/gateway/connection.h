#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/gateway/web_server.h"

// What the connections of the web server share. Boost.Beast is slow to compile: only files of
// connections include this.
namespace dmise {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;
using tcp = boost::asio::ip::tcp;

class Connection {
 public:
  virtual ~Connection() = default;
  /// Called when there may be new messages.
  virtual void pump() {}
  /// The client's address while it has not yet asked for anything with access to it; else "".
  virtual std::string stranger() const { return {}; }
  virtual void close() {}
};

/// Passes work from any thread to the server's thread, as long as there is a server.
class ServerThread {
 public:
  explicit ServerThread(boost::asio::io_context& io) : io_(&io) {}

  template <class Work>
  void post(Work work) {
    const std::lock_guard lock(mutex_);
    if (io_) boost::asio::post(*io_, std::move(work));
  }
  void close() {
    const std::lock_guard lock(mutex_);
    io_ = nullptr;
  }

 private:
  std::mutex mutex_;
  boost::asio::io_context* io_;
};

/// State of the server, used on its thread only.
struct Hub {
  WebServerOptions options;
  WebContent content;
  std::shared_ptr<ServerThread> thread;
  std::vector<Connection*> connections;  // the oldest first
  // Callbacks of connections that wait for a preview, by ticket. The thread that draws previews has
  // the ticket only, so that connections stay on this thread.
  std::map<std::uint64_t, std::function<void(SharedPreview)>> waiting;
  std::uint64_t last_ticket = 0;

  void add(Connection* connection) { connections.push_back(connection); }
  void remove(Connection* connection) { std::erase(connections, connection); }
  /// Whether there is a place for another connection. When all are taken, the oldest stranger of
  /// the address with the most loses its own.
  bool make_room();
};

inline std::chrono::milliseconds milliseconds_of(double seconds) {
  return std::chrono::milliseconds(std::int64_t(seconds * 1e3));
}
inline std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

/// Starts to answer HTTP requests that arrive over a socket.
void serve_http(Hub& hub, tcp::socket socket);

/// Accepts the WebSocket that `request` asks for, and sends messages to the viewer.
void serve_viewer(Hub& hub, beast::tcp_stream stream,
                  const http::request<http::empty_body>& request, Access access);

}  // namespace dmise
