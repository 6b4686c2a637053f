#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

// What the connections of servers share. Boost.Beast is slow to compile: only files of
// connections include this.
namespace dmise {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;
using tcp = boost::asio::ip::tcp;

class Connections;

/// A client, which is among the connections of its server as long as it is there.
class Connection {
 public:
  explicit Connection(Connections& all);
  virtual ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Called when there may be new messages.
  virtual void pump() {}
  /// The client's address while it has not yet asked for anything with access to it; else "".
  virtual std::string stranger() const { return {}; }
  virtual void close() {}

 private:
  Connections& all_;
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

/// The connections of a server, the oldest first; used on its thread only.
class Connections {
 public:
  void add(Connection* connection) { all_.push_back(connection); }
  void remove(Connection* connection) { std::erase(all_, connection); }
  const std::vector<Connection*>& all() const { return all_; }
  /// Whether there is a place for another connection, of `most`. When all are taken, the oldest
  /// stranger of the address with the most loses its own.
  bool make_room(std::size_t most);

 private:
  std::vector<Connection*> all_;
};

inline Connection::Connection(Connections& all) : all_(all) { all_.add(this); }
inline Connection::~Connection() { all_.remove(this); }

/// A connection over a socket of its own.
class SocketConnection : public Connection {
 public:
  SocketConnection(Connections& all, tcp::socket socket)
      : Connection(all), stream_(std::move(socket)) {
    error_code ignored;
    address_ = stream_.socket().remote_endpoint(ignored).address().to_string();
  }
  std::string stranger() const override { return has_access() ? "" : address_; }
  void close() override { stream_.close(); }

 protected:
  virtual bool has_access() const = 0;

  beast::tcp_stream stream_;

 private:
  std::string address_;  // where the client is
};

inline std::chrono::milliseconds milliseconds_of(double seconds) {
  return std::chrono::milliseconds(std::int64_t(seconds * 1e3));
}
inline std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace dmise
