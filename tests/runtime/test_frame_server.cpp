// The frame endpoint of a sensor: which frames are kept, what is answered, and that nobody who
// reads them can hold it up or fill its memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/products/frame_report.h"
#include "nodes/runtime/node/frame_server.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/transport/socket.h"
#include "tests/runtime/key_directory.h"
#include "tests/wire/examples.h"

namespace dmise {
namespace {

using std::chrono::seconds;

constexpr std::uint64_t run_id = 7;

FrameReport report(std::uint32_t number) {
  for (unsigned seed = 1;; ++seed)
    for (test::Example& example : test::examples(seed))
      if (auto* found = std::get_if<FrameReport>(&example.state)) {
        found->frame = number;
        return *found;
      }
}

void add(KeptFrames& frames, std::uint32_t number, const std::string& content,
         std::size_t held_bytes = 0) {
  const auto bytes = std::make_shared<const std::string>(content);
  frames.add(
      report(number),
      [bytes] {
        return FrameBytes{bytes, *bytes};
      },
      held_bytes);
}

v1::FrameRequest asking(std::uint32_t frame) {
  v1::FrameRequest request;
  request.set_run_id(run_id);
  request.set_frame(frame);
  return request;
}
v1::FrameRequest next_after(std::uint32_t frame) {
  v1::FrameRequest request = asking(frame);
  request.set_next_after(frame);
  return request;
}
v1::FrameRequest latest_after(std::uint32_t frame) {
  v1::FrameRequest request = asking(frame);
  request.set_latest_after(frame);
  return request;
}

/// Number and content of an answer; "waits", "not kept" or "over" instead of a content.
std::pair<std::uint32_t, std::string> content(const std::optional<KeptFrames::Answer>& answer) {
  if (!answer) return {0, "waits"};
  if (answer->head.status() == v1::FrameAnswer::STATUS_NOT_KEPT) return {0, "not kept"};
  if (answer->head.status() == v1::FrameAnswer::STATUS_OVER) return {0, "over"};
  return {answer->head.report().frame(), std::string(answer->fits.bytes)};
}
using Content = std::pair<std::uint32_t, std::string>;

TEST(KeptFrames, AnswerForTheNumbersThatThereAre) {
  KeptFrames frames("a");
  EXPECT_EQ(content(frames.answer(latest_after(0), run_id)), Content(0, "waits"));
  for (const std::uint32_t number : {2u, 3u, 7u}) add(frames, number, std::to_string(number));
  EXPECT_EQ(content(frames.answer(asking(3), run_id)), Content(3, "3"));
  EXPECT_EQ(content(frames.answer(asking(4), run_id)), Content(0, "not kept"));
  EXPECT_EQ(content(frames.answer(asking(8), run_id)), Content(0, "not kept"));
  EXPECT_EQ(content(frames.answer(next_after(0), run_id)), Content(2, "2"));
  EXPECT_EQ(content(frames.answer(next_after(3), run_id)), Content(7, "7"));
  EXPECT_EQ(content(frames.answer(latest_after(0), run_id)), Content(7, "7"));
  EXPECT_EQ(content(frames.answer(latest_after(7), run_id)), Content(0, "waits"));
  EXPECT_EQ(content(frames.answer(next_after(0xffffffff), run_id)), Content(0, "waits"));
  const auto answer = frames.answer(asking(7), run_id);
  EXPECT_EQ(answer->head.run_id(), run_id);
  EXPECT_EQ(answer->head.sensor(), "a");
  EXPECT_EQ(answer->head.oldest_frame(), 2u);
  EXPECT_EQ(answer->head.newest_frame(), 7u);
  EXPECT_EQ(answer->head.sequence(), 3u);
  frames.end();
  EXPECT_EQ(content(frames.answer(latest_after(7), run_id)), Content(0, "over"));
  EXPECT_EQ(content(frames.answer(next_after(3), run_id)), Content(7, "7"));
  EXPECT_THROW(add(frames, 7, "again"), Error);
}

TEST(KeptFrames, AreTheLastOfABoundedNumberAndSize) {
  KeptFrames many("a");
  for (std::uint32_t number = 1; number <= KeptFrames::max_frames + 10; ++number)
    add(many, number, "");
  EXPECT_EQ(many.answer(next_after(0), run_id)->head.report().frame(), 11u);
  EXPECT_EQ(many.answer(next_after(0), run_id)->head.sequence(), 11u);

  KeptFrames large("a");
  for (std::uint32_t number = 1; number <= 5; ++number)
    add(large, number, "", KeptFrames::max_bytes / 2);
  EXPECT_EQ(large.answer(next_after(0), run_id)->head.oldest_frame(), 4u);
  add(large, 6, "", 2 * KeptFrames::max_bytes);
  EXPECT_EQ(large.answer(next_after(0), run_id)->head.oldest_frame(), 6u);
  large.add(report(7), {});  // nobody is there: it is counted
  add(large, 8, "", 1);
  EXPECT_EQ(large.answer(asking(8), run_id)->head.sequence(), 8u);
}

TEST(KeptFrames, WhoseFileIsGoneAreNotKept) {
  KeptFrames frames("a");
  frames.add(report(1), []() -> FrameBytes { throw Error("frame-000001.fits: gone"); });
  const auto answer = frames.answer(next_after(0), run_id);
  EXPECT_EQ(content(answer), Content(0, "not kept"));
  EXPECT_EQ(answer->head.report().frame(), 1u);
}

/// A served sensor and those who read it.
struct Served {
  explicit Served(const std::string& keys = "") : security(keys, keys.empty() ? "" : "a") {
    door.emplace(context, security);
    auto socket = FrameServer::make_socket_of(context);
    address = bind_to(socket, "tcp://127.0.0.1:0", security, Domain::data);
    server.emplace(context, std::move(socket), frames, run_id);
  }
  zmq::socket_t reader(int unread = 1000, const Security& own = {}) {
    auto socket = make_socket(readers, zmq::socket_type::dealer, max_data_bytes);
    socket.set(zmq::sockopt::rcvhwm, unread);
    if (unread == 1) socket.set(zmq::sockopt::rcvbuf, 4096);
    connect_to(socket, address, own, "a");
    return socket;
  }
  KeptFrames frames{"a"};
  zmq::context_t context{1}, readers{1};
  Security security;
  std::optional<ZapAuthenticator> door;
  std::string address;
  std::optional<FrameServer> server;
};

void ask(zmq::socket_t& reader, const v1::FrameRequest& request) {
  reader.send(to_frame(request), zmq::send_flags::none);
}

/// The next answer: number and content as above; "nothing" if none comes within the time.
Content hear(zmq::socket_t& reader, std::chrono::nanoseconds within = seconds(20)) {
  std::vector<zmq::pollitem_t> items{{reader.handle(), 0, ZMQ_POLLIN, 0}};
  wait_for(items, within);
  const auto message = receive(reader);
  if (message.empty()) return {0, "nothing"};
  KeptFrames::Answer answer;
  EXPECT_TRUE(from_frame(message[0], &answer.head));
  EXPECT_EQ(message.size(), answer.head.status() == v1::FrameAnswer::STATUS_SENT ? 2u : 1u);
  if (message.size() == 2) answer.fits.bytes = message[1].to_string_view();
  return content(answer);
}

TEST(FrameServer, AnswersAtOnceAndWhenAFrameIsMade) {
  Served sensor;
  auto reader = sensor.reader(), other = sensor.reader();
  ask(reader, next_after(0));
  ask(other, asking(1));
  EXPECT_EQ(hear(other), Content(0, "not kept"));
  const std::string large(3'000'000, 'x');
  add(sensor.frames, 1, large);
  EXPECT_EQ(hear(reader), Content(1, large));
  ask(other, asking(1));
  EXPECT_EQ(hear(other), Content(1, large));
  ask(reader, latest_after(1));
  add(sensor.frames, 2, "two");
  EXPECT_EQ(hear(reader), Content(2, "two"));
}

TEST(FrameServer, TellsItsReadersThatItIsOver) {
  Served sensor;
  auto reader = sensor.reader();
  add(sensor.frames, 1, "one");
  ask(reader, next_after(0));
  EXPECT_EQ(hear(reader), Content(1, "one"));
  add(sensor.frames, 2, "two");
  auto end = std::async(std::launch::async, [&] { sensor.server->finish(seconds(20)); });
  ask(reader, next_after(1));  // the last frame is still given
  EXPECT_EQ(hear(reader), Content(2, "two"));
  ask(reader, next_after(2));
  EXPECT_EQ(hear(reader), Content(0, "over"));
  end.get();
}

TEST(FrameServer, DoesNotWaitForAReaderThatIsGone) {
  Served sensor;
  auto reader = sensor.reader();
  add(sensor.frames, 1, "one");
  ask(reader, next_after(0));
  EXPECT_EQ(hear(reader), Content(1, "one"));
  const auto began = now();
  sensor.server->finish(std::chrono::milliseconds(300));
  EXPECT_LT(now() - began, seconds(10));
}

TEST(FrameServer, IgnoresRubbishAndOtherRuns) {
  Served sensor;
  auto reader = sensor.reader();
  add(sensor.frames, 1, "one");
  auto of_another_run = asking(1);
  of_another_run.set_run_id(run_id + 1);
  ask(reader, of_another_run);
  ask(reader, asking(0));
  v1::FrameRequest nothing;
  nothing.set_run_id(run_id);
  ask(reader, nothing);
  reader.send(zmq::str_buffer("\xff\xff rubbish"), zmq::send_flags::none);
  for (int i = 0; i < 20; ++i)
    reader.send(zmq::str_buffer("x"), i < 19 ? zmq::send_flags::sndmore : zmq::send_flags::none);
  ask(reader, asking(1));
  EXPECT_EQ(hear(reader), Content(1, "one"));
  EXPECT_EQ(hear(reader, std::chrono::milliseconds(1)), Content(0, "nothing"));
}

// Twenty readers ask a hundred times each for 4 MB and read nothing: 8 GB. Another one is served.
TEST(FrameServer, KeepsNothingForWhoDoesNotRead) {
  std::atomic<int> alive{0}, most{0};
  Served sensor;
  for (std::uint32_t number = 1; number <= 10; ++number)
    sensor.frames.add(report(number), [&] {
      const std::shared_ptr<const std::string> bytes(new std::string(4'000'000, 'x'),
                                                     [&](const std::string* gone) {
                                                       delete gone;
                                                       --alive;
                                                     });
      most = std::max(most.load(), ++alive);
      return FrameBytes{bytes, *bytes};
    });
  std::vector<zmq::socket_t> greedy;
  for (int i = 0; i < 20; ++i) greedy.push_back(sensor.reader(1));
  for (std::uint32_t k = 0; k < 100; ++k)
    for (auto& reader : greedy) ask(reader, asking(1 + k % 10));
  auto reader = sensor.reader();
  ask(reader, asking(10));
  EXPECT_EQ(hear(reader).first, 10u);
  EXPECT_LE(most.load(), 20 * FrameServer::max_unread + 1);  // not the 2,000 that were asked for
}

TEST(FrameServer, WithKeysAnswersThoseWhoMayComeIn) {
  const test::Keys keys({"a", "viewer"}), others({"a", "viewer"});
  Served sensor(keys.directory);
  add(sensor.frames, 1, "one");
  auto viewer = sensor.reader(1000, Security(keys.directory, "viewer"));
  ask(viewer, asking(1));
  EXPECT_EQ(hear(viewer), Content(1, "one"));
  auto plain = sensor.reader();
  ask(plain, asking(1));
  EXPECT_EQ(hear(plain, std::chrono::milliseconds(300)), Content(0, "nothing"));
}

}  // namespace
}  // namespace dmise
