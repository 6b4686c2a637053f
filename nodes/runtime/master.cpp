#include "nodes/runtime/master.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <random>

#include "core/base/error.h"
#include "nodes/runtime/clock_watch.h"
#include "nodes/runtime/control_rules.h"
#include "nodes/runtime/json_log.h"
#include "nodes/runtime/master_voice.h"
#include "nodes/runtime/master_words.h"
#include "nodes/runtime/metrics.h"
#include "nodes/runtime/own_name.h"
#include "nodes/runtime/peer_directory.h"
#include "nodes/runtime/peer_monitor.h"
#include "nodes/runtime/socket.h"
#include "nodes/runtime/time_split_codec.h"
#include "nodes/runtime/topic_owners.h"

namespace dmise {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds check_interval{50};
constexpr milliseconds connecting_interval{10};  // grants repeated while subscribers connect
constexpr milliseconds farewell{1500};  // longest wait for nodes to leave a run that is over

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
  run.heartbeat = std::min<nanoseconds>(milliseconds(250), run.silent_after / 8);
  if (options.with_broker) run.expected.insert(run.expected.begin(), broker_name);
  return run;
}

/// Seconds of all threads of this process.
double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double as_seconds(nanoseconds t) { return duration<double>(t).count(); }

using NodeBeats = google::protobuf::RepeatedPtrField<v1::NodeBeat>;

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
        voice_(router_, ticks_, run_id_, coordinator_, directory_) {
    router_.set(zmq::sockopt::linger, 500);
    ticks_.set(zmq::sockopt::linger, 500);
    address_ = bind_to(router_, options.address, security_);
    tick_endpoint_ = bind_to(ticks_, any_port(options.address), security_);
    announce(options, address_);
  }

  MasterResult run() {
    auto next_check = now();
    auto awake = now();
    std::optional<nanoseconds> over_since;
    while (true) {
      wait(std::min({next_check, coordinator_.next_due().value_or(next_check),
                     coordinator_.next_check().value_or(next_check)}) -
           now());
      broken_ = connections_.broken();
      suspect(connections_.names_of(broken_));
      hear();
      // What came over a connection before it broke is no sign of life after it.
      suspect(connections_.forget(broken_));
      wake(awake);
      awake = now();
      if (options_.stop && options_.stop->is_set()) coordinator_.stop("interrupted");
      for (const auto due : {coordinator_.next_due(), coordinator_.next_check()})
        if (due && now() >= *due) coordinator_.check(now());
      if (now() >= next_check) {
        coordinator_.check(now());
        watch_.look(coordinator_, now());
        tell_metrics();
        const bool connecting = coordinator_.phase() == Phase::connecting;
        next_check = now() + (connecting ? connecting_interval : check_interval);
        if (connecting || coordinator_.over()) voice_.publish();
      }
      advance();
      if (!coordinator_.over()) continue;
      if (!over_since) over_since = now();
      // Of a failure, the heartbeat of a node that hangs hears as well.
      const bool told = coordinator_.phase() == Phase::ended || directory_.all().empty() ||
                        now() - *over_since > 2 * coordinator_.options().heartbeat;
      if ((coordinator_.deserted() && told) || now() - *over_since > farewell) break;
    }
    return result();
  }

 private:
  void tell_metrics() const {
    Metrics* metrics = Metrics::of_process();
    if (!metrics) return;
    v1::Endpoints endpoints;
    fill(&endpoints);
    metrics->tell(status_of(endpoints));
  }

  void wait(nanoseconds at_most) {
    items_ = {{router_.handle(), 0, ZMQ_POLLIN, 0}, {connections_.handle(), 0, ZMQ_POLLIN, 0}};
    if (options_.stop && !coordinator_.over())
      items_.push_back({nullptr, options_.stop->fd(), ZMQ_POLLIN, 0});
    wait_for(items_, at_most);
  }

  /// Whoever was itself stopped has heard nobody because it could not; the others may have given it
  /// up if that was for long.
  void wake(nanoseconds since) {
    const nanoseconds slept = now() - since;
    if (slept > options_.run.silent_after - 2 * coordinator_.options().heartbeat)
      coordinator_.stop(fmt::format("time-master was stopped for {:.1f} s", as_seconds(slept)));
    else if (slept > options_.run.silent_after / 2)
      coordinator_.excuse(since, now());
  }

  void suspect(const std::vector<std::string>& names) {
    for (const std::string& name : names) coordinator_.suspect(name, now());
  }

  void hear() {
    for (auto message = receive(router_); !message.empty(); message = receive(router_)) {
      if (message.size() != 2 || !from_frame(message[1], &heard_)) continue;
      if (!ended_) ++messages_;
      const bool before_welcome = heard_.has_hello() || heard_.has_join() || heard_.has_control();
      if (!before_welcome && heard_.run_id() != run_id_) continue;
      const std::string_view sender = message[0].to_string_view();
      const std::string& name = directory_.name_of(sender);
      auto fault = fault_of(heard_);
      if (!fault && security_.on()) fault = fault_of_sender(heard_, message[1], name);
      if (fault) {
        refuse(sender, *fault);
        continue;
      }
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
      } else if (heard_.has_node_news()) {
        hear_news(name);
      } else if (heard_.has_failed()) {
        coordinator_.fail(name, one_line(heard_.failed().reason()));
      } else if (heard_.has_hello() || heard_.has_control()) {
        if (heard_.has_control()) control();
        v1::MasterMessage answer;
        fill(answer.mutable_endpoints());
        voice_.reply(sender, answer);
      }
    }
  }

  void refuse(std::string_view sender, const std::string& fault) {
    spdlog::warn("refused a message: {}", fault);
    if (heard_.has_join()) voice_.refuse(sender, fault, heard_.join().name());
  }

  void done(const std::string& name) {
    if (security_.on() && !owners_.keep_own(name, heard_.mutable_done()))
      spdlog::warn("refused what {} tells of topics of others", name);
    coordinator_.done(name, tally_of(heard_.done()), now());
    if (heard_.done().published().empty()) return;
    const auto member = coordinator_.members().find(name);
    if (member == coordinator_.members().end() || member->second.observer) return;
    TickTally tally = tally_of(heard_.done());
    if (!member->second.agent)
      for (TopicTally& topic : tally.topics) topic.incarnation = member->second.incarnation;
    voice_.note(tally);
  }

  void control() {
    spdlog::info("asked to {}", v1::Control::Action_Name(heard_.control().action()));
    apply(heard_.control(), coordinator_, now());
  }

  void join(std::string_view sender, zmq::message_t& frame) {
    const v1::Join& join = heard_.join();
    const Coordinator::Request request = request_of(join);
    const bool is_broker = join.name() == broker_name;
    suspect(connections_.names_of(broken_));  // whose last words may have been heard just now
    std::optional<std::string> refusal;
    if (join.has_broker() != is_broker)
      refusal = "only the broker is named broker";
    else if (!join.host().empty() && directory_.name_of(sender) != join.host())
      refusal = "only " + join.host() + " speaks for the nodes of its host";
    else if (auto fault = join.observer() ? std::nullopt : owners_.fault_of(join))
      refusal = fault;
    else
      refusal = coordinator_.join(request, now());
    if (refusal) {
      voice_.refuse(sender, *refusal, join.name());
      log_event(spdlog::level::warn, "node_refused", {{"name", join.name()}, {"reason", *refusal}},
                "refused " + join.name() + ": " + *refusal);
      return;
    }
    owners_.add(join);
    const std::uint64_t incarnation = coordinator_.member_of(join.name()).incarnation;
    if (join.host().empty()) {
      directory_.add(sender, incarnation, join);
      connections_.belongs(frame, join.name());
    } else {
      directory_.add_behind(sender, incarnation, join);
    }
    voice_.reply(sender, voice_.welcome(join.name(), tick_endpoint_));
    const auto missing = coordinator_.missing();
    log_event(
        spdlog::level::info, "node_joined",
        {{"name", join.name()}, {"incarnation", incarnation}, {"missing", joined(missing)}},
        fmt::format("{} joined{}{}", join.name(),
                    incarnation == 1 ? "" : fmt::format(", process {} of its name", incarnation),
                    missing.empty() ? "" : "; waiting for " + joined(missing)));
  }

  void heartbeat(std::string_view sender, zmq::message_t& frame) {
    const auto& heartbeat = heard_.heartbeat();
    const auto member = coordinator_.members().find(heartbeat.name());
    if (!directory_.find(heartbeat.name(), heartbeat.incarnation())) {
      if (directory_.knows(heartbeat.name()))
        voice_.reply(sender,
                     voice_.expelled("another process has taken the name " + heartbeat.name()));
      return;
    }
    connections_.belongs(frame, heartbeat.name());
    coordinator_.heartbeat(heartbeat.name(), heartbeat.computing(), heartbeat.progress(), now());
    times_[heartbeat.name()] = take(heartbeat.times());
    hear_of(heartbeat.name(), heartbeat.nodes(),
            {heartbeat.holding().begin(), heartbeat.holding().end()});
    if (member == coordinator_.members().end() || member->second.dropped)
      return voice_.reply(sender, voice_.expelled("the run goes on without " + heartbeat.name()));
    voice_.reply(sender, voice_.grant_for(member->second));
  }

  void leave(const std::string& name) {
    const auto& leave = heard_.leave();
    if (name.empty()) return;
    times_[name] = take(leave.times());
    hear_of(name, leave.nodes(), {});
    coordinator_.leave(name, leave.interrupted(), now());
    spdlog::debug("{} left", name);
  }

  /// An agent says how the nodes behind it are.
  void hear_of(const std::string& agent, const NodeBeats& nodes, std::vector<std::string> holding) {
    if (nodes.empty()) return;
    std::map<std::string, Tick> done;
    for (const v1::NodeBeat& node : nodes) {
      const auto known = coordinator_.behind().find(node.name());
      if (known == coordinator_.behind().end() || known->second.host != agent) continue;
      done[node.name()] = node.done_tick();
      times_[node.name()] = take(node.times());
    }
    coordinator_.tell_of(agent, std::move(holding), done);
  }

  void hear_news(const std::string& agent) {
    const v1::NodeNews& news = heard_.node_news();
    const auto node = coordinator_.behind().find(news.name());
    if (node == coordinator_.behind().end() || node->second.host != agent) return;
    switch (news.what()) {
      case v1::NodeNews::WHAT_LOST:
        return coordinator_.lost_behind(news.name(), news.incarnation(), one_line(news.reason()),
                                        news.done_tick(), now());
      case v1::NodeNews::WHAT_FOUND:
        return coordinator_.found_behind(news.name(), news.incarnation());
      case v1::NodeNews::WHAT_FAILED:
        return coordinator_.fail_behind(news.name(), news.incarnation(), one_line(news.reason()));
      default:
        return;
    }
  }

  /// Says what has changed to everybody.
  void advance() {
    const Phase before = voice_.phase();
    if (!voice_.say_news() || voice_.phase() == before) return;
    const Phase phase = voice_.phase();
    if (phase == Phase::running) {
      started_ = now();
      messages_ = 0;
      cpu_s_ = -cpu_seconds();
    }
    if (before == Phase::running) {
      ended_ = now();
      cpu_s_ += cpu_seconds();
    }
    const Tick granted = coordinator_.granted();
    if (phase == Phase::failed)
      log_event(spdlog::level::err, "run_failed", {{"granted_tick", granted}},
                coordinator_.cause());
    if (phase == Phase::running)
      log_event(spdlog::level::info, "run_started", {{"granted_tick", granted}}, "all are ready");
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

  MasterResult result() const {
    MasterResult result = result_of(coordinator_);
    if (started_) result.wall_s = as_seconds(ended_.value_or(now()) - *started_);
    result.times = times_;
    result.messages = messages_;
    result.cpu_s = std::max(0.0, cpu_s_);
    return result;
  }

  const MasterOptions& options_;
  Coordinator coordinator_;
  zmq::context_t context_{1};
  Security security_;
  Doorkeeper door_;
  zmq::socket_t router_, ticks_;
  PeerMonitor connections_;
  std::vector<int> broken_;  // of these, as of now
  std::uint64_t run_id_;
  std::string address_, tick_endpoint_;
  std::vector<zmq::pollitem_t> items_;
  PeerDirectory directory_;
  TopicOwners owners_;
  MasterVoice voice_;
  std::map<std::string, TimeSplit> times_;
  v1::NodeMessage heard_;
  ClockWatch watch_;
  std::optional<nanoseconds> started_, ended_;
  std::uint64_t messages_ = 0;
  double cpu_s_ = 0.0;
};

}  // namespace

MasterResult run_master(const MasterOptions& options) { return Master(options).run(); }

}  // namespace dmise
