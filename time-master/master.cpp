#include "time-master/master.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <random>

#include "core/base/error.h"
#include "nodes/runtime/observability/metrics.h"
#include "nodes/runtime/process/json_log.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/process/process_memory.h"
#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/protocol/time_split_codec.h"
#include "time-master/announce.h"
#include "time-master/master_messages.h"
#include "time-master/master_process.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds check_interval{50};

/// Between grants that are repeated while subscribers connect.
milliseconds connecting_interval(std::size_t nodes) { return milliseconds(10 + nodes); }

constexpr milliseconds farewell{1500};  // longest wait for nodes to leave after the run

constexpr milliseconds longest_unheard{250};  // between a connection's end and its last messages
constexpr milliseconds guard_interval{20};    // between checks of connection limits
constexpr int max_control_messages = 1000;    // waiting to be read, per connection
constexpr int max_waiting_subscriptions = 8;  // on one connection; others wait at the peer, so
                                              // that little is queued between two checks

CoordinatorOptions with_broker(const MasterOptions& options) {
  CoordinatorOptions run = options.run;
  if (run.expected.empty()) throw ConfigError("expect: must name a node");
  run.pace.tick_length = options.tick_length;
  run.heartbeat = std::min<nanoseconds>(milliseconds(250), run.silent_after / 8);
  if (options.with_broker) run.expected.insert(run.expected.begin(), broker_name);
  return run;
}

/// Subscribers of the clock send subscriptions only.
ConnectionLimits limits_of_listeners(std::size_t nodes) {
  ConnectionLimits limits = limits_for(nodes, 0.4);
  limits.max_strangers += nodes;
  limits.usual_strangers = limits.max_strangers;
  limits.stranger_bytes = 0;
  return limits;
}

zmq::socket_t control_router(zmq::context_t& context) {
  zmq::socket_t router = make_socket(context, zmq::socket_type::router, max_control_bytes);
  router.set(zmq::sockopt::rcvhwm, max_control_messages);
  router.set(zmq::sockopt::linger, 500);
  return router;
}

zmq::socket_t grant_publisher(zmq::context_t& context) {
  zmq::socket_t ticks = make_socket(context, zmq::socket_type::pub, max_control_bytes);
  ticks.set(zmq::sockopt::sndhwm, max_unread);  // heartbeats repeat lost grants
  ticks.set(zmq::sockopt::rcvhwm, max_waiting_subscriptions);
  ticks.set(zmq::sockopt::linger, 500);
  return ticks;
}

}  // namespace

std::uint64_t random_number() {
  std::random_device device;
  std::uint64_t id = 0;
  while (id == 0) id = std::uint64_t(device()) << 32 | device();
  return id;
}

MasterProcess::MasterProcess(const MasterOptions& options)
    : options_(options),
      coordinator_(with_broker(options), now()),
      security_(options.keys, master_name),
      authenticator_(context_, security_),
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
  spdlog::debug("listens on {}", address_);
  announce(address_, options.announce_file, options.announce_fd, options.on_bound);
}

MasterResult MasterProcess::run() {
  auto next_check = now(), next_guard = now();
  auto awake = now();
  std::optional<nanoseconds> over_since;
  while (true) {
    wait(std::min({next_check, next_guard, coordinator_.next_due().value_or(next_check),
                   coordinator_.next_check().value_or(next_check),
                   inbox_.next_due().value_or(next_check)}) -
         now());
    receive_all();
    check_suspension(awake);
    awake = now();
    if (options_.stop && options_.stop->is_set()) coordinator_.fail_run("interrupted");
    for (const auto due : {coordinator_.next_due(), coordinator_.next_check()})
      if (due && now() >= *due) coordinator_.check(now());
    if (now() >= next_check) {
      coordinator_.check(now());
      watch_.check(coordinator_, now());
      update_metrics();
      look_after_strangers();
      const bool connecting = coordinator_.phase() == Phase::connecting;
      next_check = now() + (connecting ? connecting_interval(coordinator_.members().size())
                                       : check_interval);
      if (connecting || coordinator_.over()) publisher_.publish();
    }
    advance();
    inbox_.deliver_strangers([this](ControlMessage& message) { handle_stranger(message); });
    advance();
    if (now() >= next_guard) {
      enforce_limits();
      next_guard = now() + guard_interval;
    }
    if (!coordinator_.over()) continue;
    if (!over_since) over_since = now();
    // After a failure, the heartbeat thread of a hung node still receives the cause.
    const bool all_informed = coordinator_.phase() == Phase::ended || directory_.all().empty() ||
                              now() - *over_since > 2 * coordinator_.options().heartbeat;
    if ((coordinator_.deserted() && all_informed) || now() - *over_since > farewell) break;
  }
  return result();
}

void MasterProcess::update_metrics() const {
  Metrics* metrics = Metrics::of_process();
  if (!metrics) return;
  v1::Endpoints endpoints;
  fill(&endpoints);
  metrics->set(status_of(endpoints));
}

void MasterProcess::wait(nanoseconds at_most) {
  items_ = {{router_.handle(), 0, ZMQ_POLLIN, 0}, {connections_.handle(), 0, ZMQ_POLLIN, 0}};
  if (options_.stop && !coordinator_.over())
    items_.push_back({nullptr, options_.stop->fd(), ZMQ_POLLIN, 0});
  wait_for(items_, at_most);
}

void MasterProcess::check_suspension(nanoseconds since) {
  const nanoseconds slept = now() - since;
  if (slept > options_.run.silent_after - 2 * coordinator_.options().heartbeat)
    coordinator_.fail_run(fmt::format("time-master was stopped for {:.1f} s", to_seconds(slept)));
  else if (slept > options_.run.silent_after / 2)
    coordinator_.excuse(since, now());
}

void MasterProcess::suspect(const std::vector<std::string>& names) {
  for (const std::string& name : names) coordinator_.suspect(name, now());
}

void MasterProcess::receive_all() {
  const auto more = connections_.broken();
  if (!more.empty() && broken_.empty()) broken_since_ = now();
  broken_.insert(broken_.end(), more.begin(), more.end());
  suspect(connections_.names_of(broken_));
  const bool heard_all =
      inbox_.read([this](ControlMessage& message) { return handle_member(message); });
  // Messages received before a connection broke are not signs of life after it.
  if (!heard_all && now() - broken_since_ < longest_unheard)
    return suspect(connections_.names_of(broken_));
  suspect(connections_.forget(broken_));
  broken_.clear();
}

void MasterProcess::look_after_strangers() {
  drop_removed();
  ignored_ += inbox_.take_ignored();
  if (ignored_ > 0 && now() >= next_ignored_line_) {
    spdlog::warn("ignored {} messages of peers that send more than is read from them", ignored_);
    ignored_ = 0;
    next_ignored_line_ = now() + std::chrono::seconds(10);
  }
  log_.sum_up();
}

void MasterProcess::enforce_limits() {
  for (PeerMonitor* connections : {&connections_, &listeners_})
    for (const std::string& closed : connections->enforce(now()))
      log_.warn("connections closed", closed);
  listeners_.forget(listeners_.broken());
}

void MasterProcess::advance() {
  tick_log_.grant(coordinator_.options().first_tick, coordinator_.granted(), now());
  const Phase before = publisher_.phase();
  if (!publisher_.publish_changes() || publisher_.phase() == before) return;
  const Phase phase = publisher_.phase();
  if (phase == Phase::running) {
    started_ = now();
    messages_ = 0;
    cpu_s_ = -process_cpu_s();
  }
  if (before == Phase::running) {
    ended_ = now();
    cpu_s_ += process_cpu_s();
  }
  const Tick granted = coordinator_.granted();
  if (phase == Phase::failed)
    log_event(spdlog::level::err, "run_failed", {{"granted_tick", granted}}, coordinator_.cause());
  if (phase == Phase::running)
    log_event(spdlog::level::info, "run_started", {{"granted_tick", granted}}, "all are ready");
}

void MasterProcess::fill(v1::Endpoints* endpoints) const {
  endpoints->set_run_id(run_id_);
  endpoints->set_tick_ns(options_.tick_length.ns);
  endpoints->set_start_utc(options_.start_utc);
  endpoints->set_scenario_digest(options_.scenario_digest);
  endpoints->set_tick_endpoint(tick_endpoint_);
  directory_.describe(endpoints);
  describe(endpoints, coordinator_);
  for (auto& node : *endpoints->mutable_nodes())
    if (const auto times = times_.find(node.name()); times != times_.end())
      put(node.mutable_times(), times->second);
}

MasterResult MasterProcess::result() const {
  MasterResult result = result_of(coordinator_);
  if (started_) result.wall_s = to_seconds(ended_.value_or(now()) - *started_);
  result.times = times_;
  result.messages = messages_;
  result.ticks = tick_log_.records();
  result.waited_for_s = tick_log_.waited_for_s();
  result.cpu_s = std::max(0.0, cpu_s_);
  return result;
}

MasterResult run_master(const MasterOptions& options) { return MasterProcess(options).run(); }

}  // namespace dmise
