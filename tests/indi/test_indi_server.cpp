// The server: several clients, hostile bytes, clients that never read, addresses of other machines.
#include "sensors/indi/indi_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>

#include "core/base/error.h"
#include "tests/observatory/served_observatory.h"

namespace dmise {
namespace {

using boost::asio::ip::tcp;
using testing::HasSubstr;

struct Door : ServedObservatory {
  explicit Door(const std::string& name, const IndiServerOptions& options = {})
      : ServedObservatory(testing::TempDir() + "/" + name, std::make_shared<WallClock>(100.0)),
        server(options) {
    server.serve(observatory);
  }
  IndiServer server;
};

class Client {
 public:
  explicit Client(const Door& door) {
    socket_.connect({boost::asio::ip::address_v4::loopback(), std::uint16_t(door.server.port())});
  }
  void say(const std::string& text) {
    boost::system::error_code error;
    boost::asio::write(socket_, boost::asio::buffer(text), error);
  }
  /// What comes up to and with `end`; all there is if the connection ends before.
  std::string hear(const std::string& end) {
    boost::system::error_code error;
    std::size_t size =
        boost::asio::read_until(socket_, boost::asio::dynamic_buffer(heard_), end, error);
    if (error) size = heard_.size();
    std::string text = heard_.substr(0, size);
    heard_.erase(0, size);
    return text;
  }
  std::string hear_all() { return hear("\nnever\n"); }

 private:
  boost::asio::io_context io_;
  tcp::socket socket_{io_};
  std::string heard_;
};

const std::string get_all = "<getProperties version='1.7'/>";
const std::string connect =
    "<newSwitchVector device='eye camera' name='CONNECTION'><oneSwitch "
    "name='CONNECT'>On</oneSwitch>"
    "</newSwitchVector>";

TEST(IndiServer, TellsAllClientsThatAsked) {
  const Door door("indi-all");
  Client one(door), other(door), silent(door);
  one.say(get_all);
  other.say("<getProperties version='1.7' device='eye camera'/>");
  EXPECT_THAT(one.hear("</defSwitchVector>\n"), HasSubstr("name=\"CONNECTION\""));
  EXPECT_THAT(other.hear("</defSwitchVector>\n"), HasSubstr("device=\"eye camera\""));
  one.say(connect);
  EXPECT_THAT(one.hear("</setSwitchVector>\n"), HasSubstr("state=\"Ok\""));
  EXPECT_THAT(other.hear("</defBLOBVector>\n"),
              HasSubstr("<setSwitchVector device=\"eye camera\""));
  silent.say("<newSwitchVector device='eye camera' name='NOTHING'/>");
  EXPECT_THAT(silent.hear("</message>\n"), testing::StartsWith("<message device=\"eye camera\""));
}

TEST(IndiServer, EndsConnectionsOfHostileBytesAlone) {
  const Door door("indi-hostile");
  Client good(door);
  good.say(get_all);
  for (const char* text : {"<!DOCTYPE a>", "POST / HTTP/1.1\r\n\r\n", "<a><b><c><d>"}) {
    Client bad(door);
    bad.say(text);
    EXPECT_THAT(bad.hear_all(), HasSubstr("<message timestamp=")) << text;
  }
  good.say(connect);
  EXPECT_THAT(good.hear("</setSwitchVector>\n"), HasSubstr("state=\"Ok\""));
}

TEST(IndiServer, LosesClientsThatDoNotRead) {
  const Door door("indi-slow",
                  {.max_waiting_bytes = 10'000'000, .max_unanswered_bytes = 20'000'000});
  Client slow(door), good(door);
  slow.say(connect);
  std::string many;
  for (int i = 0; i < 3000; ++i) many += get_all;
  slow.say(many);  // some 30 MB of answers
  good.say(get_all);
  EXPECT_THAT(good.hear("</defSwitchVector>\n"), HasSubstr("name=\"CONNECTION\""));
  EXPECT_LT(slow.hear_all().size(), 20'000'000u);
}

TEST(IndiServer, LetsClientsWaitThatAskFasterThanTheyRead) {
  const Door door("indi-fast", {.max_waiting_bytes = 2'000'000, .max_unanswered_bytes = 100'000});
  Client fast(door);
  std::string many;
  for (int i = 0; i < 500; ++i) many += get_all;
  fast.say(many + "<newSwitchVector device='eye camera' name='NOTHING'/>");
  const std::string heard = fast.hear("</message>\n");
  EXPECT_THAT(heard.substr(heard.size() - 200), HasSubstr("has no property NOTHING"));
}

TEST(IndiServer, IsForThisMachineAlone) {
  EXPECT_THROW(IndiServer({.host = "0.0.0.0"}), ConfigError);
  EXPECT_THROW(IndiServer({.host = "somewhere"}), ConfigError);
}

}  // namespace
}  // namespace dmise
