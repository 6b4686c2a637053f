// Hostile words of a time-master, decoded and judged as a node does, into its inbox. Input: parts
// of a first byte and a MasterMessage; where the byte is 1, a message that came over a topic
// instead.
#include <google/protobuf/stubs/logging.h>

#include "core/base/error.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/inbox.h"
#include "tests/fuzz/chunks.h"

namespace {

using namespace dmise;

// Texts that are none are refused; the library would also print each.
[[maybe_unused]] const auto printing = google::protobuf::SetLogHandler(nullptr);

struct Node {
  void hear(const v1::MasterMessage& message) {
    if (fault_of(message)) return;
    if (message.has_welcome()) {
      run = {
          message.welcome().run_id(), {message.welcome().tick_ns()}, message.welcome().last_tick()};
      if (run.time_of(run.last_tick) < SimTime{0}) __builtin_trap();
    } else if (message.has_topology()) {
      for (const v1::Publisher& publisher : message.topology().publishers())
        for (const std::string& topic : publisher.topics()) {
          inbox.set_schedule(topic, {std::max<Tick>(1, Tick(publisher.period_ticks())),
                                     Tick(publisher.offset_ticks())});
          if (publisher.incarnation() > 1) inbox.restart(topic);
        }
      if (!started)
        inbox.begin_at(message.topology().from_tick(), message.topology().resume_tick(),
                       message.topology().running());
      started = true;
    } else if (message.has_grant()) {
      for (const auto& topic : message.grant().closed())
        inbox.close(topic.topic(), topic.from_tick());
      for (const auto& said : message.grant().published())
        inbox.published({said.topic(), said.messages(), said.last_sequence(), said.digest()},
                        said.tick());
      granted = std::max<Tick>(granted, message.grant().tick());
    }
  }

  /// A watermark or POSITION, as the receiver lets it in.
  void hear_topic(std::string_view bytes) {
    if (bytes.size() < 4) return;
    const auto at = [&](std::size_t i) { return std::uint8_t(bytes[i]); };
    Received message;
    message.topic = at(0) % 2 ? "state" : "env";
    message.envelope.kind = at(0) & 2   ? MessageKind::position
                            : at(0) & 4 ? MessageKind::probe
                                        : MessageKind::watermark;
    message.envelope.sequence = 1u + at(1);
    message.envelope.tick = std::min<Tick>(at(2), run.last_tick);
    message.envelope.last_of_tick = at(3) % 2;
    inbox.accept(message);
  }

  void work() {
    for (; done < granted && done < 300 && inbox.complete(done + 1); ++done) {
      inbox.take(done + 1);
      if (!inbox.wanted(done + 1).empty()) __builtin_trap();
    }
    if (!inbox.complete(done + 1) && inbox.wanted(done + 1).empty()) __builtin_trap();
  }

  RunFacts run{1, {1'000'000'000}, 300};
  Inbox inbox{{"state", "env"}};
  Tick granted = -1, done = -1;
  bool started = false;
};

const std::vector<std::string>& words() {
  static const auto all = [] {
    std::vector<std::string> parts;
    const auto add = [&](const auto& fill) {
      v1::MasterMessage message;
      fill(message);
      parts.push_back('\0' + message.SerializeAsString());
    };
    add([](auto& m) {
      auto* welcome = m.mutable_welcome();
      welcome->set_run_id(1), welcome->set_incarnation(1), welcome->set_tick_ns(1'000'000'000);
      welcome->set_last_tick(99), welcome->set_window_ticks(2), welcome->set_heartbeat_s(0.25);
      welcome->set_silent_after_s(5), welcome->set_tick_endpoint("tcp://127.0.0.1:5");
    });
    add([](auto& m) { m.mutable_refuse()->set_reason("taken"); });
    for (const int process : {1, 2})
      add([&](auto& m) {
        m.mutable_topology()->set_publish_endpoint("tcp://127.0.0.1:7");
        m.mutable_topology()->set_running(process == 2);
        auto* publisher = m.mutable_topology()->add_publishers();
        publisher->set_name("orbit"), publisher->set_incarnation(std::uint64_t(process));
        publisher->add_topics("state"), publisher->set_keep_ticks(4);
        publisher->set_period_ticks(std::uint64_t(process));
      });
    for (const Tick tick : {0, 1, 7})
      add([&](auto& m) {
        m.mutable_grant()->set_run_id(1), m.mutable_grant()->set_tick(tick);
        m.mutable_grant()->set_phase(v1::PHASE_RUNNING);
        for (const char* topic : {"state", "env"}) {
          auto* said = m.mutable_grant()->add_published();
          said->set_topic(topic), said->set_tick(tick), said->set_messages(1);
          said->set_last_sequence(std::uint64_t(tick) + 1);
          said->set_digest(fold_digest(0, 0));
        }
        if (tick == 7) m.mutable_grant()->add_closed()->set_topic("env");
      });
    add([](auto& m) { m.mutable_endpoints()->set_granted_tick(3); });
    for (char tick = 0; tick < 3; ++tick)
      for (const char topic : {0, 1, 2}) parts.push_back(std::string{1, topic, tick, tick, 1});
    return parts;
  }();
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Node node;
  v1::MasterMessage message;
  try {
    for (const std::string_view part : fuzz::cut(fuzz::view(data, size), 16)) {
      if (part.empty()) continue;
      if (part[0] == 1)
        node.hear_topic(part.substr(1));
      else if (message.ParseFromArray(part.data() + 1, int(part.size() - 1)))
        node.hear(message);
      node.work();
    }
  } catch (const Error&) {
    // What came differs from its publisher's manifest: the node ends there.
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (size < 2 || seed % 4 == 1) {
    std::string input(fuzz::view(data, size));
    fuzz::append(input, words()[seed / 4 % words().size()]);
    if (fuzz::place(input, data, &size, max_size)) return size;
  }
  return seed % 4 == 0 ? LLVMFuzzerMutate(data, size, max_size)
                       : fuzz::mutate_part(data, size, max_size, seed / 4);
}
