#pragma once
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>

namespace dmise::test {

/// A peer that speaks ZMTP 3.0 (RFC 23) by hand over TCP, without a library that keeps to manners.
class RawPeer {
 public:
  /// `address`: "tcp://127.0.0.1:PORT". `type`: of its socket, "DEALER".
  RawPeer(const std::string& address, const std::string& type)
      : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in there{};
    there.sin_family = AF_INET;
    there.sin_port = htons(std::uint16_t(std::atoi(address.c_str() + address.rfind(':') + 1)));
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(fd_, reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0) return;
    const auto zeros = [](std::size_t count) { return std::string(count, '\0'); };
    say("\xff" + zeros(8) + "\x7f\x03" + zeros(1) + "NULL" + zeros(16 + 32));
    char greeting[64];
    pollfd readable{fd_, POLLIN, 0};
    for (std::size_t heard = 0; heard < sizeof greeting && poll(&readable, 1, 20'000) == 1;) {
      const ssize_t size = read(fd_, greeting, sizeof greeting - heard);
      if (size <= 0) return;
      heard += std::size_t(size);
    }
    const std::string ready =
        "\x05READY" + property("Socket-Type", type) + property("Identity", "");
    say(std::string("\x04") + char(ready.size()) + ready);
  }
  ~RawPeer() { ::close(fd_); }
  RawPeer(const RawPeer&) = delete;
  RawPeer& operator=(const RawPeer&) = delete;

  /// False when the connection is closed, or nobody reads for `within_ms`.
  bool say(const std::string& bytes, int within_ms = 20'000) {
    for (std::size_t said = 0; said < bytes.size();) {
      pollfd writable{fd_, POLLOUT, 0};
      if (poll(&writable, 1, within_ms) != 1) return false;
      const ssize_t size =
          ::send(fd_, bytes.data() + said, bytes.size() - said, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (size < 0 && errno != EAGAIN) return false;
      if (size < 0) continue;
      said += std::size_t(size);
    }
    return true;
  }

  static std::string frame(const std::string& body, bool more) {
    std::string text(1, char((more ? 1 : 0) | (body.size() > 255 ? 2 : 0)));
    if (body.size() <= 255) return text + char(body.size()) + body;
    for (int shift = 56; shift >= 0; shift -= 8) text += char(body.size() >> shift);
    return text + body;
  }

 private:
  static std::string property(const std::string& name, const std::string& value) {
    return char(name.size()) + name + std::string(3, '\0') + char(value.size()) + value;
  }

  int fd_;
};

}  // namespace dmise::test
