// A whole network in one process: master, broker and nodes as threads, over real sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "nodes/runtime/master_link/master_link.h"
#include "nodes/runtime/transport/socket.h"
#include "tests/runtime/network_threads.h"
#include "tests/runtime/toy.h"

namespace dmise {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

/// What a broker of a test makes of a message on its way: sends it to `subscribers`, or whatever.
using PassOn =
    std::function<void(zmq::socket_t& subscribers, const std::shared_ptr<Frames>& frames)>;

/// A broker that does with messages what it likes.
void serve(const std::string& master, const PassOn& pass_on) {
  zmq::context_t context(1);
  auto publishers = make_socket(context, zmq::socket_type::xsub, max_data_bytes);
  auto subscribers = make_socket(context, zmq::socket_type::xpub, max_data_bytes);
  v1::Join join;
  join.set_name(broker_name);
  join.mutable_broker()->set_publish_endpoint(bind_to(publishers, "tcp://127.0.0.1:0"));
  join.mutable_broker()->set_subscribe_endpoint(bind_to(subscribers, "tcp://127.0.0.1:0"));
  MasterLink link(context, master, nullptr);
  link.join(join, std::chrono::seconds(10));
  link.keep({}, std::nullopt);

  while (!link.over()) {
    link.wait({&publishers, &subscribers}, std::chrono::milliseconds(100));
    for (auto m = receive(subscribers); !m.empty(); m = receive(subscribers))
      publishers.send(m[0], zmq::send_flags::none);
    for (auto m = receive(publishers); !m.empty(); m = receive(publishers))
      pass_on(subscribers,
              std::make_shared<Frames>(Frames{m[0].to_string(), m[1].to_string(), m[2].to_string(),
                                              m.size() > 3 ? m[3].to_string() : ""}));
  }
  link.leave(false, {});
}

Envelope envelope_of(const Frames& frames) {
  std::vector<std::string_view> all{frames.topic, frames.envelope, frames.payload};
  if (!frames.arrays.empty()) all.push_back(frames.arrays);
  return open(all);
}

/// A broker that loses every fifth message, sends every third twice and swaps others.
int serve_badly(const std::string& master) {
  int lost = 0, count = 0;
  std::shared_ptr<Frames> held;
  serve(master, [&](zmq::socket_t& subscribers, const std::shared_ptr<Frames>& frames) {
    const bool probe = envelope_of(*frames).kind == MessageKind::probe;
    if (!probe && ++count % 5 == 0) {
      ++lost;
      return;
    }
    if (!probe && count % 7 == 0 && !held) {
      held = frames;
      return;
    }
    send(subscribers, frames);
    if (count % 3 == 0) send(subscribers, frames);
    if (held) send(subscribers, std::exchange(held, nullptr));
  });
  return lost;
}

/// An orbit, two cameras of which one's name begins like the other's, and who records both.
struct ToyParty {
  explicit ToyParty(std::size_t objects = 20) : orbit(objects) {}

  ToyOrbit orbit;
  ToyCamera a{"a"}, ab{"ab"};
  ToyRecorder recorder{{"a", "ab"}};

  std::string recorded_locally(Tick last_tick) {
    drive({&orbit, &a, &ab, &recorder}, last_tick);
    return recorder.record();
  }
  /// Who is waited for starts last.
  std::vector<std::future<NodeResult>> start_all(const std::string& master, int lose_every = 0) {
    std::vector<std::future<NodeResult>> nodes;
    for (Participant* participant : std::vector<Participant*>{&recorder, &ab, &a, &orbit})
      nodes.push_back(start(*participant, NodeOptions{.master = master, .lose_every = lose_every}));
    return nodes;
  }
};

std::string recorded_by_a_network(Tick last_tick, int window) {
  MasterThread master(run_of({"orbit", "a", "ab", "recorder"}, last_tick, window));
  ToyParty party;
  auto broker = start_broker(master.address);
  for (auto& node : party.start_all(master.address)) {
    const NodeResult result = node.get();
    EXPECT_EQ(result.exit_code, 0) << result.reason;
    EXPECT_EQ(result.refused, 0u) << result.last_refusal;
    EXPECT_EQ(result.done, last_tick);
  }
  EXPECT_EQ(broker.get().exit_code, 0);
  const MasterResult result = master.result.get();
  EXPECT_EQ(result.exit_code, 0) << result.reason;
  EXPECT_EQ(result.times.size(), 5u);
  return party.recorder.record();
}

TEST(Network, GivesTheBytesOfOneProcess) {
  const std::string expected = ToyParty().recorded_locally(200);
  EXPECT_TRUE(recorded_by_a_network(200, 1) == expected);
  EXPECT_TRUE(recorded_by_a_network(200, 4) == expected);
}

TEST(Network, LosesNothingWhenTheBrokerDoes) {
  MasterThread master(run_of({"orbit", "a", "ab", "recorder"}, 60, 4));
  ToyParty party(2000);  // frames large enough to be handed over without a copy
  auto broker = std::async(std::launch::async, [&] { return serve_badly(master.address); });
  std::uint64_t resend_requests = 0;
  for (auto& node : party.start_all(master.address)) {
    const NodeResult result = node.get();
    EXPECT_EQ(result.exit_code, 0) << result.reason;
    resend_requests += result.resend_requests;
  }
  EXPECT_GT(broker.get(), 10);
  EXPECT_GT(resend_requests, 10u);
  EXPECT_TRUE(party.recorder.record() == ToyParty(2000).recorded_locally(60));
}

// In lock-step nothing follows a lost message that could show its absence: only the manifest says
// that it was published, and the next tick waits for it.
TEST(Network, AMessageLostOnItsWayIsKnownInItsTickAndFetchedAgain) {
  MasterThread master(run_of({"orbit", "a", "ab", "recorder"}, 15, 1));
  ToyParty party;
  auto broker = start_broker(master.address);
  std::vector<NodeResult> results;
  for (auto& node : party.start_all(master.address, 3)) results.push_back(node.get());
  for (const NodeResult& result : results) EXPECT_EQ(result.exit_code, 0) << result.reason;
  EXPECT_EQ(broker.get().exit_code, 0);
  for (const std::size_t camera : {1u, 2u}) {  // one message a tick, a roster in the first
    EXPECT_GE(results[camera].lost, 4u);
    EXPECT_GE(results[camera].resend_requests_known + 1, results[camera].lost);
  }
  EXPECT_GT(results[0].lost, 8u);  // truth, from the cameras' own sockets, among them
  EXPECT_TRUE(party.recorder.record() == ToyParty().recorded_locally(15));
}

/// Sends each message as it is, and again: as it was, as of another run, and as of a process that
/// has not joined.
void serve_and_replay(const std::string& master) {
  serve(master, [](zmq::socket_t& subscribers, const std::shared_ptr<Frames>& frames) {
    send(subscribers, frames);
    Envelope envelope = envelope_of(*frames);
    const auto again = [&] {
      send(subscribers, std::make_shared<const Frames>(
                            seal(frames->topic, envelope, frames->payload, frames->arrays)));
    };
    again();
    ++envelope.run_id, again();
    --envelope.run_id, ++envelope.incarnation, again();
  });
}

TEST(Network, WhatIsSaidAgainOrInAnotherRunChangesNothing) {
  MasterThread master(run_of({"orbit", "a", "ab", "recorder"}, 200, 2));
  ToyParty party;
  auto broker = std::async(std::launch::async, [&] { serve_and_replay(master.address); });
  std::uint64_t refused = 0;
  for (auto& node : party.start_all(master.address)) {
    const NodeResult result = node.get();
    EXPECT_EQ(result.exit_code, 0) << result.reason;
    refused += result.refused;
  }
  broker.get();
  EXPECT_GT(refused, 0u);
  EXPECT_TRUE(party.recorder.record() == ToyParty().recorded_locally(200));
}

/// Before each message says in its publisher's name something else that a receiver takes: where
/// the topic is, that all is said, the same with content of another tick, or what comes next.
void serve_and_forge(const std::string& master, int how) {
  std::map<std::string, std::shared_ptr<Frames>> last;
  serve(master, [&](zmq::socket_t& subscribers, const std::shared_ptr<Frames>& frames) {
    const Envelope envelope = envelope_of(*frames);
    Envelope forged = envelope;
    std::string payload, arrays;
    if (how == 0) {
      forged.kind = MessageKind::position;
      forged.sequence = 1'000'000;
    } else if (how == 1) {
      forged.kind = MessageKind::watermark;
      forged.last_of_tick = true;
    } else if (const auto& other = last[frames->topic]; how == 2 && other) {
      payload = other->payload, arrays = other->arrays;
    } else if (how == 3) {
      forged.kind = MessageKind::watermark;
      forged.last_of_tick = true;
      ++forged.sequence;
    }
    if (envelope.kind != MessageKind::probe && envelope.tick > 3) {
      send(subscribers, std::make_shared<const Frames>(
                            seal(frames->topic, forged, std::move(payload), std::move(arrays))));
    }
    last[frames->topic] = frames;
    send(subscribers, frames);
  });
}

// Without keys anybody who reaches the broker may speak in another's name: its manifest shows it.
TEST(Network, WhatIsForgedIsThrownAwayAndItsPublisherAsked) {
  for (const int how : {0, 1, 2, 3}) {
    MasterThread master(run_of({"orbit", "a", "ab", "recorder"}, 12, 2));
    ToyParty party;
    auto broker = std::async(std::launch::async, [&] { serve_and_forge(master.address, how); });
    for (auto& node : party.start_all(master.address)) {
      const NodeResult result = node.get();
      EXPECT_EQ(result.exit_code, 0) << how << ": " << result.reason;
    }
    broker.get();
    EXPECT_TRUE(party.recorder.record() == ToyParty().recorded_locally(12)) << how;
  }
}

// Nothing but the master's word lets anybody publish; observers hear at an endpoint of their own.
TEST(Network, TheBrokerPassesNothingOfAStranger) {
  MasterThread master(run_of({"orbit", "a"}, 3));
  auto broker = start_broker(master.address);
  BrokerEndpoints endpoints;
  while (endpoints.publish.empty()) endpoints = ask_master(master.address, 5).broker;
  zmq::context_t context(1);
  Security guessed;
  guessed.set_password("guessed");
  for (const Security& stranger : {Security(), guessed}) {
    auto publisher = make_socket(context, zmq::socket_type::pub, max_data_bytes);
    auto events = make_socket(context, zmq::socket_type::pair, max_control_bytes);
    const std::string inproc = "inproc://stranger-" + stranger.password();
    ASSERT_EQ(zmq_socket_monitor(publisher.handle(), inproc.c_str(),
                                 ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH |
                                     ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL |
                                     ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_DISCONNECTED),
              0);
    events.connect(inproc);
    connect_to(publisher, endpoints.publish, stranger, broker_name);
    std::vector<zmq::pollitem_t> items{{events.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, std::chrono::seconds(10));
    const auto event = receive(events);
    ASSERT_FALSE(event.empty());
    std::uint16_t what = 0;
    std::memcpy(&what, event[0].data(), sizeof what);
    EXPECT_NE(what, ZMQ_EVENT_HANDSHAKE_SUCCEEDED);
  }
  master.stop.set();
  broker.get();
}

// An observer joins nothing and holds nobody up; a gap would show in the sequence numbers.
TEST(Network, AnObserverHearsTheWholeRunWithoutJoining) {
  MasterThread master(run_of({"orbit", "a"}, 30));
  ToyOrbit orbit;
  ToyCamera camera("a");
  auto broker = start_broker(master.address);
  RunStatus status;
  while (status.broker.observe.empty()) status = ask_master(master.address, 5);
  zmq::context_t context(1);
  auto observer = make_socket(context, zmq::socket_type::sub, max_data_bytes);
  observer.set(zmq::sockopt::subscribe, objects_topic);
  connect_to(observer, status.broker.observe);
  [[maybe_unused]] const auto nodes = {start(orbit, master.address), start(camera, master.address)};

  std::uint64_t sequence = 0;
  for (Tick tick = -1; tick < 30;) {
    std::vector<zmq::pollitem_t> items{{observer.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, std::chrono::seconds(10));
    const auto message = receive(observer);
    ASSERT_FALSE(message.empty()) << "nothing for 10 s";
    const Envelope envelope = open(views(message));
    if (envelope.kind == MessageKind::probe) continue;
    EXPECT_EQ(envelope.sequence, ++sequence);
    tick = envelope.tick;
  }
  EXPECT_EQ(sequence, 32u);  // a roster and 31 states
  EXPECT_EQ(master.result.get().exit_code, 0);
}

TEST(Network, AnObserverThatStopsReadingSlowsNobodyAndSeesItsGap) {
  constexpr Tick last_tick = 120;
  MasterThread master(run_of({"orbit", "a"}, last_tick));
  ToyOrbit orbit(20000);  // 1.5 MB a tick: more than the buffers of a connection hold
  ToyCamera camera("a");
  auto broker = start_broker(master.address, 1);
  RunStatus status;
  while (status.broker.observe.empty()) status = ask_master(master.address, 5);
  zmq::context_t context(1);
  auto observer = make_socket(context, zmq::socket_type::sub, max_data_bytes);
  observer.set(zmq::sockopt::rcvhwm, 1);
  observer.set(zmq::sockopt::subscribe, objects_topic);
  connect_to(observer, status.broker.observe);
  [[maybe_unused]] const auto nodes = {start(orbit, master.address), start(camera, master.address)};
  while (status.granted < last_tick - 20 && status.phase != Phase::failed)
    status = ask_master(master.address, 5);  // and does not read

  std::uint64_t missed = 0, next = 1;
  for (Tick tick = -1; tick < last_tick && missed == 0;) {
    std::vector<zmq::pollitem_t> items{{observer.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, std::chrono::seconds(10));
    const auto message = receive(observer);
    ASSERT_FALSE(message.empty()) << "nothing for 10 s";
    const Envelope envelope = open(views(message));
    if (envelope.kind == MessageKind::probe) continue;
    missed += envelope.sequence - next;
    next = envelope.sequence + 1;
    tick = envelope.tick;
  }
  EXPECT_GT(missed, 0u);
  EXPECT_EQ(master.result.get().exit_code, 0);
}

TEST(Network, RefusesASecondNodeOfOneName) {
  MasterThread master(run_of({"orbit", "a"}, 3));
  ToyOrbit orbit, twin;
  Event stop;
  auto first = start(orbit, master.address, &stop);
  while (ask_master(master.address, 5).nodes.empty()) {
  }
  const NodeResult second = start(twin, master.address).get();
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.reason, HasSubstr("a node named orbit has already joined"));
  stop.set();
  EXPECT_EQ(first.get().reason, "interrupted");
}

TEST(Network, TellsWhoIsMissing) {
  MasterThread master(run_of({"orbit", "a"}, 3));
  EXPECT_THAT(ask_master(master.address, 5).missing, ElementsAre("broker", "orbit", "a"));
  master.stop.set();
  EXPECT_EQ(master.result.get().exit_code, 1);
}

TEST(Network, NodeEndsWhenNoMasterAnswers) {
  ToyOrbit orbit;
  const NodeResult result = run_node(orbit, {.master = "tcp://127.0.0.1:9", .join_within_s = 0.2});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.reason, "no answer from a time-master at tcp://127.0.0.1:9");
}

TEST(Network, MasterNamesAnAddressThatIsTaken) {
  MasterThread first(run_of({"orbit"}, 3));
  MasterOptions second = run_of({"orbit"}, 3);
  second.address = first.address;
  try {
    run_master(second);
    FAIL() << "bound twice";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), first.address + ": address already in use");
  }
}

TEST(Network, AFailingNodeIsTheCauseEverywhere) {
  MasterThread master(run_of({"orbit", "a"}, 50, 2));
  ToyOrbit orbit;
  ToyCamera camera("a");
  camera.on_step = [](Tick tick) {
    if (tick == 7) throw Error("/out/a/frame-000007.fits: no space left on device");
  };
  auto broker = start_broker(master.address);
  auto good = start(orbit, master.address);
  auto bad = start(camera, master.address);
  const std::string cause = "a: /out/a/frame-000007.fits: no space left on device";
  EXPECT_EQ(bad.get().exit_code, 1);
  EXPECT_EQ(good.get().reason, cause);
  EXPECT_EQ(broker.get().reason, cause);
  EXPECT_EQ(master.result.get().reason, cause);
}

}  // namespace
}  // namespace dmise
