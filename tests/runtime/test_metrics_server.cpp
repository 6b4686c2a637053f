// The page of metrics under clients that are slow, many, or ask for too much.
#include "nodes/runtime/observability/metrics_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "core/base/error.h"
#include "tests/runtime/http.h"

namespace dmise {
namespace {

using test::http_get;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

/// A connection that says `text` and then nothing.
struct SlowClient {
  SlowClient(int port, const std::string& text)
      : fd(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected = connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::send(fd, text.data(), text.size(), MSG_NOSIGNAL);
  }
  ~SlowClient() { close(fd); }
  SlowClient(const SlowClient&) = delete;
  SlowClient& operator=(const SlowClient&) = delete;
  /// What comes until the server closes the connection, if it does within the time.
  std::optional<std::string> answer(int within_ms) {
    std::string text;
    char buffer[4096];
    pollfd readable{fd, POLLIN, 0};
    while (poll(&readable, 1, within_ms) == 1) {
      const ssize_t size = read(fd, buffer, sizeof buffer);
      if (size <= 0) return text;
      text.append(buffer, std::size_t(size));
    }
    return std::nullopt;
  }
  int fd;
  bool connected = false;
};

std::string page() { return "figures 1\n"; }

TEST(MetricsServer, ServesItsPageAndNothingElse) {
  MetricsServer server("127.0.0.1", 0, page);
  const std::string answer = http_get(server.port(), "/metrics");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(answer, HasSubstr("Content-Type: text/plain; version=0.0.4"));
  EXPECT_THAT(answer, EndsWith("\r\n\r\nfigures 1\n"));
  EXPECT_THAT(http_get(server.port(), "/metrics?name=x"), StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(http_get(server.port(), "/"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(http_get(server.port(), "/metricsx"), StartsWith("HTTP/1.1 404 "));
  SlowClient post(server.port(), "POST /metrics HTTP/1.1\r\n\r\n");
  EXPECT_THAT(post.answer(10'000).value_or(""), StartsWith("HTTP/1.1 405 "));
}

TEST(MetricsServer, SaysWhyNobodyCanListen) {
  MetricsServer first("127.0.0.1", 0, page);
  EXPECT_THROW(MetricsServer("127.0.0.1", first.port(), page), Error);
  EXPECT_THROW(MetricsServer("192.0.2.1", 0, page), Error);  // RFC 5737: nobody's address
}

// Slow clients have 5 s each; who asks behind them is answered at once.
TEST(MetricsServer, AnswersWhileOthersAreSlow) {
  MetricsServer server("127.0.0.1", 0, page);
  std::vector<std::unique_ptr<SlowClient>> slow;
  for (int i = 0; i < 32; ++i)
    slow.push_back(std::make_unique<SlowClient>(server.port(), "GET /metr"));
  EXPECT_THAT(http_get(server.port(), "/metrics", 4000), HasSubstr("figures 1"));
  for (const auto& client : slow) EXPECT_TRUE(client->connected);
}

TEST(MetricsServer, ClosesTheOldestWhenThereAreTooMany) {
  MetricsServer server("127.0.0.1", 0, page);
  std::vector<std::unique_ptr<SlowClient>> slow;
  for (int i = 0; i < 200; ++i) slow.push_back(std::make_unique<SlowClient>(server.port(), "GET"));
  EXPECT_THAT(http_get(server.port(), "/metrics", 4000), HasSubstr("figures 1"));
  EXPECT_EQ(slow.front()->answer(4000), "");
}

TEST(MetricsServer, ClosesAClientThatDoesNotComeToAnEnd) {
  MetricsServer server("127.0.0.1", 0, page);
  SlowClient slow(server.port(), "GET /metrics HTTP/1.1\r\nX: ");
  EXPECT_EQ(slow.answer(60'000), "");
}

TEST(MetricsServer, RefusesARequestWithoutEnd) {
  MetricsServer server("127.0.0.1", 0, page);
  SlowClient endless(server.port(), "GET /metrics HTTP/1.1\r\nX: " + std::string(8300, 'x'));
  EXPECT_THAT(endless.answer(10'000).value_or(""), StartsWith("HTTP/1.1 431 "));
}

}  // namespace
}  // namespace dmise
