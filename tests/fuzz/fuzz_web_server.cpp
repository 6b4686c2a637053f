// What comes over a connection to the live view's server: bytes of HTTP, and after a handshake
// those of a WebSocket. Each connection ends, with an answer of HTTP or without one; a request
// after it is answered.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <string>
#include <string_view>

#include "nodes/gateway/web_server.h"

namespace {

using namespace dmise;

void require(bool holds) {
  if (!holds) __builtin_trap();
}

struct NoPreviews : PreviewSource {
  void request(const std::string& sensor, std::uint32_t frame, Answer answer) override {
    require(!sensor.empty() && frame > 0);
    answer(nullptr);
  }
};

struct Site {
  Site()
      : files(""),
        server(options(), {files, latest, history, previews, [](const auto&) { return true; }}) {
    latest.set(MessageSlot::status, {"{}"});
    history.add({1.0, {latest.of(MessageSlot::status)}});
  }
  static WebServerOptions options() { return {.may_control = true, .max_commands_per_s = 1000}; }

  StaticFiles files;
  LatestMessages latest;
  ViewHistory history;
  NoPreviews previews;
  WebServer server;
};

/// Sends bytes, and reads until the server closes the connection. Null: this machine has no port
/// left, for those of connections that the server closed stay used for a minute.
std::optional<std::string> ask(int port, std::string_view bytes) {
  const int client = socket(AF_INET, SOCK_STREAM, 0);
  require(client >= 0);
  const timeval patience{.tv_sec = 60, .tv_usec = 0};
  setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  const linger reset{.l_onoff = 1, .l_linger = 0};  // no port is left in TIME_WAIT
  setsockopt(client, SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(client);
    return std::nullopt;
  }
  std::string answer;
  if (send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0) shutdown(client, SHUT_WR);
  char part[4096];
  ssize_t read = 0;
  while ((read = recv(client, part, sizeof part, 0)) > 0) answer.append(part, std::size_t(read));
  require(read == 0 || errno != EAGAIN);  // the server has left it open
  close(client);
  return answer;
}

constexpr std::string_view handshake =
    "GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Site site;
  if (size == 0 || size > 20'000) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::string bytes(data[0] % 2 ? handshake : "");
  bytes += text;
  const auto answer = ask(site.server.port(), bytes);
  if (!answer) return 0;
  require(answer->empty() || answer->starts_with("HTTP/1.1 "));
  // While it still closes connections it may turn one away.
  for (int attempt = 0; attempt < 5; ++attempt) {
    const auto again = ask(site.server.port(), "GET / HTTP/1.0\r\nHost: localhost\r\n\r\n");
    if (!again || again->starts_with("HTTP/1.1 200")) return 0;
  }
  require(false);
  return 0;
}
