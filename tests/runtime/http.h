#pragma once
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace dmise::test {

/// The answer to GET http://127.0.0.1:PORT/PATH, its head included; "" when there is none within
/// the time.
inline std::string http_get(int port, const std::string& path, int within_ms = 10'000) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    const std::string request =
        "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    send(fd, request.data(), request.size(), MSG_NOSIGNAL);
    char buffer[4096];
    pollfd readable{fd, POLLIN, 0};
    while (poll(&readable, 1, within_ms) == 1) {
      const ssize_t size = read(fd, buffer, sizeof buffer);
      if (size <= 0) break;
      answer.append(buffer, std::size_t(size));
    }
  }
  close(fd);
  return answer;
}

}  // namespace dmise::test
