#pragma once
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <list>
#include <string>

namespace dmise {

/// The port of Alpaca's discovery.
inline constexpr int alpaca_discovery_port = 32227;

/// Answers clients that ask by broadcast which port a server has. On loopback it hears this machine
/// alone.
class Discovery {
 public:
  /// Throws `Error` if the port cannot be bound.
  Discovery(boost::asio::io_context& io, const std::string& host, int port, int server_port);
  Discovery(const Discovery&) = delete;
  Discovery& operator=(const Discovery&) = delete;

 private:
  struct Ear {
    explicit Ear(boost::asio::io_context& io) : socket(io) {}
    boost::asio::ip::udp::socket socket;
    boost::asio::ip::udp::endpoint client;
    std::array<char, 64> heard{};
  };
  void hear(Ear& ear);

  std::string answer_;
  std::list<Ear> ears_;
};

/// Whether a datagram asks for servers.
bool asks_for_alpaca(std::string_view datagram);

}  // namespace dmise
