#include "sensors/alpaca/discovery.h"

#include <boost/asio/buffer.hpp>
#include <string_view>

#include "core/base/error.h"

namespace dmise {

using boost::asio::ip::udp;
using ErrorCode = boost::system::error_code;

bool asks_for_alpaca(std::string_view datagram) { return datagram.starts_with("alpacadiscovery1"); }

Discovery::Discovery(boost::asio::io_context& io, const std::string& host, int port,
                     int server_port)
    : answer_("{\"AlpacaPort\":" + std::to_string(server_port) + "}") {
  const auto address = boost::asio::ip::make_address(host);
  std::vector<std::string> places{address.is_v6() ? "::" : "0.0.0.0"};
  if (address.is_loopback())
    places = address.is_v6() ? std::vector<std::string>{"::1"}
                             : std::vector<std::string>{"127.0.0.1", "127.255.255.255"};
  for (const std::string& place : places) {
    Ear& ear = ears_.emplace_back(io);
    const udp::endpoint endpoint(boost::asio::ip::make_address(place), std::uint16_t(port));
    ErrorCode error;
    ear.socket.open(endpoint.protocol(), error);
    if (!error) ear.socket.set_option(udp::socket::reuse_address(true), error);
    if (!error) ear.socket.bind(endpoint, error);
    if (error)
      throw Error("UDP port " + std::to_string(port) + " of " + place + ": " + error.message());
    hear(ear);
  }
}

void Discovery::hear(Ear& ear) {
  ear.socket.async_receive_from(
      boost::asio::buffer(ear.heard), ear.client, [this, &ear](ErrorCode error, std::size_t size) {
        if (error == boost::asio::error::operation_aborted) return;
        if (!error && asks_for_alpaca({ear.heard.data(), size})) {
          ErrorCode ignored;
          ear.socket.send_to(boost::asio::buffer(answer_), ear.client, 0, ignored);
        }
        hear(ear);
      });
}

}  // namespace dmise
