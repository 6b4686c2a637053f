#include "nodes/runtime/protocol/inbox.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "nodes/runtime/protocol/outbox.h"
#include "nodes/wire/receiver.h"

namespace dmise {
namespace {

const RunFacts run{.run_id = 7, .tick_length = {1000}, .last_tick = 100};

Message environment(Tick tick, double sun_x_m) {
  EnvironmentState state;
  state.tick = tick;
  state.time = run.time_of(tick);
  state.sun_m.x = sun_x_m;
  return {environment_topic, tick, std::make_shared<const State>(state)};
}

/// What an outbox packs, as an inbox would get it.
Received through_the_wire(const SharedFrames& frames) {
  Receiver receiver(run);
  receiver.allow(environment_topic, "env", 1);
  std::vector<std::string_view> views{frames->topic, frames->envelope, frames->payload};
  if (!frames->arrays.empty()) views.push_back(frames->arrays);
  const auto received = receiver.receive(views);
  EXPECT_TRUE(received) << receiver.last_refusal();
  return *received;
}

std::vector<Received> packed(Outbox& outbox, Tick tick, const std::vector<Message>& messages) {
  std::vector<Received> all;
  for (const SharedFrames& frames : outbox.pack(tick, messages))
    all.push_back(through_the_wire(frames));
  return all;
}

double sun_x_m(const Message& message) {
  return std::get<EnvironmentState>(*message.state).sun_m.x;
}

struct Pair {
  Outbox outbox{run, "env", 1, {environment_topic}, 4};
  Inbox inbox{{environment_topic}};
};

TEST(Inbox, IsCompleteWithTheLastMessageOfATick) {
  Pair p;
  const auto messages = packed(p.outbox, 0, {environment(0, 1), environment(0, 2)});
  p.inbox.accept(messages[0]);
  EXPECT_FALSE(p.inbox.complete(0));
  p.inbox.accept(messages[1]);
  EXPECT_TRUE(p.inbox.complete(0));
  EXPECT_FALSE(p.inbox.complete(1));
  EXPECT_EQ(p.inbox.take(0).size(), 2u);
}

TEST(Inbox, IsCompleteWhenThereIsNothingToSay) {
  Pair p;
  p.inbox.accept(packed(p.outbox, 0, {})[0]);
  EXPECT_TRUE(p.inbox.complete(0));
  EXPECT_TRUE(p.inbox.take(0).empty());
}

TEST(Inbox, PutsMessagesInOrderAndIgnoresDuplicates) {
  Pair p;
  const auto m = packed(p.outbox, 0, {environment(0, 1), environment(0, 2), environment(0, 3)});
  for (const int i : {2, 1, 2, 1, 0, 0, 2}) p.inbox.accept(m[std::size_t(i)]);
  const auto taken = p.inbox.take(0);
  ASSERT_EQ(taken.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(sun_x_m(taken[i]), double(i + 1));
  EXPECT_EQ(p.inbox.duplicates(), 4u);
}

TEST(Inbox, KnowsWhatIsMissingAndTakesItFromTheOutbox) {
  Pair p;
  packed(p.outbox, 0, {environment(0, 1)});  // lost
  for (const auto& m : packed(p.outbox, 1, {environment(1, 2)})) p.inbox.accept(m);
  const auto wants = p.inbox.wanted(0);
  ASSERT_EQ(wants.size(), 1u);
  EXPECT_TRUE(wants[0].gap);
  EXPECT_EQ(wants[0].from_sequence, 1u);
  for (const auto& frames : p.outbox.since(wants[0].topic, wants[0].from_sequence))
    p.inbox.accept(through_the_wire(frames));
  EXPECT_TRUE(p.inbox.complete(1));
  EXPECT_EQ(sun_x_m(p.inbox.take(0).at(0)), 1);
  EXPECT_EQ(sun_x_m(p.inbox.take(1).at(0)), 2);
}

TEST(Inbox, AClosedTopicKeepsNobodyWaiting) {
  Pair p;
  for (const auto& m : packed(p.outbox, 0, {environment(0, 1)})) p.inbox.accept(m);
  for (const auto& m : packed(p.outbox, 1, {environment(1, 1)})) p.inbox.accept(m);
  p.inbox.close(environment_topic, 1);
  EXPECT_TRUE(p.inbox.complete(50));
  EXPECT_EQ(p.inbox.take(0).size(), 1u);
  EXPECT_EQ(p.inbox.take(1).size(), 0u);  // said, but not by everybody heard
}

TEST(Inbox, HandsOverInTheOrderOfConsumption) {
  Inbox inbox({"b", "a"});
  const auto message = [](const std::string& topic, double x) {
    Message m = environment(0, x);
    const Envelope envelope{
        .sequence = 1, .kind = MessageKind::environment_state, .last_of_tick = true};
    return Received{topic, envelope, m.state};
  };
  inbox.accept(message("a", 1));
  inbox.accept(message("b", 2));
  const auto taken = inbox.take(0);
  EXPECT_EQ(taken.at(0).topic, "b");
  EXPECT_EQ(taken.at(1).topic, "a");
}

TEST(Inbox, ATopicWithADelayIsNeededAndTakenLater) {
  Pair p;
  p.inbox.set_delay(environment_topic, 2, 2);
  p.inbox.begin_at(0, 0, false);
  EXPECT_TRUE(p.inbox.complete(1));
  EXPECT_FALSE(p.inbox.complete(2));
  EXPECT_TRUE(p.inbox.wanted(1).empty());
  for (Tick tick = 0; tick < 2; ++tick)
    for (const Received& m : packed(p.outbox, tick, {environment(tick, double(tick))}))
      p.inbox.accept(m);
  EXPECT_TRUE(p.inbox.take(1).empty());
  EXPECT_TRUE(p.inbox.complete(3));
  EXPECT_FALSE(p.inbox.complete(4));
  const auto taken = p.inbox.take(2);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].tick, 0);
  EXPECT_EQ(p.inbox.take(3).size(), 1u);
}

TEST(Inbox, OfATopicWithADelayTheLastTicksBeforeAreNeededAgain) {
  Inbox inbox({environment_topic, "detection/a"});
  inbox.set_delay(environment_topic, 3, 3);
  inbox.begin_at(5, 8, false);
  EXPECT_EQ(inbox.begins_at(environment_topic), 5);
  EXPECT_EQ(inbox.begins_at("detection/a"), 5);
  inbox.begin_at(6, 6, false);
  EXPECT_EQ(inbox.begins_at(environment_topic), 3);
  EXPECT_EQ(inbox.begins_at("detection/a"), 6);
}

TEST(Inbox, AProbeMeansHeardAndNothingElse) {
  Pair p;
  EXPECT_FALSE(p.inbox.probed());
  p.inbox.accept(through_the_wire(p.outbox.probes().at(0)));
  EXPECT_TRUE(p.inbox.probed());
  EXPECT_FALSE(p.inbox.complete(0));
}

TEST(Outbox, KeepsTheTicksThatSomebodyMayAskFor) {
  Outbox outbox(run, "env", 1, {environment_topic}, 4);
  for (Tick tick = 0; tick < 10; ++tick) outbox.pack(tick, {environment(tick, 1)});
  const auto kept = outbox.since(environment_topic, 0);
  ASSERT_EQ(kept.size(), 4u);
  EXPECT_EQ(through_the_wire(kept[0]).envelope.tick, 6);
  EXPECT_TRUE(outbox.since("state/other", 0).empty());
}

TEST(Outbox, SaysNothingBetweenTheTicksOfATopic) {
  Outbox outbox(run, "env", 1, {environment_topic}, 4);
  outbox.set_schedule(environment_topic, {.period = 3});
  Inbox inbox({environment_topic});
  inbox.set_schedule(environment_topic, {.period = 3});
  for (Tick tick = 0; tick < 7; ++tick) {
    const bool due = tick % 3 == 0;
    EXPECT_EQ(inbox.complete(tick), !due);
    std::vector<Message> messages;
    if (tick == 3) messages.push_back(environment(tick, 1));
    const auto packed_now = packed(outbox, tick, messages);
    EXPECT_EQ(packed_now.size(), due ? 1u : 0u);  // a watermark where there is nothing to say
    EXPECT_EQ(outbox.tally().topics.size(), packed_now.size());
    for (const Received& message : packed_now) inbox.accept(message);
    EXPECT_TRUE(inbox.complete(tick));
  }
  EXPECT_THROW(outbox.pack(7, {environment(7, 1)}), Error);
}

TEST(Outbox, RefusesAForeignTopicAndAnotherTick) {
  Outbox outbox(run, "env", 1, {environment_topic}, 4);
  Message foreign = environment(0, 1);
  foreign.topic = objects_topic;
  EXPECT_THROW(outbox.pack(0, {foreign}), Error);
  EXPECT_THROW(outbox.pack(0, {environment(1, 1)}), Error);
}

}  // namespace
}  // namespace dmise
