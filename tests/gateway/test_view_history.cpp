// The past of a run within a bound of memory.
#include "nodes/gateway/view_history.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

SharedMessage message_of(std::size_t bytes) {
  return std::make_shared<const ViewerMessage>(ViewerMessage{std::string(bytes, 'x')});
}

TEST(ViewHistory, GivesTheLastStateBefore) {
  ViewHistory history;
  EXPECT_FALSE(history.at(0.0));
  for (const double t : {10.0, 20.0, 30.0}) history.add({t, {message_of(1)}});
  EXPECT_EQ(history.at(5.0)->time_s, 10.0);
  EXPECT_EQ(history.at(20.0)->time_s, 20.0);
  EXPECT_EQ(history.at(29.9)->time_s, 20.0);
  EXPECT_EQ(history.at(1e9)->time_s, 30.0);
  history.add({25.0, {message_of(1)}});  // older than the last: left out
  EXPECT_EQ(history.span().snapshots, 3u);
}

TEST(ViewHistory, CoversTheWholeRunWithinItsBytes) {
  constexpr std::size_t most = 1'000'000, size = 10'000;
  ViewHistory history(most, 2048);
  for (int tick = 0; tick <= 100'000; ++tick) {
    history.add({double(tick), {message_of(size)}});
    ASSERT_LE(history.span().bytes, most);
  }
  const auto span = history.span();
  EXPECT_EQ(span.from_s, 0.0);
  EXPECT_GE(span.snapshots, most / size / 2 - 1);
  EXPECT_GE(span.to_s, 100'000 - 100'000.0 / double(span.snapshots - 1) * 2);
  for (double t = 0; t <= 1e5; t += 997)  // evenly: nowhere is a hole
    EXPECT_LE(t - history.at(t)->time_s, 2 * 1e5 / double(span.snapshots)) << t;
}

TEST(ViewHistory, CountsWhatSnapshotsShareOnce) {
  ViewHistory history(1'000'000, 100);
  const SharedMessage roster = message_of(1000);
  for (int tick = 0; tick < 50; ++tick) history.add({double(tick), {message_of(10), roster}});
  EXPECT_EQ(history.span().bytes, 1000u + 50 * 10);
  for (int tick = 50; tick < 1000; ++tick) history.add({double(tick), {message_of(10), roster}});
  EXPECT_LE(history.span().snapshots, 100u);
}

}  // namespace
}  // namespace dmise
