// The door of an observatory: HTTP, its envelopes, images as bytes, tokens, discovery.
#include "sensors/alpaca/alpaca_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cstring>

#include "core/base/error.h"
#include "sensors/alpaca/alpaca_answer.h"
#include "sensors/alpaca/discovery.h"
#include "tests/observatory/served_observatory.h"

namespace dmise {
namespace {

using boost::asio::ip::tcp;
using boost::asio::ip::udp;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string watcher(16, 'v'), commander(16, 'o');

struct Door : ServedObservatory {
  explicit Door(const std::string& name, AlpacaServerOptions options = {})
      : ServedObservatory(testing::TempDir() + "/" + name, std::make_shared<WallClock>(100.0)),
        server(std::move(options)) {
    server.serve(observatory);
  }

  std::string ask(const std::string& bytes) const {
    boost::asio::io_context io;
    tcp::socket socket(io);
    socket.connect({boost::asio::ip::address_v4::loopback(), std::uint16_t(server.port())});
    boost::system::error_code error;
    boost::asio::write(socket, boost::asio::buffer(bytes), error);
    std::string answer;
    boost::asio::read(socket, boost::asio::dynamic_buffer(answer), error);
    return answer;
  }
  std::string get(const std::string& target, const std::string& headers = "",
                  const std::string& host = "localhost") const {
    return ask("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n" +
               headers + "\r\n");
  }
  std::string put(const std::string& target, const std::string& form,
                  const std::string& headers = "") const {
    return ask("PUT " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + headers +
               "Content-Type: application/x-www-form-urlencoded\r\nContent-Length: " +
               std::to_string(form.size()) + "\r\n\r\n" + form);
  }

  AlpacaServer server;
};

TEST(AlpacaServer, AnswersWithTransactionsAndErrors) {
  const Door door("alpaca-door");
  const std::string refused = door.get("/api/v1/camera/0/gain?ClientTransactionID=9");
  EXPECT_THAT(refused, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(refused, HasSubstr("\"ErrorNumber\":1031"));
  EXPECT_THAT(refused, HasSubstr("\"ClientTransactionID\":9,\"ServerTransactionID\":1,"));
  EXPECT_THAT(door.put("/api/v1/camera/0/connected", "Connected=True&ClientTransactionID=3"),
              HasSubstr("{\"ClientTransactionID\":3,\"ServerTransactionID\":2,\"ErrorNumber\":0,"
                        "\"ErrorMessage\":\"\"}"));
  EXPECT_THAT(door.get("/api/v1/camera/0/gain"), HasSubstr("{\"Value\":0,"));
  EXPECT_THAT(door.get("/api/v1/camera/0/nosuchmember"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(door.get("/nowhere"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(door.ask("POST / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"),
              StartsWith("HTTP/1.1 405"));
}

TEST(AlpacaServer, IsManagedAndHasAPage) {
  const Door door("alpaca-managed", {.location = "a <hill>"});
  EXPECT_THAT(door.get("/management/apiversions"), HasSubstr("{\"Value\":[1],"));
  EXPECT_THAT(door.get("/management/v1/description"), HasSubstr("\"Location\":\"a <hill>\""));
  const std::string devices = door.get("/management/v1/configureddevices");
  EXPECT_THAT(devices, HasSubstr("\"DeviceType\":\"Telescope\",\"DeviceNumber\":0"));
  EXPECT_THAT(devices, HasSubstr("\"DeviceType\":\"Camera\",\"DeviceNumber\":0"));
  EXPECT_THAT(door.get("/setup"), HasSubstr("a &lt;hill&gt;"));
}

TEST(AlpacaServer, SaysThatABodyIsWanted) {
  const Door door("alpaca-expect");
  EXPECT_THAT(door.put("/api/v1/camera/0/connected", "Connected=true", "Expect: 100-continue\r\n"),
              testing::AllOf(StartsWith("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 200"),
                             HasSubstr("\"ErrorNumber\":0")));
}

// A site of another could have its visitors' browsers ask this machine.
TEST(AlpacaServer, AnswersOnlyThisMachineAndNoForeignPage) {
  const Door door("alpaca-foreign");
  EXPECT_THAT(door.get("/setup", "", "evil.example"), StartsWith("HTTP/1.1 421"));
  EXPECT_THAT(door.get("/setup", "Origin: http://evil.example\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THROW(AlpacaServer({.host = "0.0.0.0"}), ConfigError);
  EXPECT_NO_THROW(AlpacaServer({.host = "0.0.0.0", .tokens = {.control = commander}}));
}

// base64 of "alpaca:" and the token.
TEST(AlpacaServer, OnlyTheOperatorsTokenChangesSomething) {
  const Door door("alpaca-tokens", {.tokens = {.view = watcher, .control = commander}});
  const std::string member = "/api/v1/camera/0/connected", form = "Connected=true";
  EXPECT_THAT(door.get(member), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(door.put(member, form), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(door.get(member + "?token=" + watcher), HasSubstr("\"Value\":false"));
  EXPECT_THAT(door.put(member + "?token=" + watcher, form), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(door.get(member, "Authorization: Bearer " + watcher + "\r\n"),
              HasSubstr("\"Value\":false"));
  EXPECT_THAT(door.put(member, form, "Authorization: Basic YWxwYWNhOm9vb29vb29vb29vb29vb28=\r\n"),
              StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(door.get(member + "?token=" + watcher), HasSubstr("\"Value\":true"));
  EXPECT_THAT(door.get(member, "Authorization: Basic !!!\r\n"), StartsWith("HTTP/1.1 401"));
}

TEST(AlpacaServer, FindsClientsByDiscovery) {
  boost::asio::io_context io;
  udp::socket probe(io, udp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
  const int port = probe.local_endpoint().port();
  probe.close();
  const Door door("alpaca-discovery", {.discovery_port = port});
  ASSERT_EQ(door.server.not_discovered(), "");
  udp::socket client(io, udp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
  const auto place = boost::asio::ip::address_v4::loopback();
  client.send_to(boost::asio::buffer(std::string("what?")), {place, std::uint16_t(port)});
  client.send_to(boost::asio::buffer(std::string("alpacadiscovery1")),
                 {place, std::uint16_t(port)});
  char answer[64];
  udp::endpoint from;
  const std::size_t size = client.receive_from(boost::asio::buffer(answer), from);
  EXPECT_EQ(std::string(answer, size),
            "{\"AlpacaPort\":" + std::to_string(door.server.port()) + "}");
}

// Alpaca API Reference, ImageBytes: 11 little-endian numbers of 32 bits, then the columns.
TEST(AlpacaAnswer, ImagesAreBytesAndArraysOfColumns) {
  CountImage image(3, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) image.at(x, y) = std::uint16_t(65000 + 10 * x + y);
  const std::string bytes = image_bytes({7, 8}, image);
  ASSERT_EQ(bytes.size(), 44u + 12u);
  std::int32_t metadata[11];
  std::memcpy(metadata, bytes.data(), 44);
  EXPECT_THAT(metadata, testing::ElementsAre(1, 0, 7, 8, 44, 2, 8, 2, 3, 2, 0));
  std::uint16_t counts[6];
  std::memcpy(counts, bytes.data() + 44, 12);
  EXPECT_THAT(counts, testing::ElementsAre(65000, 65001, 65010, 65011, 65020, 65021));
  EXPECT_THAT(json_image({7, 8}, image),
              StartsWith("{\"Type\":2,\"Rank\":2,\"Value\":[[65000,65001],[65010,65011],[65020,"
                         "65021]],\"ClientTransactionID\":7,\"ServerTransactionID\":8,"));
}

}  // namespace
}  // namespace dmise
