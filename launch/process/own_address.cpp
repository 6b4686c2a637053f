#include "launch/process/own_address.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr std::string_view tcp = "tcp://";

/// End of "HOST" in "tcp://HOST:PORT"; npos for other addresses.
std::size_t end_of_host(const std::string& address) {
  return address.starts_with(tcp) ? address.rfind(':') : std::string::npos;
}

std::string text_of(const in_addr& address) {
  char text[INET_ADDRSTRLEN];
  inet_ntop(AF_INET, &address, text, sizeof text);
  return text;
}

struct Descriptor {
  ~Descriptor() {
    if (number >= 0) close(number);
  }
  int number = -1;
};

}  // namespace

std::string numeric_address(const std::string& address) {
  const auto end = end_of_host(address);
  if (end == std::string::npos || end <= tcp.size()) return address;
  const std::string host = address.substr(tcp.size(), end - tcp.size());
  if (host[0] == '[')
    throw Error(address + ": the network is one of IPv4; give an IPv4 address or a name");
  if (host == "*" || if_nametoindex(host.c_str())) return address;
  const addrinfo ask{.ai_family = AF_INET, .ai_socktype = SOCK_STREAM};
  addrinfo* found = nullptr;
  if (const int code = getaddrinfo(host.c_str(), nullptr, &ask, &found))
    throw Error(address + ": " + gai_strerror(code));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  const auto* first = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
  return std::string(tcp) + text_of(first->sin_addr) + address.substr(end);
}

std::string address_towards(const std::string& peer) {
  const auto end = end_of_host(peer);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(9);  // any: nothing is sent
  const bool numeric =
      end != std::string::npos &&
      inet_pton(AF_INET, peer.substr(tcp.size(), end - tcp.size()).c_str(), &to.sin_addr) == 1;
  if (!numeric) throw Error(peer + ": is not tcp://A.B.C.D:PORT");
  const Descriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  sockaddr_in own{};
  socklen_t size = sizeof own;
  if (connect(socket.number, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0 ||
      getsockname(socket.number, reinterpret_cast<sockaddr*>(&own), &size) != 0)
    throw Error(peer + ": " + std::strerror(errno));
  return std::string(tcp) + text_of(own.sin_addr) + ":0";
}

}  // namespace dmise
