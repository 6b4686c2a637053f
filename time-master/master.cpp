#include "time-master/master.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <random>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "nodes/runtime/observability/metrics.h"
#include "nodes/runtime/process/cpu_time.h"
#include "nodes/runtime/process/json_log.h"
#include "nodes/runtime/process/limited_log.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/peer_directory.h"
#include "nodes/runtime/protocol/time_split_codec.h"
#include "nodes/runtime/protocol/topic_owners.h"
#include "nodes/runtime/transport/own_name.h"
#include "nodes/runtime/transport/peer_monitor.h"
#include "nodes/runtime/transport/socket.h"
#include "time-master/clock_watch.h"
#include "time-master/control_inbox.h"
#include "time-master/master_messages.h"
#include "time-master/master_publisher.h"

namespace dmise {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds check_interval{50};
constexpr milliseconds connecting_interval{10};  // grants repeated while subscribers connect
constexpr milliseconds farewell{1500};  // longest wait for nodes to leave a run that is over

constexpr milliseconds longest_unheard{250};   // between a connection's end and its last words
constexpr milliseconds guard_interval{20};     // between two looks at what connections bring
constexpr int most_control_messages = 1000;    // of one connection, that wait to be read
constexpr int most_unread_grants = 4096;       // of one who listens; heartbeats repeat what is lost
constexpr int most_waiting_subscriptions = 8;  // of one connection; the rest waits on its side, so
                                               // that little is kept between two looks at it
constexpr std::int64_t longest_subscription = 1024;    // the handshake with keys needs so much
constexpr std::size_t max_unasked_bytes = 4096;        // of what a guest says
constexpr std::size_t most_observed_bytes = 64 << 10;  // of the topics of one observer

std::uint64_t random_number() {
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

double as_seconds(nanoseconds t) { return duration<double>(t).count(); }

/// Those who listen to the clock only subscribe to it.
ConnectionLimits limits_of_listeners(std::size_t nodes) {
  ConnectionLimits limits = limits_for(nodes, 0.4);
  limits.most_strangers += nodes;
  limits.usual_strangers = limits.most_strangers;
  limits.stranger_bytes = 0;
  return limits;
}

zmq::socket_t control_router(zmq::context_t& context) {
  zmq::socket_t router = make_socket(context, zmq::socket_type::router, max_control_bytes);
  router.set(zmq::sockopt::rcvhwm, most_control_messages);
  router.set(zmq::sockopt::linger, 500);
  return router;
}

zmq::socket_t grant_publisher(zmq::context_t& context) {
  zmq::socket_t ticks = make_socket(context, zmq::socket_type::pub, longest_subscription);
  ticks.set(zmq::sockopt::sndhwm, most_unread_grants);
  ticks.set(zmq::sockopt::rcvhwm, most_waiting_subscriptions);
  ticks.set(zmq::sockopt::linger, 500);
  return ticks;
}

using NodeBeats = google::protobuf::RepeatedPtrField<v1::NodeBeat>;

class Master {
 public:
  explicit Master(const MasterOptions& options)
      : options_(options),
        coordinator_(with_broker(options), now()),
        security_(options.keys, master_name),
        door_(context_, security_),
        router_(control_router(context_)),
        ticks_(grant_publisher(context_)),
        connections_(context_, router_, limits_for(options.run.expected.size(), 0.2)),
        listeners_(context_, ticks_, limits_of_listeners(options.run.expected.size())),
        run_id_(random_number()),
        inbox_(router_, connections_),
        refusals_({.burst = 64 + 4 * int(options.run.expected.size())}),
        publisher_(router_, ticks_, run_id_, coordinator_, directory_) {
    address_ = bind_to(router_, options.address, security_);
    tick_endpoint_ = bind_to(ticks_, any_port(options.address), security_);
    announce(options, address_);
  }

  MasterResult run() {
    auto next_check = now(), next_guard = now();
    auto awake = now();
    std::optional<nanoseconds> over_since;
    while (true) {
      wait(std::min({next_check, next_guard, coordinator_.next_due().value_or(next_check),
                     coordinator_.next_check().value_or(next_check),
                     inbox_.next_due().value_or(next_check)}) -
           now());
      hear();
      wake(awake);
      awake = now();
      if (options_.stop && options_.stop->is_set()) coordinator_.stop("interrupted");
      for (const auto due : {coordinator_.next_due(), coordinator_.next_check()})
        if (due && now() >= *due) coordinator_.check(now());
      if (now() >= next_check) {
        coordinator_.check(now());
        watch_.look(coordinator_, now());
        tell_metrics();
        look_after_strangers();
        const bool connecting = coordinator_.phase() == Phase::connecting;
        next_check = now() + (connecting ? connecting_interval : check_interval);
        if (connecting || coordinator_.over()) publisher_.publish();
      }
      advance();
      inbox_.hear_strangers([this](ControlMessage& message) { hear_stranger(message); });
      advance();
      if (now() >= next_guard) {
        guard();
        next_guard = now() + guard_interval;
      }
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
    const auto more = connections_.broken();
    if (!more.empty() && broken_.empty()) broken_since_ = now();
    broken_.insert(broken_.end(), more.begin(), more.end());
    suspect(connections_.names_of(broken_));
    const bool heard_all =
        inbox_.read([this](ControlMessage& message) { return take_in(message); });
    // What came over a connection before it broke is no sign of life after it.
    if (!heard_all && now() - broken_since_ < longest_unheard)
      return suspect(connections_.names_of(broken_));
    suspect(connections_.forget(broken_));
    broken_.clear();
  }

  /// Whether the clock waits for this member.
  bool keeps_clock(const std::string& name) const {
    if (name.empty()) return false;
    const auto member = coordinator_.members().find(name);
    return member != coordinator_.members().end() && !member->second.is_guest();
  }

  /// Does what a member says. False for what anybody may ask for: it waits for its turn.
  bool take_in(ControlMessage& message) {
    const std::string& name = directory_.name_of(message.from());
    const bool clock = keeps_clock(name) || keeps_clock(connections_.name_of(message.body));
    if (!clock && (name.empty() || asks(message.body))) return false;
    if (clock && !ended_) ++messages_;
    hear(message, name);
    return true;
  }

  /// Whether there is an answer to it.
  bool asks(const zmq::message_t& body) {
    if (body.size() > max_unasked_bytes || !from_frame(body, &heard_)) return true;
    return !heard_.has_done() && !heard_.has_ready() && !heard_.has_leave() && !heard_.has_failed();
  }

  void hear_stranger(ControlMessage& message) {
    if (PeerMonitor::is_stuck(message.body)) return;  // it reads no answers: it gets no more
    hear(message, directory_.name_of(message.from()));
    // A message of many small parts leaves much memory behind.
    if (message.body.size() > (16 << 10)) heard_ = v1::NodeMessage();
  }

  /// `name`: of the member whose connection it came over, if it is one's.
  void hear(ControlMessage& message, const std::string& name) {
    if (!from_frame(message.body, &heard_)) return;
    const bool before_welcome = (heard_.has_hello() || heard_.has_join()) && heard_.run_id() == 0;
    if (!before_welcome && heard_.run_id() != run_id_) return;
    const std::string_view sender = message.from();
    auto fault = fault_of(heard_);
    if (!fault && security_.on()) fault = fault_of_sender(heard_, message.body, name);
    if (fault) return refuse(sender, *fault);
    if (heard_.has_done()) {
      done(name);
    } else if (heard_.has_heartbeat()) {
      heartbeat(sender, message.body);
    } else if (heard_.has_join()) {
      join(sender, message.body);
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
      publisher_.reply(sender, answer);
    }
    forget_the_forgotten();
  }

  /// Nothing is kept of those who are no longer part of the run.
  void forget_the_forgotten() {
    for (const std::string& name : coordinator_.take_forgotten()) {
      directory_.remove(name);
      owners_.remove(name);
      times_.erase(name);
    }
  }

  void look_after_strangers() {
    forget_the_forgotten();
    ignored_ += inbox_.take_ignored();
    if (ignored_ > 0 && now() >= next_ignored_line_) {
      spdlog::warn("ignored {} messages of peers that send more than is heard of them", ignored_);
      ignored_ = 0;
      next_ignored_line_ = now() + std::chrono::seconds(10);
    }
    log_.sum_up();
  }

  /// Closes connections that go beyond what is borne with.
  void guard() {
    for (PeerMonitor* connections : {&connections_, &listeners_})
      for (const std::string& closed : connections->enforce(now()))
        log_.warn("connections closed", closed);
    listeners_.forget(listeners_.broken());
  }

  void refuse(std::string_view sender, const std::string& fault) {
    log_.warn("messages refused", "refused a message: " + fault);
    if (heard_.has_join()) refuse_join(sender, fault, heard_.join().name().substr(0, 256));
  }

  void refuse_join(std::string_view sender, const std::string& reason, const std::string& name) {
    if (refusals_.take(sender, now())) publisher_.refuse(sender, reason, name);
  }

  void done(const std::string& name) {
    if (security_.on() && !owners_.keep_own(name, heard_.mutable_done()))
      log_.warn("messages refused", "refused what " + name + " tells of topics of others");
    coordinator_.done(name, tally_of(heard_.done()), now());
    if (heard_.done().published().empty()) return;
    const auto member = coordinator_.members().find(name);
    if (member == coordinator_.members().end() || member->second.is_guest()) return;
    TickTally tally = tally_of(heard_.done());
    if (!member->second.agent)
      for (TopicTally& topic : tally.topics) topic.incarnation = member->second.incarnation;
    publisher_.note(tally);
  }

  void control() {
    if (log_.admits("wishes for the clock"))
      spdlog::info("asked to {}", v1::Control::Action_Name(heard_.control().action()));
    apply(heard_.control(), coordinator_, now());
  }

  void join(std::string_view sender, zmq::message_t& frame) {
    const v1::Join& join = heard_.join();
    const Coordinator::Request request = request_of(join);
    const bool is_broker = join.name() == broker_name;
    const std::string& stands_for = directory_.name_of(sender);
    suspect(connections_.names_of(broken_));  // whose last words may have been heard just now
    std::optional<std::string> refusal;
    if (join.has_broker() != is_broker)
      refusal = "only the broker is named broker";
    else if (!join.host().empty() && stands_for != join.host())
      refusal = "only " + join.host() + " speaks for the nodes of its host";
    else if (join.host().empty() && !stands_for.empty() && stands_for != join.name())
      refusal = "this connection is that of " + stands_for;
    else if (join.observer() && join.ByteSizeLong() > most_observed_bytes)
      refusal = "an observer's topics may have 64 KiB in all";
    else if (auto fault = join.observer() ? std::nullopt : owners_.fault_of(join))
      refusal = fault;
    else
      refusal = coordinator_.join(request, now());
    if (refusal) {
      refuse_join(sender, *refusal, join.name());
      if (log_.admits("nodes refused"))
        log_event(spdlog::level::warn, "node_refused",
                  {{"name", join.name()}, {"reason", *refusal}},
                  "refused " + join.name() + ": " + *refusal);
      return;
    }
    forget_the_forgotten();
    owners_.add(join);
    const std::uint64_t token = random_number();
    const std::uint64_t incarnation = coordinator_.member_of(join.name()).incarnation;
    if (join.host().empty()) {
      directory_.add(sender, incarnation, join, token);
      connections_.belongs(frame, join.name(), join.observer());
    } else {
      directory_.add_behind(sender, incarnation, join);
    }
    publisher_.reply(sender, publisher_.welcome(join.name(), tick_endpoint_, token));
    if (join.observer() && coordinator_.phase() != Phase::gathering)
      publisher_.announce_observer(join.name());
    if (join.observer() && !log_.admits("observers joined")) return;
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
    const Peer* peer = directory_.find(heartbeat.name(), heartbeat.incarnation());
    if (!peer)
      return publisher_.reply(
          sender, publisher_.expelled(directory_.knows(heartbeat.name())
                                          ? "another process has taken the name " + heartbeat.name()
                                          : "the run goes on without " + heartbeat.name()));
    // A key proves as much as the token does.
    const bool own = security_.on() || heartbeat.token() == peer->heartbeat_token;
    if (!peer->join.host().empty() || !own)
      return log_.warn("messages refused",
                       "refused a heartbeat in the name of " + heartbeat.name());
    connections_.belongs(frame, heartbeat.name(), peer->join.observer());
    coordinator_.heartbeat(heartbeat.name(), heartbeat.computing(), heartbeat.progress(), now());
    times_[heartbeat.name()] = take(heartbeat.times());
    hear_of(heartbeat.name(), heartbeat.nodes(),
            {heartbeat.holding().begin(), heartbeat.holding().end()});
    if (member == coordinator_.members().end() || member->second.dropped)
      return publisher_.reply(sender,
                              publisher_.expelled("the run goes on without " + heartbeat.name()));
    if (answers_.take(heartbeat.name(), now()) && !PeerMonitor::is_stuck(frame))
      publisher_.reply(sender, publisher_.grant_for(member->second));
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
    coordinator_.report_behind(agent, std::move(holding), done);
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
    const Phase before = publisher_.phase();
    if (!publisher_.publish_changes() || publisher_.phase() == before) return;
    const Phase phase = publisher_.phase();
    if (phase == Phase::running) {
      started_ = now();
      messages_ = 0;
      cpu_s_ = -process_cpu_seconds();
    }
    if (before == Phase::running) {
      ended_ = now();
      cpu_s_ += process_cpu_seconds();
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
    endpoints->set_start_utc(options_.start_utc);
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
  ZapAuthenticator door_;
  zmq::socket_t router_, ticks_;
  PeerMonitor connections_, listeners_;  // of the two
  std::vector<std::uint64_t> broken_;    // whose last words have perhaps not been heard
  nanoseconds broken_since_{0};
  std::uint64_t run_id_;
  std::string address_, tick_endpoint_;
  std::vector<zmq::pollitem_t> items_;
  PeerDirectory directory_;
  TopicOwners owners_;
  ControlInbox inbox_;
  PeerRates refusals_;              // by connection
  PeerRates answers_{RateLimit{}};  // to heartbeats, by name
  LimitedLog log_;
  std::uint64_t ignored_ = 0;
  nanoseconds next_ignored_line_{0};
  MasterPublisher publisher_;
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
