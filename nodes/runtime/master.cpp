#include "nodes/runtime/master.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <random>

#include "core/base/error.h"
#include "core/base/text_file.h"
#include "nodes/runtime/master_words.h"
#include "nodes/runtime/peer_directory.h"
#include "nodes/runtime/peer_monitor.h"
#include "nodes/runtime/socket.h"
#include "nodes/runtime/time_split_codec.h"

namespace dmise {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

constexpr milliseconds check_interval{50};
constexpr milliseconds connecting_interval{10};  // grants repeated while subscribers connect
constexpr milliseconds farewell{1700};  // longest wait for nodes to leave a run that is over
constexpr seconds complain_interval{5};

std::uint64_t new_run_id() {
  std::random_device device;
  std::uint64_t id = 0;
  while (id == 0) id = std::uint64_t(device()) << 32 | device();
  return id;
}

CoordinatorOptions with_broker(const MasterOptions& options) {
  CoordinatorOptions run = options.run;
  if (run.expected.empty()) throw ConfigError("expect: must name a node");
  run.pace.tick_length = options.tick_length;
  if (options.with_broker) run.expected.insert(run.expected.begin(), broker_name);
  return run;
}

double as_seconds(nanoseconds t) { return duration<double>(t).count(); }

class Master {
 public:
  explicit Master(const MasterOptions& options)
      : options_(options),
        coordinator_(with_broker(options), now()),
        security_(options.keys, master_name),
        door_(context_, security_),
        router_(make_socket(context_, zmq::socket_type::router, max_control_bytes)),
        ticks_(make_socket(context_, zmq::socket_type::pub, max_control_bytes)),
        connections_(context_, router_),
        run_id_(new_run_id()),
        heartbeat_(std::min<nanoseconds>(milliseconds(250), options.run.silent_after / 8)) {
    router_.set(zmq::sockopt::linger, 500);
    ticks_.set(zmq::sockopt::linger, 500);
    address_ = bind_to(router_, options.address, security_);
    tick_endpoint_ = bind_to(ticks_, any_port(options.address), security_);
    announce();
  }

  MasterResult run() {
    auto next_check = now();
    std::optional<nanoseconds> over_since;
    while (true) {
      wait(std::min(next_check, coordinator_.next_due().value_or(next_check)) - now());
      const std::vector<int> broken = connections_.broken();
      for (const std::string& name : connections_.names_of(broken))
        coordinator_.suspect(name, now());
      hear();
      // What came over a connection before it broke is no sign of life after it.
      for (const std::string& name : connections_.forget(broken)) coordinator_.suspect(name, now());
      if (options_.stop && options_.stop->is_set()) coordinator_.stop("interrupted");
      const auto due = coordinator_.next_due();
      if (due && now() >= *due) coordinator_.check(now());
      if (now() >= next_check) {
        coordinator_.check(now());
        complain();
        const bool connecting = coordinator_.phase() == Phase::connecting;
        next_check = now() + (connecting ? connecting_interval : check_interval);
        if (connecting || coordinator_.over()) publish();
      }
      if (coordinator_.phase() != phase_ || coordinator_.granted() != granted_ ||
          coordinator_.topology_version() != topology_version_ || !fresh_.published().empty())
        advance();
      if (!coordinator_.over()) continue;
      if (!over_since) over_since = now();
      // Of a failure, the heartbeat of a node that hangs hears as well.
      const bool told = coordinator_.phase() == Phase::ended || directory_.all().empty() ||
                        now() - *over_since > 2 * heartbeat_;
      if ((coordinator_.deserted() && told) || now() - *over_since > farewell) break;
    }
    return result();
  }

 private:
  void announce() {
    spdlog::debug("listens on {}", address_);
    if (!options_.announce_file.empty()) write_file_whole(options_.announce_file, address_ + "\n");
    if (options_.announce_fd >= 0) {
      const std::string line = address_ + "\n";
      if (write(options_.announce_fd, line.data(), line.size()) != ssize_t(line.size()))
        throw Error("announce-fd: can't write");
    }
    if (options_.on_bound) options_.on_bound(address_);
  }

  void wait(nanoseconds at_most) {
    items_ = {{router_.handle(), 0, ZMQ_POLLIN, 0}, {connections_.handle(), 0, ZMQ_POLLIN, 0}};
    if (options_.stop && !coordinator_.over())
      items_.push_back({nullptr, options_.stop->fd(), ZMQ_POLLIN, 0});
    wait_for(items_, at_most);
  }

  void hear() {
    for (auto message = receive(router_); !message.empty(); message = receive(router_)) {
      if (message.size() != 2 || !from_frame(message[1], &heard_)) continue;
      const bool before_welcome = heard_.has_hello() || heard_.has_join() || heard_.has_control();
      if (!before_welcome && heard_.run_id() != run_id_) continue;
      const std::string_view sender = message[0].to_string_view();
      if (security_.on() && !in_own_name(sender_of(message[1]))) continue;
      const std::string& name = directory_.name_of(sender);
      if (heard_.has_done()) {
        done(name);
      } else if (heard_.has_heartbeat()) {
        heartbeat(sender, message[1]);
      } else if (heard_.has_join()) {
        join(sender, message[1]);
      } else if (heard_.has_ready()) {
        coordinator_.ready(name, now());
      } else if (heard_.has_leave()) {
        leave(name);
      } else if (heard_.has_failed()) {
        coordinator_.fail(name, heard_.failed().reason());
      } else if (heard_.has_hello() || heard_.has_control()) {
        if (heard_.has_control()) control();
        v1::MasterMessage answer;
        fill(answer.mutable_endpoints());
        reply(sender, answer);
      }
    }
  }

  /// With keys: whether `who` may say what was heard.
  bool in_own_name(const std::string& who) {
    const bool own = heard_.has_join()        ? heard_.join().name() == who
                     : heard_.has_heartbeat() ? heard_.heartbeat().name() == who
                     : heard_.has_control()   ? who == operator_name
                                              : true;  // goes by its connection
    if (!own) spdlog::warn("refused a message of {} in another name", who);
    return own;
  }

  void done(const std::string& name) {
    coordinator_.done(name, tally_of(heard_.done()), now());
    if (heard_.done().published().empty()) return;
    const auto member = coordinator_.members().find(name);
    if (member == coordinator_.members().end() || member->second.observer) return;
    TickTally tally = tally_of(heard_.done());
    tally.incarnation = member->second.incarnation;
    add_published(&fresh_, consumed_, tally);
  }

  void control() {
    spdlog::info("asked to {}", v1::Control::Action_Name(heard_.control().action()));
    apply(heard_.control(), coordinator_, now());
  }

  void join(std::string_view sender, zmq::message_t& frame) {
    const v1::Join& join = heard_.join();
    const Coordinator::Request request = request_of(join);
    v1::MasterMessage answer;
    const bool is_broker = join.name() == broker_name;
    const auto refusal = join.has_broker() == is_broker
                             ? coordinator_.join(request, now())
                             : std::optional<std::string>("only the broker is named broker");
    if (refusal) {
      answer.mutable_refuse()->set_reason(*refusal);
      reply(sender, answer);
      spdlog::warn("refused {}: {}", join.name(), *refusal);
      return;
    }
    const std::uint64_t incarnation = coordinator_.members().at(join.name()).incarnation;
    directory_.add(sender, incarnation, join);
    connections_.belongs(frame, join.name());
    auto* welcome = answer.mutable_welcome();
    welcome->set_run_id(run_id_);
    welcome->set_incarnation(incarnation);
    welcome->set_tick_ns(options_.tick_length.ns);
    welcome->set_last_tick(options_.run.last_tick);
    welcome->set_window_ticks(std::uint32_t(options_.run.window_ticks));
    welcome->set_heartbeat_s(as_seconds(heartbeat_));
    welcome->set_silent_after_s(as_seconds(options_.run.silent_after));
    welcome->set_tick_endpoint(tick_endpoint_);
    reply(sender, answer);
    const auto missing = coordinator_.missing();
    spdlog::info("{} joined{}{}", join.name(),
                 incarnation == 1 ? "" : fmt::format(", process {} of its name", incarnation),
                 missing.empty() ? "" : "; waiting for " + joined(missing));
  }

  void heartbeat(std::string_view sender, zmq::message_t& frame) {
    const auto& heartbeat = heard_.heartbeat();
    v1::MasterMessage answer;
    const auto member = coordinator_.members().find(heartbeat.name());
    if (!directory_.find(heartbeat.name(), heartbeat.incarnation())) {
      if (directory_.knows(heartbeat.name()))
        reply(sender, expelled("another process has taken the name " + heartbeat.name()));
      return;
    }
    connections_.belongs(frame, heartbeat.name());
    coordinator_.heartbeat(heartbeat.name(), heartbeat.computing(), heartbeat.progress(), now());
    times_[heartbeat.name()] = take(heartbeat.times());
    if (member == coordinator_.members().end() || member->second.dropped)
      return reply(sender, expelled("the run goes on without " + heartbeat.name()));
    *answer.mutable_grant() = grant();
    const auto& needs = member->second.node.consumes;
    const std::set<std::string, std::less<>> wanted(needs.begin(), needs.end());
    for (const auto& [name, other] : coordinator_.members())
      for (const TickTally& tally : other.said)
        if (tally.incarnation == other.incarnation)
          add_published(answer.mutable_grant(), wanted, tally);
    reply(sender, answer);
  }

  /// The run's last word to a process that is no longer part of it.
  v1::MasterMessage expelled(const std::string& cause) {
    v1::MasterMessage answer;
    *answer.mutable_grant() = grant();
    answer.mutable_grant()->set_phase(v1::PHASE_FAILED);
    answer.mutable_grant()->set_cause(cause);
    return answer;
  }

  void leave(const std::string& name) {
    const auto& leave = heard_.leave();
    if (name.empty()) return;
    times_[name] = take(leave.times());
    coordinator_.leave(name, leave.interrupted(), now());
    spdlog::debug("{} left", name);
  }

  void reply(std::string_view routing_id, const v1::MasterMessage& message) {
    router_.send(zmq::buffer(routing_id), zmq::send_flags::sndmore);
    router_.send(to_frame(message), zmq::send_flags::none);
  }

  /// Something changed: says so to everybody.
  void advance() {
    const Phase before = phase_;
    phase_ = coordinator_.phase();
    granted_ = coordinator_.granted();
    if (coordinator_.topology_version() != topology_version_) send_topology();
    if (phase_ != before) {
      if (phase_ == Phase::running) started_ = now();
      if (before == Phase::running) ended_ = now();
      if (phase_ == Phase::failed) spdlog::error("{}", coordinator_.cause());
      if (phase_ == Phase::running) spdlog::info("all are ready");
    }
    publish();
  }

  void publish() {
    grant();
    grant_.mutable_published()->Swap(fresh_.mutable_published());
    fresh_.clear_published();
    ticks_.send(to_frame(grant_), zmq::send_flags::none);
  }

  const v1::Grant& grant() {
    grant_.Clear();
    grant_.set_run_id(run_id_);
    grant_.set_tick(coordinator_.granted());
    grant_.set_phase(to_wire(coordinator_.phase()));
    grant_.set_cause(coordinator_.cause());
    for (const auto& [name, member] : coordinator_.members()) {
      if (!member.dropped) continue;
      for (const std::string& topic : member.node.produces) {
        auto* closed = grant_.add_closed();
        closed->set_topic(topic);
        closed->set_from_tick(member.closed_from);
      }
    }
    if (coordinator_.over())
      grant_.set_deserted(std::none_of(
          coordinator_.members().begin(), coordinator_.members().end(),
          [](const auto& entry) { return entry.second.keeps_time && entry.second.active(); }));
    return grant_;
  }

  void send_topology() {
    topology_version_ = coordinator_.topology_version();
    consumed_ = directory_.consumed();
    const v1::Topology topology = directory_.topology();
    for (const auto& [name, peer] : directory_.all()) {
      v1::MasterMessage message;
      *message.mutable_topology() = topology_for(name, topology, coordinator_);
      reply(peer.routing_id, message);
    }
  }

  void fill(v1::Endpoints* endpoints) const {
    endpoints->set_run_id(run_id_);
    endpoints->set_tick_ns(options_.tick_length.ns);
    endpoints->set_tick_endpoint(tick_endpoint_);
    directory_.describe(endpoints);
    describe(endpoints, coordinator_);
    for (auto& node : *endpoints->mutable_nodes())
      if (const auto times = times_.find(node.name()); times != times_.end())
        put(node.mutable_times(), times->second);
  }

  /// Names whom everybody waits for when nothing has moved for a while.
  void complain() {
    if (coordinator_.over()) return;
    for (const auto& [name, member] : coordinator_.members()) {
      if (!member.silent) silent_.erase(name);
      if (member.silent && silent_.insert(name).second)
        spdlog::warn("{} is lost: waiting for it (last tick done: {})", name, member.done);
    }
    const auto state = std::pair(coordinator_.granted(), coordinator_.holding());
    if (state != complained_about_) {
      complained_about_ = state;
      quiet_since_ = now();
    } else if (now() - quiet_since_ >= complain_interval) {
      const auto& pace = coordinator_.pace();
      spdlog::info("tick {} of {}: {}", coordinator_.granted(), options_.run.last_tick,
                   !coordinator_.holding().empty() ? "waiting for " + joined(coordinator_.holding())
                   : pace.paused()                 ? std::string("paused")
                                                   : std::string("real time holds the clock"));
      quiet_since_ = now();
    }
  }

  MasterResult result() const {
    MasterResult result;
    result.reason = coordinator_.cause();
    result.exit_code = coordinator_.phase() == Phase::ended && result.reason.empty() ? 0 : 1;
    result.digest = coordinator_.digest();
    result.overruns = coordinator_.pace().overruns();
    result.worst_lag_s = as_seconds(coordinator_.pace().worst_lag());
    result.granted = coordinator_.granted();
    if (started_) result.wall_s = as_seconds(ended_.value_or(now()) - *started_);
    result.times = times_;
    for (const auto& [name, member] : coordinator_.members())
      if (member.dropped) result.dropped.push_back(name);
    for (const auto& [name, member] : coordinator_.members())
      if (member.incarnation > 1) result.restarts[name] = int(member.incarnation) - 1;
    return result;
  }

  const MasterOptions& options_;
  Coordinator coordinator_;
  zmq::context_t context_{1};
  Security security_;
  Doorkeeper door_;
  zmq::socket_t router_, ticks_;
  PeerMonitor connections_;
  std::uint64_t run_id_;
  nanoseconds heartbeat_;
  std::string address_, tick_endpoint_;
  std::vector<zmq::pollitem_t> items_;
  PeerDirectory directory_;
  std::map<std::string, TimeSplit> times_;
  v1::NodeMessage heard_;
  v1::Grant grant_;
  v1::Grant fresh_;                              // `published` that has not been told yet
  std::set<std::string, std::less<>> consumed_;  // topics that somebody consumes
  std::uint64_t topology_version_ = 0;           // as last told
  Phase phase_ = Phase::gathering;               // as last told
  Tick granted_ = -1;
  std::optional<nanoseconds> started_, ended_;
  std::pair<Tick, std::vector<std::string>> complained_about_;
  nanoseconds quiet_since_{0};
  std::set<std::string> silent_;  // as last said
};

}  // namespace

MasterResult run_master(const MasterOptions& options) { return Master(options).run(); }

}  // namespace dmise
