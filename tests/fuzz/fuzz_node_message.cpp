// Hostile words for the time-master, decoded and judged as it does, into its state machine: what a
// process may say in any order, from any connection. Input: parts of connection, time that passes,
// and a NodeMessage.
#include <google/protobuf/stubs/logging.h>

#include "core/base/printable.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/peer_directory.h"
#include "tests/fuzz/chunks.h"
#include "time-master/master_messages.h"

namespace {

using namespace dmise;

// Texts that are none are refused; the library would also print each.
[[maybe_unused]] const auto printing = google::protobuf::SetLogHandler(nullptr);
using std::chrono::milliseconds;

const std::vector<std::string>& names() {
  static const std::vector<std::string> all{"broker", "orbit", "camera"};
  return all;
}

CoordinatorOptions options(std::uint8_t choice) {
  CoordinatorOptions o;
  o.expected = names();
  o.last_tick = 9;
  o.window_ticks = 1 + choice % 3;
  o.on_silent = SilentPolicy(choice / 4 % 3);
  o.heartbeat = milliseconds(250);
  o.stalled_after = choice & 64 ? milliseconds(9000) : milliseconds(0);
  o.progress_after = choice & 128 ? milliseconds(3000) : milliseconds(0);
  return o;
}

struct Master {
  explicit Master(std::uint8_t choice) : coordinator(options(choice)) {}

  void hear(const std::string& sender, const v1::NodeMessage& message) {
    if (fault_of(message)) return;
    const std::string& name = directory.name_of(sender);
    switch (message.body_case()) {
      case v1::NodeMessage::kJoin:
        if (!coordinator.join(request_of(message.join()), now))
          directory.add(sender, coordinator.members().at(message.join().name()).incarnation,
                        message.join(), 0);
        break;
      case v1::NodeMessage::kReady:
        coordinator.ready(name, now);
        break;
      case v1::NodeMessage::kDone:
        coordinator.done(name, tally_of(message.done()), now);
        break;
      case v1::NodeMessage::kHeartbeat:
        coordinator.heartbeat(message.heartbeat().name(), message.heartbeat().computing(),
                              message.heartbeat().progress(), now);
        break;
      case v1::NodeMessage::kLeave:
        coordinator.leave(name, message.leave().interrupted(), now);
        break;
      case v1::NodeMessage::kFailed:
        coordinator.fail(name, printable(message.failed().reason()));
        break;
      case v1::NodeMessage::kControl:
        apply(message.control(), coordinator, now);
        break;
      default:
        break;
    }
  }

  /// What it says after that must have a meaning.
  void answer() {
    v1::MasterMessage message;
    describe(message.mutable_grant(), 1, coordinator);
    for (const auto& [name, member] : coordinator.members())
      for (const TickTally& tally : member.manifests)
        for (const TopicTally& topic : tally.topics)
          if (topic.topic == "state" || topic.topic == "image")
            add_published(message.mutable_grant(), tally.tick, topic);
    if (fault_of(message)) __builtin_trap();
    if (coordinator.topology_version() != told) {
      told = coordinator.topology_version();
      for (const auto& [name, peer] : directory.all()) {
        *message.mutable_topology() = topology_for(name, directory.topology(), coordinator);
        if (fault_of(message)) __builtin_trap();
      }
    }
  }

  Coordinator coordinator;
  PeerDirectory directory;
  Instant now{0};
  std::uint64_t told = 0;
};

/// Parts of a run as it should be.
const std::vector<std::string>& words() {
  static const auto all = [] {
    std::vector<std::string> parts;
    const auto add = [&](std::size_t sender, const auto& fill) {
      v1::NodeMessage message;
      fill(message);
      parts.push_back(std::string(1, static_cast<char>(sender)) + '\x05' +
                      message.SerializeAsString());
    };
    for (std::size_t i = 0; i < names().size(); ++i) {
      add(i, [&](auto& m) {
        m.mutable_join()->set_name(names()[i]);
        if (i == 0) m.mutable_join()->mutable_broker()->set_publish_endpoint("tcp://127.0.0.1:5");
        if (i == 1) m.mutable_join()->add_produces("state");
        if (i == 2) m.mutable_join()->add_produces("image");
        if (i == 2) m.mutable_join()->add_consumes("state");
        if (i == 2) m.mutable_join()->set_look_back_ticks(2);
        m.mutable_join()->set_resend_endpoint("tcp://127.0.0.1:6");
      });
      add(i, [&](auto& m) { m.mutable_ready(); });
      add(i, [&](auto& m) {
        m.mutable_heartbeat()->set_name(names()[i]);
        m.mutable_heartbeat()->set_incarnation(1);
        m.mutable_heartbeat()->set_computing(i == 2);
      });
      add(i, [&](auto& m) { m.mutable_leave()->set_interrupted(i == 1); });
      for (Tick tick = 0; tick < 4 && i > 0; ++tick)
        add(i, [&](auto& m) {
          m.mutable_done()->set_tick(tick);
          auto* published = m.mutable_done()->add_published();
          published->set_topic(i == 1 ? "state" : "image");
          published->set_messages(1);
          published->set_last_sequence(std::uint64_t(tick) + 1);
          published->set_digest(7);
        });
    }
    add(3, [&](auto& m) {
      m.mutable_join()->set_name("watcher");
      m.mutable_join()->set_observer(true);
      m.mutable_join()->add_consumes("state");
    });
    add(3, [&](auto& m) { m.mutable_hello(); });
    add(2, [&](auto& m) { m.mutable_failed()->set_reason("no light"); });
    for (int action = 1; action <= 5; ++action)
      add(3, [&](auto& m) { m.mutable_control()->set_action(v1::Control::Action(action)); });
    return parts;
  }();
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  Master master(data[0]);
  Tick granted = -1, settled = -1;
  bool over = false;
  v1::NodeMessage message;
  for (const std::string_view part : fuzz::cut(fuzz::view(data + 1, size - 1), 16)) {
    if (part.size() < 2) continue;
    master.now += milliseconds(20 * std::uint8_t(part[1]));
    if (std::uint8_t(part[1]) > 128) master.coordinator.check(master.now);
    if (!message.ParseFromArray(part.data() + 2, int(part.size() - 2))) continue;
    const std::string sender(1, static_cast<char>(part[0] & 3));
    if (part[0] & 8) master.coordinator.suspect(master.directory.name_of(sender), master.now);
    master.hear(sender, message);
    master.answer();
    const Coordinator& run = master.coordinator;
    if (run.granted() < granted || run.settled() < settled || run.settled() > run.granted() ||
        run.granted() > run.options().last_tick || (over && !run.over()))
      __builtin_trap();
    granted = run.granted(), settled = run.settled(), over = run.over();
  }
  v1::Endpoints endpoints;
  describe(&endpoints, master.coordinator);
  master.directory.describe(&endpoints);
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (size < 2 || seed % 64 == 0) {  // all join and are ready
    std::string input(1, static_cast<char>(seed >> 8));
    for (const std::size_t i : {0, 4, 12, 1, 5, 13})
      if (i < words().size()) fuzz::append(input, words()[i]);
    if (fuzz::place(input, data, &size, max_size)) return size;
  }
  if (seed % 4 == 1) {  // something more is said
    std::string input(fuzz::view(data, size));
    fuzz::append(input, words()[seed / 4 % words().size()]);
    if (fuzz::place(input, data, &size, max_size)) return size;
  }
  if (seed % 4 == 0 || size < 2) return LLVMFuzzerMutate(data, size, max_size);
  return 1 + fuzz::mutate_part(data + 1, size - 1, max_size - 1, seed / 4);
}
