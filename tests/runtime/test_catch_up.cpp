// How a process finds its place in what is being said already, and how a lost message is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/base/error.h"
#include "nodes/runtime/protocol/inbox.h"
#include "nodes/runtime/protocol/outbox.h"

namespace dmise {
namespace {

const RunFacts run{.run_id = 7, .tick_length = {1000}, .last_tick = 100};

Message states(Tick tick) {
  ObjectStates states{.tick = tick, .time = run.time_of(tick), .count = 1};
  states.position_m = {7e6, double(tick), 0};
  states.slope_m_per_s = states.velocity_m_per_s = {0, 7e3, 0};
  states.code = {0};
  return {objects_topic, tick, std::make_shared<const State>(states)};
}

Message roster(Tick tick) {
  ObjectRoster roster;
  roster.objects.push_back({.catalogue_number = 5, .name = "VANGUARD 1"});
  return {objects_topic, tick, std::make_shared<const State>(roster)};
}

/// A publisher of states, roster first, that keeps three ticks.
struct Publisher {
  explicit Publisher(std::uint64_t incarnation = 1, Tick first = 0)
      : outbox(run, "orbit", incarnation, {objects_topic}, 3), receiver(run), next(first) {
    receiver.allow(objects_topic, "orbit", incarnation);
  }
  Received received(const SharedFrames& frames) {
    std::vector<std::string_view> views{frames->topic, frames->envelope, frames->payload};
    if (!frames->arrays.empty()) views.push_back(frames->arrays);
    const auto message = receiver.receive(views);
    EXPECT_TRUE(message) << receiver.last_refusal();
    return *message;
  }
  /// Publishes the next tick.
  std::vector<Received> step() {
    std::vector<Message> messages;
    if (first_step) messages.push_back(roster(next));
    first_step = false;
    messages.push_back(states(next));
    std::vector<Received> all;
    for (const auto& frames : outbox.pack(next++, messages)) all.push_back(received(frames));
    return all;
  }
  void answer(Inbox& inbox, Tick from_tick) {
    for (const auto& frames : outbox.catch_up(objects_topic, from_tick))
      inbox.accept(received(frames));
  }
  Outbox outbox;
  Receiver receiver;
  Tick next;
  bool first_step = true;
};

std::vector<Tick> ticks_of(const std::vector<Message>& messages) {
  std::vector<Tick> ticks;
  for (const Message& m : messages) ticks.push_back(m.tick);
  return ticks;
}

using testing::ElementsAre;

TEST(CatchUp, BringsTheRosterAndTheTicksAskedFor) {
  Publisher orbit;
  for (int i = 0; i < 10; ++i) orbit.step();  // ticks 7, 8, 9 are kept
  Inbox inbox({objects_topic});
  inbox.begin_at(8, 8, true);
  EXPECT_FALSE(inbox.complete(7));
  orbit.answer(inbox, 8);
  EXPECT_TRUE(inbox.complete(9));
  EXPECT_FALSE(inbox.complete(10));
  const auto messages = inbox.take(9);
  EXPECT_THAT(ticks_of(messages), ElementsAre(0, 8, 9));
  EXPECT_TRUE(std::holds_alternative<ObjectRoster>(*messages[0].state));
}

TEST(CatchUp, JoinsWithoutAGapOrADoubleToWhatIsPublishedMeanwhile) {
  for (const bool answer_first : {true, false}) {
    Publisher orbit;
    for (int i = 0; i < 10; ++i) orbit.step();
    Inbox inbox({objects_topic});
    inbox.begin_at(8, 8, true);
    const auto answer = orbit.outbox.catch_up(objects_topic, 8);
    if (!answer_first)
      for (const auto& m : orbit.step()) inbox.accept(m);  // tick 10 comes before the answer
    for (const auto& frames : answer) inbox.accept(orbit.received(frames));
    if (answer_first)
      for (const auto& m : orbit.step()) inbox.accept(m);
    EXPECT_THAT(ticks_of(inbox.take(10)), ElementsAre(0, 8, 9, 10));
  }
}

TEST(CatchUp, WithAPublisherThatIsJustBeginningAgain) {
  Publisher orbit(2, 6);
  Inbox inbox({objects_topic});
  inbox.begin_at(8, 8, true);
  orbit.answer(inbox, 8);  // it has said nothing yet
  for (int i = 0; i < 4; ++i)
    for (const auto& m : orbit.step()) inbox.accept(m);
  EXPECT_TRUE(inbox.complete(9));
  EXPECT_THAT(ticks_of(inbox.take(9)), ElementsAre(6, 8, 9));  // 6: the roster
}

TEST(CatchUp, WhoMayMissGoesOnWhereThePublisherStillIs) {
  Publisher orbit;
  for (int i = 0; i < 10; ++i) orbit.step();
  Inbox inbox({objects_topic});
  orbit.answer(inbox, 2);
  EXPECT_EQ(inbox.missed(), 7u);  // states of ticks 0 to 6
  EXPECT_THAT(ticks_of(inbox.take(9)), ElementsAre(0, 7, 8, 9));
}

TEST(Restart, OfAPublisherChangesNothingOfWhatWasTaken) {
  Publisher first;
  Inbox inbox({objects_topic});
  for (int i = 0; i < 4; ++i)
    for (const auto& m : first.step()) inbox.accept(m);
  EXPECT_EQ(inbox.take(2).size(), 4u);
  inbox.restart(objects_topic);
  Publisher second(2, 1);                     // does ticks 1.. again, for somebody who is behind
  for (int i = 0; i < 2; ++i) second.step();  // not heard
  EXPECT_EQ(inbox.wanted(4).at(0).from_tick, 4);
  second.answer(inbox, 4);
  for (int i = 0; i < 2; ++i)
    for (const auto& m : second.step()) inbox.accept(m);
  EXPECT_TRUE(inbox.complete(4));
  EXPECT_FALSE(inbox.complete(5));
  EXPECT_THAT(ticks_of(inbox.take(4)), ElementsAre(3, 4));  // the roster is known
}

// It has forgotten the ticks with which it began: they were for others.
TEST(Restart, OfAPublisherThatHasMovedOn) {
  Publisher first;
  Inbox inbox({objects_topic});
  for (int i = 0; i < 8; ++i)
    for (const auto& m : first.step()) inbox.accept(m);
  inbox.take(7);
  inbox.restart(objects_topic);
  Publisher second(2, 4);
  for (int i = 0; i < 6; ++i) second.step();  // to tick 9; 7, 8, 9 are kept
  second.answer(inbox, *inbox.wanted(8).at(0).from_tick);
  EXPECT_THAT(ticks_of(inbox.take(9)), ElementsAre(8, 9));
}

/// Asked before its first step where it is, a publisher names its first message, of a tick that
/// need not be known again; then all that it publishes is lost, and it keeps that no more.
void lose_the_beginning(Publisher& again, Inbox& inbox, Tick from_tick) {
  again.answer(inbox, from_tick);
  for (int i = 0; i < 4; ++i) again.step();
  ASSERT_EQ(inbox.wanted(from_tick).size(), 1u);
  EXPECT_EQ(inbox.wanted(from_tick)[0].from_sequence, 1u);
  EXPECT_FALSE(inbox.wanted(from_tick)[0].from_tick);
  for (const auto& frames : again.outbox.since(objects_topic, 1))
    inbox.accept(again.received(frames));
  EXPECT_FALSE(inbox.complete(from_tick));
  EXPECT_EQ(inbox.wanted(from_tick)[0].from_tick, from_tick);
  again.answer(inbox, from_tick);
}

TEST(Restart, OfAPublisherThatNoLongerKeepsWhatIsKnown) {
  Publisher orbit;
  Inbox inbox({objects_topic});
  for (int i = 0; i < 8; ++i)
    for (const Received& message : orbit.step()) inbox.accept(message);
  inbox.take(7);
  inbox.restart(objects_topic);
  Publisher again(2, 6);
  lose_the_beginning(again, inbox, 8);  // ticks 7, 8, 9 are kept
  EXPECT_TRUE(inbox.complete(9));
  EXPECT_THAT(ticks_of(inbox.take(9)), ElementsAre(8, 9));
  EXPECT_EQ(inbox.missed(), 0u);
}

TEST(Restart, OfBothBringsTheRosterThatIsNoLongerKept) {
  Inbox inbox({objects_topic});
  inbox.begin_at(8, 8, true);
  Publisher again(2, 6);
  lose_the_beginning(again, inbox, 8);
  EXPECT_THAT(ticks_of(inbox.take(9)), ElementsAre(6, 8, 9));  // the roster first
  EXPECT_EQ(inbox.missed(), 0u);
}

TEST(Manifest, ShowsALostMessageThatNothingFollows) {
  Publisher orbit;
  Inbox inbox({objects_topic});
  const auto messages = orbit.step();
  inbox.accept(messages[0]);  // the last of the tick is lost
  EXPECT_FALSE(inbox.wanted(0).at(0).gap);
  inbox.published(orbit.outbox.tally().topics.at(0), 0);
  EXPECT_TRUE(inbox.wanted(0).at(0).gap);
  EXPECT_EQ(inbox.wanted(0).at(0).from_sequence, 2u);
  inbox.accept(messages[1]);
  EXPECT_TRUE(inbox.wanted(0).empty());
}

TEST(Manifest, RefusesATickThatIsNotWhatWasPublished) {
  for (const bool said_before : {true, false}) {
    Publisher orbit;
    Inbox inbox({objects_topic});
    const auto messages = orbit.step();
    TopicTally tally = orbit.outbox.tally().topics.at(0);
    EXPECT_EQ(tally.messages, 1u);  // the roster is not of this tick alone
    tally.digest ^= 1;
    const auto hear = [&] {
      if (said_before) inbox.published(tally, 0);
      for (const auto& m : messages) inbox.accept(m);
      if (!said_before) inbox.published(tally, 0);
    };
    EXPECT_THROW(hear(), Error);
  }
}

using Way = Inbox::Way;

// Not before the publisher's word is heard, which comes another way.
TEST(Manifest, IsWhatMakesAMessageThroughTheBrokerCount) {
  Publisher orbit;
  Inbox inbox({objects_topic});
  for (const auto& m : orbit.step()) inbox.accept(m, Way::broker);
  EXPECT_FALSE(inbox.complete(0));
  ASSERT_EQ(inbox.wanted(0).size(), 1u);
  EXPECT_FALSE(inbox.wanted(0)[0].gap);
  inbox.published(orbit.outbox.tally().topics.at(0), 0);
  EXPECT_TRUE(inbox.complete(0));
  EXPECT_THAT(ticks_of(inbox.take(0)), ElementsAre(0, 0));
}

TEST(Manifest, IsNotNeededOfWhatThePublisherItselfSends) {
  for (const Way way : {Way::direct, Way::answer}) {
    Publisher orbit;
    Inbox inbox({objects_topic});
    for (const auto& m : orbit.step()) inbox.accept(m, way);
    EXPECT_TRUE(inbox.complete(0));
  }
}

/// A message in a publisher's name that a receiver takes.
Received forged(Publisher& orbit, Envelope envelope, const std::optional<Message>& content = {}) {
  envelope.run_id = run.run_id;
  envelope.publisher = "orbit";
  envelope.time = run.time_of(envelope.tick);
  Outbox other(run, "orbit", 1, {objects_topic}, 3);
  std::string payload, arrays;
  if (content) {
    const auto frames = other.pack(content->tick, {*content}).at(0);
    payload = frames->payload, arrays = frames->arrays;
  }
  return orbit.received(std::make_shared<const Frames>(
      seal(objects_topic, envelope, std::move(payload), std::move(arrays))));
}

// A property: whatever is forged at whatever moment, what is taken is what was published.
TEST(Manifest, KeepsEveryForgeryOut) {
  std::mt19937 random(12);
  const auto any = [&](int below) { return int(random() % unsigned(below)); };
  std::uint64_t thrown_away = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Publisher orbit;
    Inbox inbox({objects_topic});
    Tick taken = -1;
    const auto ask = [&] {
      for (const auto& want : inbox.wanted(taken + 1))
        for (const auto& frames : want.from_tick
                                      ? orbit.outbox.catch_up(objects_topic, *want.from_tick)
                                      : orbit.outbox.since(objects_topic, want.from_sequence))
          inbox.accept(orbit.received(frames));
    };
    for (Tick tick = 0; tick < 6; ++tick) {
      std::vector<Received> messages = orbit.step();
      for (int i = any(4); i > 0; --i) {
        const Tick when = any(9);
        Envelope envelope{.sequence = std::uint64_t(1 + any(12)), .tick = when};
        envelope.last_of_tick = any(2) == 0;
        const MessageKind kinds[] = {MessageKind::position, MessageKind::watermark,
                                     MessageKind::object_states};
        envelope.kind = kinds[any(3)];
        std::optional<Message> content;
        if (envelope.kind == MessageKind::object_states) {
          ObjectStates other = std::get<ObjectStates>(*states(when).state);
          other.position_m[0] = 8e6;
          content = Message{objects_topic, when, std::make_shared<const State>(other)};
        }
        messages.insert(messages.begin() + any(int(messages.size()) + 1),
                        forged(orbit, envelope, content));
      }
      const bool told_first = any(2) == 0;
      const auto tell = [&] { inbox.published(orbit.outbox.tally().topics.at(0), tick); };
      if (told_first) tell();
      for (const auto& m : messages) inbox.accept(m, Way::broker);
      if (!told_first) tell();
      for (int i = 0; i < 3 && !inbox.complete(tick); ++i) ask();
      ASSERT_TRUE(inbox.complete(tick)) << trial << " at " << tick;
      EXPECT_FALSE(inbox.complete(tick + 1));
      for (const Message& m : inbox.take(tick)) {
        if (std::holds_alternative<ObjectRoster>(*m.state)) continue;
        EXPECT_EQ(m.tick, tick);
        EXPECT_EQ(std::get<ObjectStates>(*m.state).position_m[0], 7e6);
      }
      taken = tick;
    }
    thrown_away += inbox.forged();
  }
  EXPECT_GT(thrown_away, 1000u);
}

TEST(Manifest, IsTheSameWhateverProcessPublishes) {
  Publisher first, second(2);
  first.step();
  second.step();
  const auto& a = first.outbox.tally().topics.at(0);
  const auto& b = second.outbox.tally().topics.at(0);
  EXPECT_TRUE(a.same_content(b));
  second.step();
  EXPECT_FALSE(a.same_content(second.outbox.tally().topics.at(0)));
}

TEST(Schedule, ATopicIsCompleteBetweenTheTicksOfItsPublisher) {
  Inbox inbox({objects_topic});
  inbox.set_schedule(objects_topic, {.period = 4, .offset = 2});
  EXPECT_TRUE(inbox.complete(1));
  EXPECT_FALSE(inbox.complete(2));
  Publisher orbit(1, 2);
  for (const auto& m : orbit.step()) inbox.accept(m);
  EXPECT_TRUE(inbox.complete(5));
  EXPECT_FALSE(inbox.complete(6));
}

}  // namespace
}  // namespace dmise
