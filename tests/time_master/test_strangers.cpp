// Whoever the clock does not wait for: how much of it is heard, answered and written down.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/runtime/process/line_limit.h"
#include "time-master/unauthenticated_peers.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr Instant at_start = seconds(100);

std::string take_all(UnauthenticatedPeers<char>& queue, Instant now) {
  std::string taken;
  while (const auto message = queue.take(now)) taken += *message;
  return taken;
}

TEST(UnauthenticatedPeers, ServesPeersInTurns) {
  UnauthenticatedPeers<char> queue({});
  for (const char message : {'a', 'a', 'a', 'b', 'c', 'c'})
    queue.push(std::string(1, message), message, 1);
  EXPECT_EQ(take_all(queue, at_start), "abcaca");
  EXPECT_EQ(queue.size(), 0u);
}

TEST(UnauthenticatedPeers, KeepsOfAPeerWhatItsBoundAllows) {
  UnauthenticatedPeers<char> queue({.messages_of_a_peer = 3});
  for (int i = 0; i < 400'000; ++i) queue.push("flood", 'f', 2);
  EXPECT_TRUE(queue.push("honest", 'h', 2));
  EXPECT_EQ(queue.take_ignored(), 399'997u);
  EXPECT_EQ(queue.take_ignored(), 0u);
  EXPECT_EQ(take_all(queue, at_start), "fhff");
}

TEST(UnauthenticatedPeers, KeepsOfAllPeersWhatItsBoundsAllow) {
  UnauthenticatedPeers<char> few({.messages = 5});
  for (int i = 0; i < 100; ++i) few.push(std::to_string(i), 'x', 1);
  EXPECT_EQ(few.size(), 5u);
  UnauthenticatedPeers<char> small({.bytes = 1000});
  for (int i = 0; i < 100; ++i) small.push(std::to_string(i), 'x', 300);
  EXPECT_EQ(small.size(), 3u);
  EXPECT_EQ(take_all(small, at_start).size(), 3u);
  EXPECT_TRUE(small.push("later", 'x', 1000));
}

// 20 at once, then one each 10 ms, whatever is sent.
TEST(UnauthenticatedPeers, ServesEachPeerAtABoundedRate) {
  UnauthenticatedPeers<char> queue(
      {.messages_of_a_peer = 1000, .rate = {.burst = 20, .interval = milliseconds(10)}});
  for (int i = 0; i < 1000; ++i) queue.push("flood", 'f', 1);
  EXPECT_EQ(take_all(queue, at_start).size(), 20u);
  EXPECT_EQ(queue.next_due(at_start), at_start + milliseconds(10));
  EXPECT_EQ(take_all(queue, at_start + milliseconds(9)), "");
  EXPECT_EQ(take_all(queue, at_start + milliseconds(10)), "f");
  EXPECT_TRUE(queue.push("honest", 'h', 1));
  EXPECT_LE(queue.next_due(at_start + milliseconds(10)), at_start + milliseconds(10));
  EXPECT_EQ(take_all(queue, at_start + milliseconds(10)), "h");
  std::size_t served = 0;
  for (auto now = at_start + milliseconds(10); now <= at_start + seconds(2); now += milliseconds(1))
    served += take_all(queue, now).size();
  EXPECT_NEAR(double(served), 199.0, 1.0);
}

TEST(UnauthenticatedPeers, HasNothingDueWhenNobodyWaits) {
  UnauthenticatedPeers<char> queue({});
  EXPECT_EQ(queue.next_due(at_start), std::nullopt);
  EXPECT_EQ(queue.take(at_start), std::nullopt);
}

TEST(PeerRates, KeepNothingOfThoseWhoAreQuiet) {
  PeerRates rates({.burst = 10, .interval = milliseconds(100)});
  for (int i = 0; i < 100'000; ++i) rates.take(std::to_string(i), at_start + milliseconds(i));
  EXPECT_LE(rates.size(), 2200u);  // those of the last 0.1 s, swept once a second
  rates.forget_quiet(at_start + seconds(200));
  EXPECT_EQ(rates.size(), 0u);
}

TEST(LineLimit, WritesTheFirstOfEachKindAndCountsTheOthers) {
  LineLimit lines(10, seconds(10));
  int written = 0;
  for (int i = 0; i < 20'000; ++i)
    written += lines.admit("refused", at_start + milliseconds(i / 4));
  EXPECT_EQ(written, 10);
  EXPECT_TRUE(lines.admit("another kind", at_start + seconds(5)));
  EXPECT_THAT(lines.take_left_out(at_start + seconds(9)), IsEmpty());
  EXPECT_THAT(lines.take_left_out(at_start + seconds(10)), ElementsAre(Pair("refused", 19'990u)));
  EXPECT_THAT(lines.take_left_out(at_start + seconds(20)), IsEmpty());
}

TEST(LineLimit, CountsWhatIsLeftAtTheEnd) {
  LineLimit lines(1, seconds(10));
  for (int i = 0; i < 3; ++i) lines.admit("refused", at_start);
  EXPECT_THAT(lines.take_left_out(at_start, true), ElementsAre(Pair("refused", 2u)));
}

TEST(LineLimit, WritesAgainWhenTheIntervalIsOver) {
  LineLimit lines(2, seconds(10));
  for (int s = 0; s < 100; s += 11) {
    EXPECT_TRUE(lines.admit("refused", at_start + seconds(s)));
    EXPECT_TRUE(lines.admit("refused", at_start + seconds(s)));
  }
}

}  // namespace
}  // namespace dmise
