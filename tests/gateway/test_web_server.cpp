// Pages and WebSockets under good, slow and hostile clients.
#include "nodes/gateway/web_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "core/base/error.h"

namespace dmise {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using tcp = boost::asio::ip::tcp;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string viewer(16, 'v'), referee(16, 'r'), operator_(16, 'o');

/// One preview, and requests that are answered late.
struct OnePreview : PreviewSource {
  void request(const std::string& sensor, std::uint32_t frame, Answer answer) override {
    if (sensor == "late") return late.set_value(answer);
    const bool found = sensor == "alpha" && frame == 2;
    answer(found ? std::make_shared<const std::string>("\x89PNG picture") : nullptr);
  }
  std::promise<Answer> late;
};

constexpr std::size_t large_bytes = 6 << 20;

std::string dashboard() {
  const std::string directory = testing::TempDir() + "/dmise-dashboard";
  std::filesystem::create_directories(directory + "/assets");
  std::ofstream(directory + "/index.html") << "<html>dashboard</html>";
  std::ofstream(directory + "/assets/a.js") << "1;";
  std::ofstream(directory + "/assets/large.js") << std::string(large_bytes, ';');
  return directory;
}

/// The whole answer of a server to some bytes.
std::string ask(const WebServer& server, const std::string& bytes) {
  boost::asio::io_context io;
  tcp::socket socket(io);
  socket.connect({boost::asio::ip::address_v4::loopback(), std::uint16_t(server.port())});
  boost::system::error_code error;
  boost::asio::write(socket, boost::asio::buffer(bytes), error);
  socket.shutdown(tcp::socket::shutdown_send, error);
  std::string answer;
  boost::asio::read(socket, boost::asio::dynamic_buffer(answer), error);
  return answer;
}

std::string get(const WebServer& server, const std::string& target, const std::string& headers = "",
                const std::string& host = "localhost", const std::string& verb = "GET") {
  return ask(server, verb + " " + target + " HTTP/1.1\r\nHost: " + host +
                         "\r\nConnection: close\r\n" + headers + "\r\n");
}

struct Site {
  explicit Site(const WebServerOptions& options = {})
      : files(dashboard()),
        server(options, {files, latest, history, previews, [this](const ClockCommand& command) {
                           if (busy) return false;
                           ticks += command.ticks;
                           ++commands;
                           return true;
                         }}) {}

  std::string ask(const std::string& bytes) const { return dmise::ask(server, bytes); }
  std::string get(const std::string& target, const std::string& headers = "",
                  const std::string& host = "localhost", const std::string& verb = "GET") const {
    return dmise::get(server, target, headers, host, verb);
  }

  StaticFiles files;
  LatestMessages latest;
  ViewHistory history;
  OnePreview previews;
  std::atomic<std::int64_t> ticks{0};
  std::atomic<int> commands{0};
  std::atomic<bool> busy{false};
  WebServer server;
};

tcp::socket connected(boost::asio::io_context& io, const Site& site) {
  tcp::socket socket(io, tcp::v4());
  socket.set_option(boost::asio::socket_base::receive_buffer_size(32 << 10));
  socket.connect({boost::asio::ip::address_v4::loopback(), std::uint16_t(site.server.port())});
  return socket;
}

const std::string ask_for_large = "GET /assets/large.js HTTP/1.0\r\nHost: localhost\r\n\r\n";

/// A WebSocket of a program, not a browser.
struct Watcher {
  explicit Watcher(const Site& site, const std::string& target = "/live",
                   const std::string& origin = "") {
    beast::get_lowest_layer(socket).connect(
        {boost::asio::ip::address_v4::loopback(), std::uint16_t(site.server.port())});
    socket.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      if (!origin.empty()) request.set(beast::http::field::origin, origin);
    }));
    socket.handshake("127.0.0.1:" + std::to_string(site.server.port()), target);
  }
  std::string read() {
    beast::flat_buffer buffer;
    socket.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }
  std::string read_until(const std::string& part) {
    while (true)
      if (const std::string message = read(); message.find(part) != std::string::npos)
        return message;
  }
  void write(const std::string& text) { socket.write(boost::asio::buffer(text)); }

  boost::asio::io_context io;
  websocket::stream<tcp::socket> socket{io};
};

TEST(WebServer, ServesFilesWithTypeEtagAndPolicy) {
  const Site site;
  const std::string page = site.get("/");
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page, HasSubstr("text/html"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'none'"));
  EXPECT_THAT(page, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(page, HasSubstr("dashboard"));
  EXPECT_THAT(site.get("/assets/a.js"), HasSubstr("text/javascript"));
  const auto at = page.find("ETag: ") + 6;
  const std::string etag = page.substr(at, page.find('\r', at) - at);
  const std::string again = site.get("/", "If-None-Match: " + etag + "\r\n");
  EXPECT_THAT(again, StartsWith("HTTP/1.1 304"));
  EXPECT_THAT(again, Not(HasSubstr("dashboard")));
  const std::string head = site.get("/", "", "localhost", "HEAD");
  EXPECT_THAT(head, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(head, Not(HasSubstr("dashboard")));
}

TEST(WebServer, ServesPreviewsOfFrames) {
  const Site site;
  EXPECT_THAT(site.get("/frames/alpha/2.png"), HasSubstr("image/png"));
  EXPECT_THAT(site.get("/frames/alpha/3.png"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(site.get("/frames/alpha/0.png"), StartsWith("HTTP/1.1 404"));
}

TEST(WebServer, NobodyWaitsForThePreviewOfAnother) {
  Site site;
  auto first = std::async(std::launch::async, [&] { return site.get("/frames/late/1.png"); });
  const auto answer = site.previews.late.get_future().get();
  EXPECT_THAT(site.get("/frames/alpha/2.png"), HasSubstr("image/png"));
  answer(std::make_shared<const std::string>("\x89PNG late"));
  EXPECT_THAT(first.get(), HasSubstr("PNG late"));
}

TEST(WebServer, APreviewThatComesAfterItsEndIsDropped) {
  const StaticFiles none("/nowhere");
  LatestMessages latest;
  ViewHistory history;
  OnePreview previews;
  auto server = std::make_unique<WebServer>(WebServerOptions{},
                                            WebContent{none, latest, history, previews, {}});
  auto request = std::async(std::launch::async,
                            [at = server.get()] { return get(*at, "/frames/late/1.png"); });
  const auto answer = previews.late.get_future().get();
  server.reset();
  EXPECT_EQ(request.get(), "");
  answer(nullptr);
}

TEST(WebServer, SaysThatTheDashboardIsNotBuilt) {
  const StaticFiles none("/nowhere");
  LatestMessages latest;
  ViewHistory history;
  OnePreview previews;
  const WebServer server({}, {none, latest, history, previews, {}});
  EXPECT_THAT(get(server, "/"), HasSubstr("./dmise dashboard"));
}

TEST(WebServer, RefusesWhatIsNoRequestForIt) {
  const Site site;
  EXPECT_THAT(site.get("/nothing"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(site.get("/../etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(site.get("/", "", "localhost", "POST"), StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(site.get("/", "", "evil.example"), StartsWith("HTTP/1.1 421"));
  EXPECT_THAT(site.get("/live"), StartsWith("HTTP/1.1 426"));
  for (const std::string& bytes :
       {std::string("\r\n\r\n"), std::string("x"), std::string(100'000, 'a'),
        "GET / HTTP/1.1\r\nA: " + std::string(20'000, 'a') + "\r\n\r\n",
        std::string("\x16\x03\x01\x02\x00", 5)})
    site.ask(bytes);
  EXPECT_THAT(site.ask("GET / HTTP/1.1\r\nContent-Length: 999999\r\nHost: localhost\r\n\r\nbody"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(site.get("/"), StartsWith("HTTP/1.1 200"));
}

TEST(WebServer, NeedsTokensWhereOthersReachIt) {
  const StaticFiles files(dashboard());
  LatestMessages latest;
  ViewHistory history;
  OnePreview previews;
  const WebContent content{files, latest, history, previews, {}};
  EXPECT_THROW(WebServer({.host = "0.0.0.0"}, content), ConfigError);
  EXPECT_THROW(WebServer({.host = "::"}, content), ConfigError);
  EXPECT_THROW(WebServer({.host = "view.example"}, content), ConfigError);
  EXPECT_NO_THROW(WebServer({.host = "0.0.0.0", .tokens = {viewer, "", ""}}, content));
}

TEST(WebServer, TokensDecideWhatAViewerMay) {
  Site site({.tokens = {viewer, operator_, referee}, .may_control = true});
  EXPECT_THAT(site.get("/"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(site.get("/frames/alpha/2.png"), StartsWith("HTTP/1.1 401"));
  const std::string moved = site.get("/?token=" + viewer);
  EXPECT_THAT(moved, StartsWith("HTTP/1.1 303"));
  EXPECT_THAT(moved, HasSubstr("HttpOnly; SameSite=Strict"));
  EXPECT_THAT(site.get("/", "Cookie: dmise_token=" + viewer + "\r\n"), StartsWith("HTTP/1.1 200"));
  EXPECT_THROW(Watcher(site, "/live"), boost::system::system_error);
  EXPECT_THROW(Watcher(site, "/live?token=wrongwrongwrongwrong"), boost::system::system_error);

  Watcher watcher(site, "/live?token=" + viewer), controller(site, "/live?token=" + operator_);
  EXPECT_THAT(watcher.read(), HasSubstr("\"may_control\":false"));
  EXPECT_THAT(controller.read(), HasSubstr("\"may_control\":true"));
  watcher.write(R"({"do": "pause"})");
  EXPECT_THAT(watcher.read(), HasSubstr("only the operator"));
  EXPECT_EQ(site.commands, 0);
  controller.write(R"({"do": "step", "ticks": 3})");
  controller.write("nonsense");
  EXPECT_THAT(controller.read(), HasSubstr("refused"));
  EXPECT_EQ(site.ticks, 3);
  site.busy = true;
  controller.write(R"({"do": "pause"})");
  EXPECT_THAT(controller.read(), HasSubstr("too many commands"));
}

TEST(WebServer, TruthIsForThoseWhoMaySeeIt) {
  Site site({.tokens = {viewer, operator_, referee}, .may_control = true, .shows_truth = true});
  site.latest.set(MessageSlot::truth, {"SECRET"});
  site.latest.set(MessageSlot::notice, {"after it"});
  Watcher watcher(site, "/live?token=" + viewer);
  EXPECT_THAT(watcher.read(), HasSubstr("\"sees_truth\":false"));
  EXPECT_EQ(watcher.read(), "after it");  // the order is that of the kinds
  site.latest.set(MessageSlot::truth, {"SECRET again"});
  site.latest.set(MessageSlot::notice, {"after that"});
  site.server.changed();
  EXPECT_EQ(watcher.read(), "after that");
  for (const std::string& token : {referee, operator_}) {
    Watcher knows(site, "/live?token=" + token);
    EXPECT_THAT(knows.read(), HasSubstr("\"sees_truth\":true"));
    EXPECT_EQ(knows.read(), "SECRET again");
  }
  // A gateway that was not told to show it shows none, whoever asks.
  Site blind({.tokens = {viewer, operator_, referee}, .may_control = true});
  blind.latest.set(MessageSlot::truth, {"SECRET"});
  blind.latest.set(MessageSlot::notice, {"after it"});
  Watcher controller(blind, "/live?token=" + operator_);
  EXPECT_THAT(controller.read(), HasSubstr("\"sees_truth\":false"));
  EXPECT_EQ(controller.read(), "after it");
}

TEST(WebServer, PagesOfOtherSitesOpenNoWebSocket) {
  const Site site;
  EXPECT_THROW(Watcher(site, "/live", "http://evil.example"), boost::system::system_error);
  EXPECT_NO_THROW(Watcher(site, "/live", "http://127.0.0.1:" + std::to_string(site.server.port())));
}

TEST(WebServer, ASlowViewerGetsTheNewestAndNoQueue) {
  Site site;
  Watcher slow(site);
  EXPECT_THAT(slow.read(), HasSubstr("welcome"));
  constexpr int updates = 500;
  const std::string filling(1 << 20, 'x');
  std::vector<std::weak_ptr<const ViewerMessage>> all;
  for (int i = 1; i <= updates; ++i) {  // 500 MB, which nobody reads
    site.latest.set(MessageSlot::objects, {std::to_string(i) + " " + filling, true});
    all.push_back(site.latest.of(MessageSlot::objects));
    site.server.changed();
  }
  const auto alive = std::ranges::count_if(all, [](const auto& m) { return !m.expired(); });
  EXPECT_LE(alive, 3);  // the newest, and one that is on its way
  int received = 0;
  for (std::string last; !last.starts_with(std::to_string(updates) + " "); ++received)
    last = slow.read();
  EXPECT_LT(received, updates / 10);
}

TEST(WebServer, ThePastIsShownUntilTheViewerGoesBackToTheRun) {
  Site site;
  site.latest.set(MessageSlot::sensors, {"present sensors"});
  site.latest.set(MessageSlot::status, {"status"});
  Watcher watcher(site);
  watcher.read_until("present sensors");
  watcher.write(R"({"do": "past", "time_s": 7})");
  EXPECT_THAT(watcher.read_until("refused"), HasSubstr("nothing is kept"));
  site.history.add({5.0, {std::make_shared<const ViewerMessage>(ViewerMessage{"past sensors"})}});
  watcher.write(R"({"do": "past", "time_s": 7})");
  EXPECT_THAT(watcher.read_until("past"), HasSubstr("\"time_s\":5"));
  EXPECT_EQ(watcher.read(), "past sensors");
  site.latest.set(MessageSlot::sensors, {"later sensors"});
  site.latest.set(MessageSlot::status, {"later status"});
  site.server.changed();
  EXPECT_EQ(watcher.read(), "later status");  // health goes on
  watcher.write(R"({"do": "live"})");
  EXPECT_EQ(watcher.read(), "later sensors");
}

TEST(WebServer, SilentConnectionsLockNobodyOut) {
  Site site({.tokens = {viewer, operator_, referee}, .may_control = true, .max_connections = 8});
  Watcher watcher(site, "/live?token=" + viewer);
  watcher.read();
  boost::asio::io_context io;
  std::vector<tcp::socket> silent;
  for (int i = 0; i < 40; ++i) silent.push_back(connected(io, site));
  Watcher controller(site, "/live?token=" + operator_);
  EXPECT_THAT(controller.read(), HasSubstr("\"may_control\":true"));
  EXPECT_THAT(site.get("/", "Cookie: dmise_token=" + operator_ + "\r\n"),
              StartsWith("HTTP/1.1 200"));
  for (int i = 0; i < 40; ++i) silent.push_back(connected(io, site));
  watcher.write("nonsense");  // who was let in keeps its place
  EXPECT_THAT(watcher.read(), HasSubstr("refused"));
  controller.write("nonsense");
  EXPECT_THAT(controller.read(), HasSubstr("refused"));
}

TEST(WebServer, ASlowLineGetsTheWholeFile) {
  constexpr double request_within_s = 2.0;
  Site site({.max_connections = 1, .request_within_s = request_within_s});
  boost::asio::io_context io;
  tcp::socket slow = connected(io, site);
  boost::asio::write(slow, boost::asio::buffer(ask_for_large));
  std::string part(64 << 10, '\0');
  std::size_t received = 0;
  boost::system::error_code end;
  const auto began = std::chrono::steady_clock::now();
  while (!end) {
    received += slow.read_some(boost::asio::buffer(part), end);
    std::this_thread::sleep_for(std::chrono::milliseconds(received < large_bytes / 2 ? 60 : 0));
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  EXPECT_GT(took.count(), request_within_s);
  EXPECT_GT(received, large_bytes);
  // Who reads nothing loses its place.
  tcp::socket deaf = connected(io, site);
  boost::asio::write(deaf, boost::asio::buffer(ask_for_large));
  while (!site.get("/").starts_with("HTTP/1.1 200")) continue;
}

TEST(WebServer, CompressesFilesForWhoAcceptsIt) {
  const Site site;
  const std::string small = site.get("/assets/large.js", "Accept-Encoding: gzip, br\r\n");
  EXPECT_THAT(small, HasSubstr("Content-Encoding: gzip"));
  EXPECT_THAT(small, HasSubstr("Vary: Accept-Encoding"));
  EXPECT_LT(small.size(), large_bytes / 100);
  const std::string whole = site.get("/assets/large.js");
  EXPECT_THAT(whole.substr(0, 1000), Not(HasSubstr("Content-Encoding")));
  EXPECT_GT(whole.size(), large_bytes);
  const auto etag_of = [](const std::string& answer) {
    const auto at = answer.find("ETag: ") + 6;
    return answer.substr(at, answer.find('\r', at) - at);
  };
  EXPECT_NE(etag_of(small), etag_of(whole));
  EXPECT_THAT(site.get("/assets/large.js",
                       "Accept-Encoding: gzip\r\nIf-None-Match: " + etag_of(small) + "\r\n"),
              StartsWith("HTTP/1.1 304"));
}

TEST(WebServer, CookiesOfTwoServersOnAHostDoNotReplaceEachOther) {
  Site site({.tokens = {viewer, operator_, referee}});
  const std::string ours = "localhost:" + std::to_string(site.server.port());
  const std::string moved = site.get("/?token=" + viewer, "", ours);
  const std::string cookie = "dmise_token_" + std::to_string(site.server.port()) + "=";
  EXPECT_THAT(moved, HasSubstr("Set-Cookie: " + cookie + viewer + ";"));
  const std::string both = "Cookie: dmise_token_1=" + std::string(16, 'x') + "; " + cookie + viewer;
  EXPECT_THAT(site.get("/", both + "\r\n", ours), StartsWith("HTTP/1.1 200"));
}

TEST(WebServer, ATokenInTheAddressOfAFrameKeepsItsPath) {
  Site site({.tokens = {viewer, operator_, referee}});
  EXPECT_THAT(site.get("/frames/alpha/2.png?token=" + viewer),
              HasSubstr("Location: /frames/alpha/2.png\r\n"));
  EXPECT_THAT(site.get("/?token=" + viewer), HasSubstr("Location: /\r\n"));
}

TEST(WebServer, BoundsConnectionsAndMessages) {
  Site site({.max_connections = 3, .request_within_s = 0.3});
  std::vector<std::unique_ptr<Watcher>> watchers;
  for (int i = 0; i < 3; ++i) watchers.push_back(std::make_unique<Watcher>(site));
  EXPECT_THROW(Watcher{site}, boost::system::system_error);
  watchers[0]->read();
  const auto too_long = [&] {  // it may be cut off while it is being written
    watchers[0]->write(std::string(5000, ' '));
    watchers[0]->read();
  };
  EXPECT_THROW(too_long(), boost::system::system_error);
  // Its place is free; who sends half a request loses it after a while.
  watchers.clear();
  std::string late;
  while (!late.starts_with("HTTP/1.1 200")) {
    site.ask("GET / HTTP/1.1\r\n");
    late = site.get("/");
  }
  boost::asio::io_context io;
  tcp::socket silent(io);
  silent.connect({boost::asio::ip::address_v4::loopback(), std::uint16_t(site.server.port())});
  char byte = 0;
  boost::system::error_code error;
  silent.read_some(boost::asio::buffer(&byte, 1), error);
  EXPECT_TRUE(error);
}

}  // namespace
}  // namespace dmise
